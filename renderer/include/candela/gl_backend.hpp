#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <candela/api.hpp>
#include <candela/gl_error.hpp>
#include <candela/gl_loader.hpp>
#include <candela/graph/backend.hpp>

namespace candela {

/// GPU time of a pass in milliseconds; `pass` is its position in FrameRecord::passes.
struct PassTime {
    std::uint32_t pass = 0;
    double ms = 0.0;
};

/// GPU times of a frame in milliseconds: of all of it, and of the passes that ran, in their order.
struct FrameTime {
    std::uint64_t frame = 0;
    double ms = 0.0;
    std::vector<PassTime> passes{};
};

/// The frame graph's back end in OpenGL 4.5, for graphs of a host's own. Objects are GL names
/// (Execution::object). Before a pass runs, its attachments and bindings are bound, the viewport covers the
/// attachments, clip-space depth is in [0, 1], and depth test, culling and blending are off. A pass may leave
/// any state behind, and the host may change it between frames. Nothing is restored for the host.
///
/// The context must be current whenever the back end, or a GraphRuntime with it, is made, used or destroyed.
class CANDELA_API GlBackend {
 public:
    /// Throws gl::GlError if no context is current, if it is older than OpenGL 4.5, or if a function is
    /// missing.
    explicit GlBackend(const gl::GetProc& get_proc);
    GlBackend(const GlBackend&) = delete;
    GlBackend& operator=(const GlBackend&) = delete;
    ~GlBackend();

    /// For a GraphRuntime, which the GlBackend must outlive.
    [[nodiscard]] Backend& backend();

    // GPU times are measured of what lies between these two. `frame`: the number that its times will have.
    void begin_frame(std::uint64_t frame);
    void end_frame();
    /// Frames whose times have arrived since the last call, oldest first. Does not wait.
    [[nodiscard]] std::vector<FrameTime> take_times();

 private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace candela
