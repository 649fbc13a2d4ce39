#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "renderer/gl/functions.hpp"

namespace candela {

/// No context to be had; the message lists in one line all that was tried and why each attempt failed.
struct ContextError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class ContextKind : std::uint8_t { egl, osmesa };
[[nodiscard]] std::string_view to_string(ContextKind kind);

struct ContextOptions {
    bool debug = false;  ///< ask the driver for a debug context, where the kind has such
};

/// An OpenGL 4.5 core context without a window and without a default framebuffer worth drawing into. Its
/// library is opened when the first one is made, never before. Contexts of both kinds may live in one
/// process; one is current in a thread at a time. Destroying a context that is current leaves none current.
class HeadlessContext {
 public:
    /// EGL: hardware devices, then Mesa's surfaceless platform, then software devices. OSMesa: as it is.
    /// The context is not yet current. Throws ContextError.
    [[nodiscard]] static std::unique_ptr<HeadlessContext> create(ContextKind kind,
                                                                 const ContextOptions& options = {});

    /// Whether the library was built with contexts of this kind: EGL always, OSMesa where its header was
    /// there.
    [[nodiscard]] static bool is_built(ContextKind kind);

    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;
    virtual ~HeadlessContext() = default;

    /// In the calling thread. Throws ContextError if the driver refuses.
    virtual void make_current() = 0;
    /// Valid as long as the process.
    [[nodiscard]] virtual gl::GetProc get_proc() const = 0;
    /// How it was made: "EGL device /dev/dri/card0", "EGL surfaceless", "OSMesa".
    [[nodiscard]] virtual std::string description() const = 0;

 protected:
    HeadlessContext() = default;
};

}  // namespace candela
