#include "tests/renderer/recorded_programs.hpp"

#include <cstddef>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>

namespace candela {
namespace {

std::map<GLuint, RecordedShader> shaders;    // by name; of those that no program has yet
std::map<GLuint, RecordedProgram> programs;  // by name; of those that are not linked yet
std::vector<RecordedProgram> linked;

PFNGLCREATESHADERPROC create_shader = nullptr;
PFNGLSHADERSOURCEPROC shader_source = nullptr;
PFNGLATTACHSHADERPROC attach_shader = nullptr;
PFNGLOBJECTLABELPROC object_label = nullptr;
PFNGLLINKPROGRAMPROC link_program = nullptr;

GLuint record_stage(GLenum stage) {
    const GLuint shader = create_shader(stage);
    shaders[shader] = {.stage = stage, .text = {}};
    return shader;
}

void record_source(GLuint shader, GLsizei count, const GLchar* const* texts, const GLint* lengths) {
    std::string& whole = shaders.at(shader).text;
    for (GLsizei i = 0; i < count; ++i) whole.append(texts[i], static_cast<std::size_t>(lengths[i]));
    shader_source(shader, count, texts, lengths);
}

void record_label(GLenum kind, GLuint name, GLsizei length, const GLchar* label) {
    object_label(kind, name, length, label);
    if (kind == GL_PROGRAM) programs[name].label.assign(label, static_cast<std::size_t>(length));
}

void record_stage_of(GLuint program, GLuint shader) {
    attach_shader(program, shader);
    programs[program].shaders.push_back(std::move(shaders.extract(shader).mapped()));
}

void record_program(GLuint name) {
    link_program(name);
    RecordedProgram program = std::exchange(programs[name], {});
    program.name = name;
    linked.push_back(std::move(program));
}

}  // namespace

gl::GetProc RecordedPrograms::recording(gl::GetProc get_proc) {
    return [get_proc = std::move(get_proc)](const char* name) -> void (*)() {
        const auto found = get_proc(name);
        const auto replace = [&](auto& driver, auto* with) {
            driver = reinterpret_cast<std::remove_reference_t<decltype(driver)>>(found);
            return reinterpret_cast<void (*)()>(with);
        };
        const std::string_view wanted(name);
        if (wanted == "glCreateShader") return replace(create_shader, &record_stage);
        if (wanted == "glShaderSource") return replace(shader_source, &record_source);
        if (wanted == "glObjectLabel") return replace(object_label, &record_label);
        if (wanted == "glAttachShader") return replace(attach_shader, &record_stage_of);
        if (wanted == "glLinkProgram") return replace(link_program, &record_program);
        return found;
    };
}

std::vector<RecordedProgram> RecordedPrograms::take() {
    return std::exchange(linked, {});
}

std::string file_ending(GLenum stage) {
    switch (stage) {
        case GL_VERTEX_SHADER:
            return "vert";
        case GL_GEOMETRY_SHADER:
            return "geom";
        case GL_FRAGMENT_SHADER:
            return "frag";
        default:
            return "comp";
    }
}

}  // namespace candela
