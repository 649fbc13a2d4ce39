#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <candela/api.hpp>
#include <candela/error.hpp>
#include <candela/gl_loader.hpp>

namespace candela {

/// No context could be made. The message is one line that lists every attempt and why it failed.
struct CANDELA_API ContextError : Error {
    using Error::Error;
};

/// The API that makes a headless context.
enum class ContextKind : std::uint8_t { egl, osmesa };
/// "egl" or "osmesa".
[[nodiscard]] CANDELA_API std::string_view to_string(ContextKind kind);

struct ContextOptions {
    bool debug = false;  ///< ask for a debug context (EGL only; ignored by OSMesa)
};

/// An OpenGL 4.5 core context without a window. Its default framebuffer, if any, is only a few pixels large:
/// draw into framebuffer objects. The EGL or OSMesa library is loaded when the first context of that kind is
/// made. Contexts of both kinds may exist in one process; at most one is current per thread. Destroying the
/// current context leaves no context current.
class CANDELA_API HeadlessContext {
 public:
    /// Makes a context, which is not yet current. EGL tries hardware devices, then Mesa's surfaceless
    /// platform, then software devices, and takes the first that works. Throws ContextError.
    [[nodiscard]] static std::unique_ptr<HeadlessContext> create(ContextKind kind,
                                                                 const ContextOptions& options = {});

    /// Whether this build supports contexts of this kind: EGL always, OSMesa if GL/osmesa.h was found.
    [[nodiscard]] static bool is_built(ContextKind kind);

    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;
    virtual ~HeadlessContext() = default;

    /// Makes the context current in the calling thread. Throws ContextError if the driver refuses.
    virtual void make_current() = 0;
    /// Looks up GL functions, for Renderer. Valid until the process ends.
    [[nodiscard]] virtual gl::GetProc get_proc() const = 0;
    /// How the context was made: "EGL device /dev/dri/card0", "EGL surfaceless", "OSMesa".
    [[nodiscard]] virtual std::string description() const = 0;

 protected:
    HeadlessContext() = default;
};

}  // namespace candela
