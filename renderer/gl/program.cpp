#include "renderer/gl/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

namespace candela::gl {
namespace {

GLenum stage_of(std::string_view file) {
    if (file.ends_with(".vert")) return GL_VERTEX_SHADER;
    if (file.ends_with(".frag")) return GL_FRAGMENT_SHADER;
    if (file.ends_with(".geom")) return GL_GEOMETRY_SHADER;
    if (file.ends_with(".comp")) return GL_COMPUTE_SHADER;
    throw ProgramError(fmt::format("shaders/{}: a stage file ends in .vert, .frag, .geom or .comp", file));
}

template <class Length, class Log>
std::string info_log(Length get_parameter, Log get_log, GLuint object) {
    GLint length = 0;
    get_parameter(object, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    GLsizei written = 0;
    get_log(object, static_cast<GLsizei>(log.size()), &written, log.data());
    log.resize(static_cast<std::size_t>(written));
    return log;
}

/// A shader object of one stage.
class Shader {
 public:
    Shader(const Functions& gl, GLenum stage, const ShaderSource& source)
        : gl_(gl), name_(gl.CreateShader(stage)) {
        const char* text = source.text.data();
        const auto length = static_cast<GLint>(source.text.size());
        gl_.ShaderSource(name_, 1, &text, &length);
        gl_.CompileShader(name_);
    }
    ~Shader() { gl_.DeleteShader(name_); }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;

    [[nodiscard]] GLuint name() const { return name_; }
    /// The driver's messages if it did not compile.
    [[nodiscard]] std::optional<std::string> failure() const {
        GLint compiled = GL_FALSE;
        gl_.GetShaderiv(name_, GL_COMPILE_STATUS, &compiled);
        if (compiled == GL_TRUE) return std::nullopt;
        return info_log(gl_.GetShaderiv, gl_.GetShaderInfoLog, name_);
    }

 private:
    const Functions& gl_;
    GLuint name_;
};

/// Adds the names of the uniforms outside of blocks that a shader declares, whether or not a variant uses
/// them: "uniform TYPE a, b[2];".
void add_declared_uniforms(std::string_view text, std::set<std::string>& names) {
    constexpr std::string_view keyword = "uniform ";
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    for (auto at = text.find(keyword); at != std::string_view::npos; at = text.find(keyword, at + 1)) {
        std::string_view rest = text.substr(at + keyword.size());
        rest = rest.substr(0, rest.find_first_of(";{"));
        rest.remove_prefix(std::min(rest.find(' '), rest.size()));  // the type
        while (rest.find_first_of(letters) != std::string_view::npos) {
            rest.remove_prefix(rest.find_first_of(letters));
            names.emplace(rest.substr(0, rest.find_first_not_of(letters)));
            rest.remove_prefix(std::min(rest.find(','), rest.size()));
        }
    }
}

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

Program::Program(Device& device, std::string_view label, std::span<const GLuint> shaders,
                 const std::set<std::string>& declared)
    : Object(device, ObjectKind::program, device.gl().CreateProgram(), label), label_(label) {
    link(label, shaders);
    for (const std::string& uniform : declared) uniforms_.emplace(uniform, Known{});
    find_uniforms();
}

void Program::link(std::string_view label, std::span<const GLuint> shaders) const {
    for (const GLuint shader : shaders) gl().AttachShader(name(), shader);
    gl().LinkProgram(name());
    for (const GLuint shader : shaders) gl().DetachShader(name(), shader);
    GLint linked = GL_FALSE;
    gl().GetProgramiv(name(), GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) return;
    throw ProgramError(fmt::format("{} do not link: {}", label,
                                   info_log(gl().GetProgramiv, gl().GetProgramInfoLog, name())));
}

void Program::find_uniforms() {
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

Program compile(Device& device, const ShaderLibrary& library, const std::vector<std::string>& stages,
                const std::vector<Define>& defines) {
    std::vector<std::unique_ptr<const Shader>> shaders;
    std::vector<GLuint> names;
    std::set<std::string> uniforms;
    for (const std::string& stage : stages) {
        const GLenum kind = stage_of(stage);
        const ShaderSource source = assemble(library, stage, defines);
        add_declared_uniforms(source.text, uniforms);
        shaders.push_back(std::make_unique<const Shader>(device.gl(), kind, source));
        names.push_back(shaders.back()->name());
        if (const auto log = shaders.back()->failure()) {
            throw ProgramError(
                fmt::format("shaders/{} does not compile:\n{}", stage, map_log(*log, source.files)));
        }
    }
    return Program(device, fmt::format("{}", fmt::join(stages, " and ")), names, uniforms);
}

}  // namespace candela::gl
