#include "renderer/gl/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace candela::gl {
namespace {

std::string get_string(PFNGLGETSTRINGPROC get, GLenum name) {
    const GLubyte* text = get(name);
    return text ? reinterpret_cast<const char*>(text) : "";
}

/// Checked before functions are loaded: otherwise, with too old a version, the error would name a single
/// missing function.
void require_version(const GetProc& get_proc) {
    if (!get_proc) throw GlError("the host gives no function to look up GL functions");
    const auto get = reinterpret_cast<PFNGLGETSTRINGPROC>(get_proc("glGetString"));
    const auto get_integer = reinterpret_cast<PFNGLGETINTEGERVPROC>(get_proc("glGetIntegerv"));
    if (!get || !get_integer) {
        throw GlError("the host's function look-up knows no glGetString or glGetIntegerv");
    }
    const std::string version = get_string(get, GL_VERSION);
    if (version.empty()) throw GlError("no OpenGL context is current");

    GLint major = 0;
    GLint minor = 0;
    get_integer(GL_MAJOR_VERSION, &major);
    get_integer(GL_MINOR_VERSION, &minor);
    if (major * 10 + minor < 45 || version.starts_with("OpenGL ES")) {
        throw GlError(
            fmt::format("OpenGL 4.5 is needed; {} offers {}", get_string(get, GL_RENDERER), version));
    }
}

std::vector<std::string> get_extensions(const Functions& gl) {
    std::vector<std::string> names;
    const GLuint count = get_unsigned(gl, GL_NUM_EXTENSIONS);
    names.reserve(count);
    for (GLuint i = 0; i < count; ++i) {
        names.emplace_back(reinterpret_cast<const char*>(gl.GetStringi(GL_EXTENSIONS, i)));
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// Whether a GL_RENDERER is one of the drivers that render on the CPU.
bool is_software(std::string_view renderer) {
    constexpr std::array<std::string_view, 4> names{"llvmpipe", "softpipe", "SWR", "Software"};
    return std::ranges::any_of(names, [&](auto name) { return renderer.find(name) != renderer.npos; });
}

Limits get_limits(const Functions& gl, std::string_view renderer, bool anisotropic) {
    Limits limits;
    limits.software = is_software(renderer);
    if (limits.software) limits.loop_iterations = 65'535;  // Mesa's LP_MAX_TGSI_LOOP_ITERATIONS
    limits.texture_size = get_unsigned(gl, GL_MAX_TEXTURE_SIZE);
    limits.texture_layers = get_unsigned(gl, GL_MAX_ARRAY_TEXTURE_LAYERS);
    limits.buffer_texels = get_unsigned(gl, GL_MAX_TEXTURE_BUFFER_SIZE);
    limits.storage_blocks = std::min({get_unsigned(gl, GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS),
                                      get_unsigned(gl, GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS),
                                      get_unsigned(gl, GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS)});
    limits.drawing_storage_blocks = std::min(get_unsigned(gl, GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS),
                                             get_unsigned(gl, GL_MAX_GEOMETRY_SHADER_STORAGE_BLOCKS));
    limits.storage_bindings = get_unsigned(gl, GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
    limits.uniform_bindings = get_unsigned(gl, GL_MAX_UNIFORM_BUFFER_BINDINGS);
    limits.texture_units = get_unsigned(gl, GL_MAX_TEXTURE_IMAGE_UNITS);
    gl.GetIntegerv(GL_MAX_DEBUG_GROUP_STACK_DEPTH, &limits.debug_groups);
    if (anisotropic) gl.GetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &limits.anisotropy);
    return limits;
}

/// The function by which the host limits the threads on which the driver compiles; null without them.
PFNGLMAXSHADERCOMPILERTHREADSKHRPROC find_compiler_threads(const GetProc& get_proc, const Device& device) {
    const char* name = nullptr;
    if (device.has_extension("GL_KHR_parallel_shader_compile")) {
        name = "glMaxShaderCompilerThreadsKHR";
    } else if (device.has_extension("GL_ARB_parallel_shader_compile")) {
        name = "glMaxShaderCompilerThreadsARB";
    }
    return name == nullptr ? nullptr : reinterpret_cast<PFNGLMAXSHADERCOMPILERTHREADSKHRPROC>(get_proc(name));
}

Functions load_checked(const GetProc& get_proc) {
    require_version(get_proc);
    return load_functions(get_proc);
}

}  // namespace

Device::Device(const GetProc& get_proc, DebugOutput debug_output, DebugReceiver receiver)
    : functions_(load_checked(get_proc)),
      vendor_(get_string(functions_.GetString, GL_VENDOR)),
      renderer_(get_string(functions_.GetString, GL_RENDERER)),
      version_(get_string(functions_.GetString, GL_VERSION)),
      extensions_(get_extensions(functions_)),
      limits_(get_limits(functions_, renderer_,
                         has_extension("GL_ARB_texture_filter_anisotropic") ||
                             has_extension("GL_EXT_texture_filter_anisotropic"))) {
    functions_.MaxShaderCompilerThreadsKHR = find_compiler_threads(get_proc, *this);
    if (debug_output == DebugOutput::on) log_.emplace(functions_, std::move(receiver));
}

std::vector<DebugMessage> Device::take_messages() {
    return log_ ? log_->take() : std::vector<DebugMessage>();
}

bool Device::has_extension(std::string_view name) const {
    return std::binary_search(extensions_.begin(), extensions_.end(), name);
}

}  // namespace candela::gl
