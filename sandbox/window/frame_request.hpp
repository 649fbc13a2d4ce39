#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/graph/describe.hpp>
#include <candela/inspection.hpp>
#include <candela/renderer.hpp>
#include <candela/tools/picture.hpp>

namespace candela::sandbox {

using Clock = std::chrono::steady_clock;

/// What a FrameRenderer is to show.
struct FrameRequest {
    std::shared_ptr<const World> world;  ///< a copy that nobody changes
    Entity camera;
    glm::uvec2 size{1};  ///< pixels; the first frame may have fewer: see first_size
    Configuration configuration;
    double update_budget_ms = 0.0;         ///< see UpdateBudget
    std::optional<Configuration> other{};  ///< the same view is rendered with this one, too
    /// Linear radiance that is tone-mapped into RenderedFrame::other, instead of `other`; may be null.
    std::shared_ptr<const tools::Picture> reference{};
    std::optional<float> difference{};       ///< fills RenderedFrame::difference: this factor
    std::optional<Inspection> inspection{};  ///< fills RenderedFrame::inspection
    bool read_vpls = false;                  ///< fills RenderedFrame::vpls
    bool read_radiance = false;              ///< fills RenderedFrame::radiance
    bool estimate_error = false;             ///< see RenderView::estimate_error
    std::optional<glm::uvec2> probe{};       ///< fills RenderedFrame::probed: across and up
    /// Refinement ends when NoiseEstimate::value falls to this; 0: only with the last frame. While a second
    /// configuration is rendered, too, always with the last frame.
    double noise_limit = 0.0;
    bool cut = false;  ///< nothing moves on from the request before: no frame of reduced quality comes first
    bool whole = false;  ///< also the first frame has all pixels, however long it takes
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

/// A texture that is finished, valid until the next call of RenderThread::take.
struct FinishedTexture {
    std::uint32_t texture = 0;  ///< GL name, rgba8, tone-mapped; the bottom row first
    glm::uvec2 size{0};         ///< pixels
};

/// What a pixel of the picture has.
struct ProbedPixel {
    glm::uvec2 at{0};          ///< across and up
    glm::vec3 radiance{0.0F};  ///< linear, before exposure and tone map
    glm::vec3 colour{0.0F};    ///< that is shown, 0 to 1, sRGB-encoded
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
    std::shared_ptr<const GraphDescription> graph;
    std::vector<VplDot> vpls;
    std::shared_ptr<const tools::Picture> radiance;
    std::optional<ProbedPixel> probed;
    std::optional<double> noise;  ///< NoiseEstimate::value, while refinement goes on or has ended
};

}  // namespace candela::sandbox
