#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <candela/gl_loader.hpp>
#include <candela/graph/describe.hpp>
#include <candela/inspection.hpp>
#include <candela/renderer.hpp>
#include "sandbox/candela_private.hpp"
#include "sandbox/headless/update_budget.hpp"
#include "sandbox/window/frame_request.hpp"
#include "sandbox/window/noise_estimate.hpp"
#include "sandbox/window/obsolete.hpp"

namespace candela::sandbox {

/// Renders the frames that requests ask for, into textures of its own. To be used like the renderer: in the
/// GL context in which it was made.
class FrameRenderer {
 public:
    /// Sets of textures. A frame leaves those of the other slots as they are.
    static constexpr std::size_t slots = 3;

    /// Throws what the Renderer throws.
    FrameRenderer(gl::GetProc functions, RendererOptions options);

    /// Replaces the request before it.
    void begin(FrameRequest request, std::uint64_t number);
    [[nodiscard]] bool has_request() const { return request_.has_value(); }
    /// Whether rendering the request again would give the same picture.
    [[nodiscard]] bool settled() const { return settled_; }
    /// Whether the next frame has another graph than the last one, whose shaders may have to be compiled.
    [[nodiscard]] bool needs_compiling() const;

    /// Whether a frame of the request is finished: the next one only makes it better.
    [[nodiscard]] bool refines() const { return refines_; }

    /// The next frame of the request, in the textures of this slot, without RenderedFrame::input. With
    /// `reload` it reads the shaders again. Throws nothing of the renderer's: RenderedFrame::errors has it.
    /// Asks now and then whether the frame is still wanted. Nothing if it is not: the textures of the slot
    /// are then those of no frame, and the next call goes on with the work.
    [[nodiscard]] std::optional<RenderedFrame> render(std::size_t slot_index, bool reload,
                                                      const std::function<bool()>& wanted);

    [[nodiscard]] Renderer& renderer() { return *renderer_; }

 private:
    struct Slot {
        tools::Canvas picture;
        tools::Canvas other;
        tools::Canvas difference;
        tools::Canvas inspection;
    };

    [[nodiscard]] std::unique_ptr<Renderer> make_renderer() const;
    std::optional<std::string> replace_renderers();
    std::optional<RenderedFrame> render_request(Slot& slot, const FrameOptions& options);
    void fit(tools::Canvas& canvas, glm::uvec2 size);
    [[nodiscard]] RenderView view_on(const Target& target) const;
    std::vector<std::string> configure_new(Renderer& renderer, const Configuration& wanted) const;
    bool draw(Renderer& renderer, tools::Canvas& canvas, const FrameOptions& options);
    bool draw_second(RenderedFrame& frame, Slot& slot, const FrameOptions& options);
    bool draw_other(tools::Canvas& canvas, const FrameOptions& options);
    void draw_reference(tools::Canvas& canvas);
    FinishedTexture draw_difference_of(Slot& slot);
    void inspect(RenderedFrame& frame, tools::Canvas& canvas);
    std::shared_ptr<const Report> report();
    [[nodiscard]] bool estimates_noise() const;
    [[nodiscard]] std::optional<ProbedPixel> probe(const tools::Canvas& picture,
                                                   const ResultTexture& radiance);
    [[nodiscard]] bool is_quiet() const;
    void estimate_noise(const ResultTexture& radiance);
    std::shared_ptr<const GraphDescription> graph();

    gl::GetProc functions_;
    RendererOptions options_;
    gl::Device device_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<ResourceInspector> inspector_ = std::make_unique<ResourceInspector>(*renderer_);
    std::unique_ptr<Renderer> other_;  ///< while a request has a second configuration
    std::array<Slot, slots> slots_;
    std::optional<FrameRequest> request_;
    UpdateBudget budget_;
    std::uint64_t number_ = 0;
    std::vector<std::string> errors_;          ///< of the request
    std::optional<std::string> reload_error_;  ///< of the shaders that were read last
    bool settled_ = true;
    bool refines_ = false;
    glm::uvec2 size_{1};  ///< pixels of the present frame
    std::optional<FinishedFrame> last_;
    bool has_rendered_ = false;
    std::shared_ptr<const Report> report_;
    Clock::time_point report_time_;
    NoiseEstimate noise_;
    Clock::time_point noise_time_;  ///< report_time_ when it was estimated
    std::shared_ptr<const GraphDescription> graph_;
    std::vector<std::string> graph_passes_;
    Clock::time_point graph_time_;  ///< report_time_ when it was made
};

}  // namespace candela::sandbox
