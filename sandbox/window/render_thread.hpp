#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <glm/vec2.hpp>

#include <candela/inspection.hpp>
#include <candela/renderer.hpp>
#include "sandbox/files/picture.hpp"
#include "sandbox/window/thread_context.hpp"

namespace candela::sandbox {

using Clock = std::chrono::steady_clock;

/// What the render thread is to show.
struct FrameRequest {
    std::shared_ptr<const World> world;  ///< a copy that nobody changes
    Entity camera;
    glm::uvec2 size{1};  ///< pixels
    Configuration configuration;
    std::optional<Configuration> other{};  ///< the same view is rendered with this one, too
    /// Linear radiance that is tone-mapped into RenderedFrame::other, instead of `other`; may be null.
    std::shared_ptr<const Picture> reference{};
    std::optional<float> difference{};       ///< fills RenderedFrame::difference: this factor
    std::optional<Inspection> inspection{};  ///< fills RenderedFrame::inspection
    bool read_vpls = false;                  ///< fills RenderedFrame::vpls
    bool read_radiance = false;              ///< fills RenderedFrame::radiance
    bool cut = false;  ///< nothing moves on from the request before: no frame of reduced quality comes first
    /// When the oldest input event that this request answers arrived.
    std::optional<Clock::time_point> input{};
    bool operator==(const FrameRequest&) const = default;
};

/// A VPL as the user sees it.
struct VplDot {
    glm::vec3 position{0.0F};  ///< world space, metres
    glm::vec3 normal{0.0F};
    glm::vec3 flux{0.0F};  ///< linear, in the lights' unit of flux
    float area = 0.0F;     ///< m², of its cell; 0 for VPLs on paths
};

/// A texture that the render thread has finished, valid until the next call of RenderThread::take.
struct FinishedTexture {
    std::uint32_t texture = 0;  ///< GL name, rgba8, tone-mapped; the bottom row first
    glm::uvec2 size{0};         ///< pixels
};

/// A frame that is ready to be shown.
struct RenderedFrame {
    std::uint64_t request = 0;  ///< its number
    FinishedTexture picture;
    std::optional<FinishedTexture> other;
    std::optional<FinishedTexture> difference;   ///< |picture - other|, times the factor
    std::optional<InspectionResult> inspection;  ///< its texture is like the others here
    BufferElements elements;                 ///< the first ones of the inspected resource, if it is a buffer
    std::optional<Clock::time_point> input;  ///< of the request, in its first frame only
    /// Why the picture is older than the request, one per string: errors in its configuration, or what the
    /// renderer threw.
    std::vector<std::string> errors;
    Configuration configuration;  ///< that the picture was rendered with
    bool settled = false;         ///< no better picture of this request will follow
    Quality quality;
    std::shared_ptr<const Report> report;  ///< of this frame or of one shortly before; null after an error
    std::vector<FrameReport> times;        ///< of frames whose GPU times have arrived since the last frame
    std::shared_ptr<const std::string> graph;  ///< Renderer::describe as JSON
    std::vector<VplDot> vpls;
    std::shared_ptr<const Picture> radiance;
};

/// What a render thread is doing.
enum class RenderStage : std::uint8_t { idle, compiling, rendering };

/// Renders in a thread and a GL context of its own, so that the window answers at once however long a frame
/// takes. It renders the newest request; while nothing is requested, it goes on with that request until
/// refinement has finished. Member functions are called by the thread of the window.
class RenderThread {
 public:
    /// Creates the renderer in the new thread. `notify` is called from that thread whenever a frame is ready
    /// or the thread has failed; `warn` receives the renderer's warnings there.
    RenderThread(std::unique_ptr<ThreadContext> context, RendererOptions options,
                 std::function<void()> notify);
    /// Waits for the frame in progress.
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

    /// While paused, no frame begins.
    void pause(bool paused);
    /// While on, no frame begins that would only refine the picture, until the next request.
    void hold_refinement(bool on);
    /// Runs a job in the thread, between two frames, and waits for it. Passes on what it throws.
    void run(const std::function<void(Renderer&)>& job);
    /// Creates the renderer again, so that it reads the shaders again. If that fails, the next frame's errors
    /// say why, and the old renderer stays.
    void reload_shaders();

    [[nodiscard]] RenderStage stage() const;
    /// How long the present stage has taken.
    [[nodiscard]] std::chrono::duration<double> stage_time() const;
    /// Asks the thread to end after its frame. True once it has ended; waits up to `seconds` for that.
    [[nodiscard]] bool stop(double seconds);

 private:
    class Worker;
    struct Shared;

    std::unique_ptr<Shared> shared_;
    std::unique_ptr<ThreadContext> context_;
    std::thread thread_;
};

}  // namespace candela::sandbox
