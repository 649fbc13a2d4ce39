#include "renderer/gl/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <utility>
#include <variant>

namespace candela::gl {
namespace {

/// The index in Uniform::Value of what sets a uniform of this type; none for textures and images.
std::optional<std::size_t> value_index(GLenum type, bool is_array) {
    constexpr std::array<GLenum, 10> types{
        GL_BOOL,       GL_INT,        GL_UNSIGNED_INT,      GL_FLOAT,      GL_FLOAT_VEC2,
        GL_FLOAT_VEC3, GL_FLOAT_VEC4, GL_UNSIGNED_INT_VEC2, GL_FLOAT_MAT3, GL_FLOAT_MAT4};
    static_assert(std::variant_size_v<Uniform::Value> == types.size() + 1);
    if (is_array && type == GL_FLOAT_VEC4) return types.size();
    const auto* const found = std::ranges::find(types, type);
    if (found == types.end()) return std::nullopt;
    return static_cast<std::size_t>(found - types.begin());
}

/// Sets the uniform at a location.
struct Setter {
    const Functions& gl;
    GLuint program;
    GLint location;

    void operator()(bool value) const { gl.ProgramUniform1i(program, location, value ? 1 : 0); }
    void operator()(int value) const { gl.ProgramUniform1i(program, location, value); }
    void operator()(std::uint32_t value) const { gl.ProgramUniform1ui(program, location, value); }
    void operator()(float value) const { gl.ProgramUniform1f(program, location, value); }
    void operator()(const glm::vec2& value) const {
        gl.ProgramUniform2fv(program, location, 1, glm::value_ptr(value));
    }
    void operator()(const glm::vec3& value) const {
        gl.ProgramUniform3fv(program, location, 1, glm::value_ptr(value));
    }
    void operator()(const glm::vec4& value) const {
        gl.ProgramUniform4fv(program, location, 1, glm::value_ptr(value));
    }
    void operator()(const glm::uvec2& value) const {
        gl.ProgramUniform2uiv(program, location, 1, glm::value_ptr(value));
    }
    void operator()(const glm::mat3& value) const {
        gl.ProgramUniformMatrix3fv(program, location, 1, GL_FALSE, glm::value_ptr(value));
    }
    void operator()(const glm::mat4& value) const {
        gl.ProgramUniformMatrix4fv(program, location, 1, GL_FALSE, glm::value_ptr(value));
    }
    void operator()(const std::vector<glm::vec4>& values) const {
        if (!values.empty()) {
            gl.ProgramUniform4fv(program, location, static_cast<GLsizei>(values.size()),
                                 glm::value_ptr(values.front()));
        }
    }
};

}  // namespace

Program::Program(Device& device, std::string_view label)
    : Object(device, ObjectKind::program, device.gl().CreateProgram(), label), label_(label) {}

void Program::find_uniforms(const std::set<std::string>& declared) {
    for (const std::string& uniform : declared) uniforms_.emplace(uniform, Known{});
    find_active_uniforms();
}

void Program::find_active_uniforms() {
    GLint count = 0;
    GLint longest = 0;
    gl().GetProgramInterfaceiv(name(), GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
    gl().GetProgramInterfaceiv(name(), GL_UNIFORM, GL_MAX_NAME_LENGTH, &longest);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        std::string uniform(static_cast<std::size_t>(longest), '\0');
        GLsizei length = 0;
        gl().GetProgramResourceName(name(), GL_UNIFORM, i, longest, &length, uniform.data());
        uniform.resize(static_cast<std::size_t>(length));
        const GLint location = gl().GetProgramResourceLocation(name(), GL_UNIFORM, uniform.c_str());
        if (location < 0) continue;  // a member of a uniform block
        const bool is_array = uniform.ends_with("[0]");
        if (is_array) uniform.resize(uniform.size() - 3);
        constexpr GLenum property = GL_TYPE;
        GLint type = 0;
        gl().GetProgramResourceiv(name(), GL_UNIFORM, i, 1, &property, 1, nullptr, &type);
        uniforms_[std::move(uniform)] = {location, value_index(static_cast<GLenum>(type), is_array)};
    }
}

void Program::use(const Uniforms& uniforms) const {
    require_each_once(uniforms);
    for (const Uniform& uniform : uniforms) {
        const auto found = uniforms_.find(uniform.name);
        if (found == uniforms_.end()) {
            throw ProgramError(fmt::format("{}: no uniform '{}'", label_, uniform.name));
        }
        if (found->second.value_index) {
            std::visit(Setter{gl(), name(), found->second.location}, uniform.value);
        }
    }
    gl().UseProgram(name());
}

void Program::require_each_once(const Uniforms& uniforms) const {
    for (const auto& [uniform, known] : uniforms_) {
        if (!known.value_index) continue;
        const auto is_meant = [&uniform = uniform](const Uniform& each) { return each.name == uniform; };
        const auto found = std::find_if(uniforms.begin(), uniforms.end(), is_meant);
        const auto fail = [&, &uniform = uniform](std::string_view fault) {
            throw ProgramError(fmt::format("{}: uniform '{}' {}", label_, uniform, fault));
        };
        if (found == uniforms.end()) fail("is not set");
        if (found->value.index() != known.value_index) fail("has another type");
        if (std::find_if(found + 1, uniforms.end(), is_meant) != uniforms.end()) fail("is set twice");
    }
}

}  // namespace candela::gl
