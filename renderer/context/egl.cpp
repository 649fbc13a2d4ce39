#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "renderer/context/kinds.hpp"
#include "renderer/context/library.hpp"

namespace candela {
namespace {

/// The functions of EGL. Functions of extensions are null where EGL lacks them.
struct Egl {
    PFNEGLGETPROCADDRESSPROC get_proc = nullptr;
    PFNEGLGETERRORPROC error = nullptr;
    PFNEGLQUERYSTRINGPROC query_string = nullptr;
    PFNEGLINITIALIZEPROC initialize = nullptr;
    PFNEGLBINDAPIPROC bind_api = nullptr;
    PFNEGLCHOOSECONFIGPROC choose_config = nullptr;
    PFNEGLCREATECONTEXTPROC create_context = nullptr;
    PFNEGLDESTROYCONTEXTPROC destroy_context = nullptr;
    PFNEGLCREATEPBUFFERSURFACEPROC create_pbuffer = nullptr;
    PFNEGLDESTROYSURFACEPROC destroy_surface = nullptr;
    PFNEGLMAKECURRENTPROC make_current = nullptr;
    PFNEGLGETCURRENTCONTEXTPROC current_context = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC platform_display = nullptr;
    PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string = nullptr;
};

Egl open_egl() {
    const Library library{"libEGL.so.1"};
    Egl egl;
    library.find("eglGetProcAddress", egl.get_proc);
    library.find("eglGetError", egl.error);
    library.find("eglQueryString", egl.query_string);
    library.find("eglInitialize", egl.initialize);
    library.find("eglBindAPI", egl.bind_api);
    library.find("eglChooseConfig", egl.choose_config);
    library.find("eglCreateContext", egl.create_context);
    library.find("eglDestroyContext", egl.destroy_context);
    library.find("eglCreatePbufferSurface", egl.create_pbuffer);
    library.find("eglDestroySurface", egl.destroy_surface);
    library.find("eglMakeCurrent", egl.make_current);
    library.find("eglGetCurrentContext", egl.current_context);

    const auto find_extension = [&](const char* name, auto& function) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(egl.get_proc(name));
    };
    find_extension("eglGetPlatformDisplayEXT", egl.platform_display);
    find_extension("eglQueryDevicesEXT", egl.query_devices);
    find_extension("eglQueryDeviceStringEXT", egl.query_device_string);
    return egl;
}

/// Whether `name` is in a space-separated list of extensions, which may be null.
bool lists(const char* extensions, std::string_view name) {
    return extensions && fmt::format(" {} ", extensions).find(fmt::format(" {} ", name)) != std::string::npos;
}

std::string_view error_name(EGLint error) {
    switch (error) {
        case EGL_SUCCESS:
            return "no error given";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT:
            return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        case EGL_BAD_SURFACE:
            return "EGL_BAD_SURFACE";
        case EGL_CONTEXT_LOST:
            return "EGL_CONTEXT_LOST";
        default:
            return "an unknown EGL error";
    }
}

/// An EGL display on which a context may be made.
struct Candidate {
    std::string name;
    EGLenum platform = EGL_NONE;
    void* native = nullptr;
};

class EglContext final : public HeadlessContext {
 public:
    EglContext(const Egl& egl, const Candidate& place, const ContextOptions& options)
        : egl_(egl),
          name_(place.name),
          display_(egl.platform_display(place.platform, place.native, nullptr)) {
        // Never terminated: EGL displays are shared by the whole process, and other contexts may use this
        // one.
        if (display_ == EGL_NO_DISPLAY || !egl_.initialize(display_, nullptr, nullptr)) fail("no display");
        egl_.bind_api(EGL_OPENGL_API);
        const EGLConfig config = choose_config();
        create_context(config, options);
        if (!lists(egl_.query_string(display_, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
            create_surface(config);
        }
    }
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;
    ~EglContext() override {
        egl_.bind_api(EGL_OPENGL_API);
        if (egl_.current_context() == context_) release();
        if (surface_ != EGL_NO_SURFACE) egl_.destroy_surface(display_, surface_);
        egl_.destroy_context(display_, context_);
    }

    void make_current() override {
        egl_.bind_api(EGL_OPENGL_API);
        // OSMesa may have replaced the driver's current context without EGL noticing: release the context
        // first, so that EGL binds it again.
        if (egl_.current_context() == context_) release();
        if (!egl_.make_current(display_, surface_, surface_, context_)) {
            fail("the context cannot be made current");
        }
    }
    [[nodiscard]] gl::GetProc get_proc() const override { return egl_.get_proc; }
    [[nodiscard]] std::string description() const override { return "EGL " + name_; }

 private:
    [[noreturn]] void fail(std::string_view what) const {
        throw ContextError(fmt::format("{} ({})", what, error_name(egl_.error())));
    }

    void release() const { egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

    [[nodiscard]] EGLConfig choose_config() const {
        constexpr std::array<EGLint, 5> wanted = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                                  EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = EGL_NO_CONFIG_KHR;
        EGLint count = 0;
        egl_.choose_config(display_, wanted.data(), &config, 1, &count);
        return count > 0 ? config : EGL_NO_CONFIG_KHR;
    }

    void create_context(EGLConfig config, const ContextOptions& options) {
        const std::array<EGLint, 9> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                                  4,
                                                  EGL_CONTEXT_MINOR_VERSION,
                                                  5,
                                                  EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                  EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                  options.debug ? EGL_CONTEXT_OPENGL_DEBUG : EGL_NONE,
                                                  EGL_TRUE,
                                                  EGL_NONE};
        context_ = egl_.create_context(display_, config, EGL_NO_CONTEXT, attributes.data());
        if (context_ == EGL_NO_CONTEXT) fail("no OpenGL 4.5 core context");
    }

    void create_surface(EGLConfig config) {
        constexpr std::array<EGLint, 5> one_pixel = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
        surface_ = egl_.create_pbuffer(display_, config, one_pixel.data());
        if (surface_ != EGL_NO_SURFACE) return;
        const EGLint error = egl_.error();
        egl_.destroy_context(display_, context_);
        throw ContextError(fmt::format("neither surfaceless contexts nor a pbuffer ({})", error_name(error)));
    }

    Egl egl_;
    std::string name_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    EGLSurface surface_ = EGL_NO_SURFACE;
};

std::vector<EGLDeviceEXT> get_devices(const Egl& egl) {
    EGLint count = 0;
    if (!egl.query_devices || !egl.query_devices(0, nullptr, &count)) return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    egl.query_devices(count, devices.data(), &count);
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

/// Displays to try, in order: hardware devices, Mesa's surfaceless platform (which chooses a device itself),
/// software devices.
std::vector<Candidate> get_candidates(const Egl& egl) {
    const char* client = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    std::vector<Candidate> candidates;
    std::vector<Candidate> software;
    if (lists(client, "EGL_EXT_platform_device") && egl.query_device_string) {
        for (EGLDeviceEXT device : get_devices(egl)) {
            const char* extensions = egl.query_device_string(device, EGL_EXTENSIONS);
            const bool is_software = lists(extensions, "EGL_MESA_device_software");
            const char* file = lists(extensions, "EGL_EXT_device_drm")
                                   ? egl.query_device_string(device, EGL_DRM_DEVICE_FILE_EXT)
                                   : nullptr;
            auto& group = is_software ? software : candidates;
            group.push_back(
                {is_software ? "software device" : fmt::format("device {}", file ? file : "of no name"),
                 EGL_PLATFORM_DEVICE_EXT, device});
        }
    }
    if (lists(client, "EGL_MESA_platform_surfaceless")) {
        candidates.push_back({"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY});
    }
    candidates.insert(candidates.end(), software.begin(), software.end());
    return candidates;
}

std::unique_ptr<HeadlessContext> create_on_first(const Egl& egl, const ContextOptions& options) {
    if (!egl.platform_display) throw ContextError("EGL cannot open displays without a window system");
    std::vector<std::string> failures;
    for (const Candidate& candidate : get_candidates(egl)) {
        try {
            return std::make_unique<EglContext>(egl, candidate, options);
        } catch (const ContextError& error) {
            failures.push_back(fmt::format("{}: {}", candidate.name, error.what()));
        }
    }
    if (failures.empty()) throw ContextError("EGL offers neither devices nor Mesa's surfaceless platform");
    throw ContextError(fmt::format("{}", fmt::join(failures, "; ")));
}

}  // namespace

std::unique_ptr<HeadlessContext> create_egl_context(const ContextOptions& options) {
    try {
        return create_on_first(open_egl(), options);
    } catch (const ContextError& error) {
        throw ContextError(fmt::format("no EGL context: {}", error.what()));
    }
}

}  // namespace candela
