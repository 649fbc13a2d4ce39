#include "renderer/gl/compiling_program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "renderer/gl/program_cache.hpp"

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

/// "a.vert and a.frag"
std::string label_of(const ProgramSource& source) {
    std::vector<std::string_view> files;
    for (const ProgramStage& stage : source) files.emplace_back(stage.file);
    return fmt::format("{}", fmt::join(files, " and "));
}

}  // namespace

ProgramSource assemble_program(const ShaderLibrary& library, const std::vector<std::string>& stages,
                               const std::vector<Define>& defines) {
    ProgramSource source;
    for (const std::string& file : stages) {
        source.push_back({.file = file, .kind = stage_of(file), .source = assemble(library, file, defines)});
    }
    return source;
}

CompilingProgram::Shader::Shader(const Functions& gl, const ProgramStage& stage)
    : gl_(&gl), name_(gl.CreateShader(stage.kind)) {
    const char* text = stage.source.text.data();
    const auto length = static_cast<GLint>(stage.source.text.size());
    gl.ShaderSource(name_, 1, &text, &length);
    gl.CompileShader(name_);
}

CompilingProgram::Shader::Shader(Shader&& other) noexcept
    : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}

CompilingProgram::Shader::~Shader() {
    if (name_ != 0) gl_->DeleteShader(name_);
}

CompilingProgram::CompilingProgram(Device& device, ProgramSource source, ProgramCache* cache)
    : device_(&device), source_(std::move(source)), cache_(cache), program_(device, label_of(source_)) {
    if (cache_ == nullptr || !cache_->load(program_.name(), source_)) start_compiling();
}

void CompilingProgram::start_compiling() {
    const Functions& gl = device_->gl();
    for (const ProgramStage& stage : source_) shaders_.emplace_back(gl, stage);
    if (cache_ != nullptr) gl.ProgramParameteri(program_.name(), GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    for (const Shader& shader : shaders_) gl.AttachShader(program_.name(), shader.name());
    gl.LinkProgram(program_.name());
}

bool CompilingProgram::is_done() const {
    if (device_->gl().MaxShaderCompilerThreadsKHR == nullptr) return false;
    GLint done = GL_FALSE;
    device_->gl().GetProgramiv(program_.name(), GL_COMPLETION_STATUS_KHR, &done);
    return done == GL_TRUE;
}

bool CompilingProgram::is_linked() const {
    GLint linked = GL_FALSE;
    device_->gl().GetProgramiv(program_.name(), GL_LINK_STATUS, &linked);
    return linked == GL_TRUE;
}

/// Throws ProgramError with the driver's messages about the first stage that did not compile.
void CompilingProgram::require_compiled() const {
    const Functions& gl = device_->gl();
    for (std::size_t i = 0; i < shaders_.size(); ++i) {
        GLint compiled = GL_FALSE;
        gl.GetShaderiv(shaders_[i].name(), GL_COMPILE_STATUS, &compiled);
        if (compiled == GL_TRUE) continue;
        const std::string log = info_log(gl.GetShaderiv, gl.GetShaderInfoLog, shaders_[i].name());
        throw ProgramError(fmt::format("shaders/{} does not compile:\n{}", source_[i].file,
                                       map_log(log, source_[i].source.files)));
    }
}

Program CompilingProgram::finish() {
    const Functions& gl = device_->gl();
    bool linked = is_linked();
    if (!linked && shaders_.empty()) {  // the driver refuses the binary of the cache
        start_compiling();
        linked = is_linked();
    }
    if (!linked) {
        require_compiled();
        throw ProgramError(fmt::format("{} do not link: {}", label_of(source_),
                                       info_log(gl.GetProgramiv, gl.GetProgramInfoLog, program_.name())));
    }
    if (cache_ != nullptr && !shaders_.empty()) cache_->store(program_.name(), source_);
    for (const Shader& shader : shaders_) gl.DetachShader(program_.name(), shader.name());
    shaders_.clear();
    std::set<std::string> declared;
    for (const ProgramStage& stage : source_) add_declared_uniforms(stage.source.text, declared);
    program_.find_uniforms(declared);
    return std::move(program_);
}

Program compile(Device& device, const ShaderLibrary& library, const std::vector<std::string>& stages,
                const std::vector<Define>& defines) {
    return CompilingProgram(device, assemble_program(library, stages, defines), nullptr).finish();
}

AllCompilerThreads::AllCompilerThreads(const Functions& gl) : gl_(gl) {
    if (gl_.MaxShaderCompilerThreadsKHR == nullptr) return;
    threads_ = get_unsigned(gl_, GL_MAX_SHADER_COMPILER_THREADS_KHR);
    constexpr GLuint all = 0xFFFFFFFF;  // as many as the driver would use by itself
    gl_.MaxShaderCompilerThreadsKHR(all);
}

AllCompilerThreads::~AllCompilerThreads() {
    if (gl_.MaxShaderCompilerThreadsKHR != nullptr) gl_.MaxShaderCompilerThreadsKHR(threads_);
}

}  // namespace candela::gl
