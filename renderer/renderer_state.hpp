#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <candela/graph/execute.hpp>
#include <candela/renderer.hpp>
#include "renderer/configuration/build_frame.hpp"
#include "renderer/frame_budget.hpp"
#include "renderer/gl/graph_backend.hpp"
#include "renderer/gpu.hpp"

namespace candela {

/// What a Renderer is made of. Its functions are those of the same names there.
class Renderer::State {
 public:
    State(const gl::GetProc& get_proc, const RendererOptions& options);

    [[nodiscard]] std::vector<std::string> configure(const Configuration& configuration);
    [[nodiscard]] const Configuration& configuration() const { return configuration_; }
    void render(const World& world, Entity camera, const Target& target, glm::vec2 jitter);
    void invalidate();
    void verify(bool on) { runtime_.set_verification(on); }
    void tone_map(const std::vector<glm::vec3>& radiance, const Target& target);
    [[nodiscard]] std::vector<FrameReport> take_frames(bool wait);
    [[nodiscard]] Report report();
    [[nodiscard]] std::string describe(GraphFormat format) const;
    [[nodiscard]] Quality quality() const { return {quality_.scale, frame_.interleave}; }
    [[nodiscard]] const std::vector<PassRecord>& last_passes() const { return last_passes_; }
    [[nodiscard]] gl::Device& device() { return gpu_.device(); }

 private:
    using Clock = std::chrono::steady_clock;
    /// A finished frame whose GPU times have not arrived yet.
    struct PendingFrame {
        FrameReport report;
        Quality quality;
    };

    /// Throws gl::GlError if the target cannot be drawn into.
    void require_possible(const Target& target) const;
    void switch_to(const Configuration& configuration, glm::uvec2 size, const Quality& quality,
                   const FrameContents& contents);
    [[nodiscard]] FrameContents contents_now(const World& world);
    [[nodiscard]] double budget_ms() const;
    [[nodiscard]] Quality quality_now(const World& world, const ViewRequest& request);
    void learn_cost(const PendingFrame& frame);
    void set_refinement_clock();
    void match_times(const std::vector<gl::FrameTime>& times);
    [[nodiscard]] VplReport report_vpls(const Vpls& vpls) const;
    [[nodiscard]] std::uint32_t count_lacking() const;
    [[nodiscard]] LightReport report_lights() const;

    Gpu gpu_;
    gl::GraphBackend backend_;
    GraphRuntime runtime_;
    Configuration configuration_;
    FrameContents contents_;                    // of the world in the last frame
    std::array<Tick, 3> contents_revisions_{};  // of the components that determine the contents
    Tick contents_transforms_ = 0;              // revision of Transform then
    bool contents_depend_on_transforms_ = false;
    glm::uvec2 size_{1};  // of the target
    Quality quality_;
    Quality quality_in_motion_;
    ViewRequest last_request_;
    Tick last_revision_ = 0;  // the world's, in the last frame
    Clock::time_point last_move_;
    FrameHandles frame_;
    std::uint64_t epoch_ = 0;  // incremented by `invalidate`: cached scene data is void
    RefinementClock refinement_clock_;
    bool refine_ = false;     // whether the next frame adds another sample to the mean
    bool completed_ = false;  // whether the last frame did not throw, nor was followed by `invalidate`
    std::vector<PassRecord> last_passes_;
    std::uint64_t next_frame_ = 0;
    std::deque<PendingFrame> pending_;
    std::deque<FrameReport> arrived_;  // complete, but not yet taken
};

}  // namespace candela
