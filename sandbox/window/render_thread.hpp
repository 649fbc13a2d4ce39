#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include <candela/renderer.hpp>
#include "sandbox/window/frame_request.hpp"
#include "sandbox/window/thread_context.hpp"

namespace candela::sandbox {

/// What a render thread is doing.
enum class RenderStage : std::uint8_t { idle, compiling, rendering };

/// Renders in a thread and a GL context of its own, so that the window answers at once however long a frame
/// takes. It renders the newest request; while nothing is requested, it goes on with that request until
/// refinement has finished. A frame that a newer request makes obsolete is given up: see is_obsolete. Member
/// functions are called by the thread of the window.
class RenderThread {
 public:
    /// Creates the renderer in the new thread. `notify` is called from that thread whenever a frame is ready
    /// or the thread has failed; `warn` receives the renderer's warnings there.
    RenderThread(std::unique_ptr<ThreadContext> context, RendererOptions options,
                 std::function<void()> notify);
    /// Gives the frame in progress up, and waits for that.
    ~RenderThread();
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    /// Replaces the request before it. Returns the request's number; the first one is 1.
    std::uint64_t submit(FrameRequest request);
    /// The newest frame that was not taken yet. Invalidates the textures of the frame taken before. Throws
    /// what has ended the thread: gl::GlError or gl::ProgramError if there is no renderer.
    [[nodiscard]] std::optional<RenderedFrame> take();
    /// The same, but waits for a frame of this request.
    [[nodiscard]] RenderedFrame wait_for(std::uint64_t request);

    /// While paused, no frame begins, and one that only refines the picture is given up.
    void pause(bool paused);
    /// While on, no frame begins that would only refine the picture, until the next request; the one in
    /// progress is given up.
    void hold_refinement(bool on);
    /// Runs a job in the thread, between two frames, and waits for it. Passes on what it throws.
    void run(const std::function<void(Renderer&)>& job);
    /// Creates the renderer again, so that it reads the shaders again. If that fails, the next frame's errors
    /// say why, and the old renderer stays.
    void reload_shaders();

    [[nodiscard]] RenderStage stage() const;
    /// How long the present stage has taken.
    [[nodiscard]] std::chrono::duration<double> stage_time() const;
    /// Asks the thread to give its frame up and end. True once it has ended; waits up to `seconds` for that.
    [[nodiscard]] bool stop(double seconds);

 private:
    class Worker;
    struct Shared;

    std::unique_ptr<Shared> shared_;
    std::unique_ptr<ThreadContext> context_;
    std::thread thread_;
};

}  // namespace candela::sandbox
