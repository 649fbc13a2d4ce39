#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <candela/api.hpp>
#include <candela/extension.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/execute.hpp>
#include <candela/renderer.hpp>
#include "renderer/facade/frame_schedule.hpp"
#include "renderer/frame/build_frame.hpp"
#include "renderer/gl/graph_backend.hpp"
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// What a Renderer is made of. Its functions are those of the same names there.
class CANDELA_PRIVATE Renderer::State {
 public:
    State(const gl::GetProc& get_proc, const RendererOptions& options);

    [[nodiscard]] std::vector<std::string> configure(const Configuration& configuration);
    [[nodiscard]] std::vector<std::string> prepare(const Configuration& configuration, const World& world,
                                                   std::span<const RenderView> views,
                                                   const CompileProgress& progress);
    [[nodiscard]] const Configuration& configuration() const { return configuration_; }
    bool render(const World& world, std::span<const RenderView> views, const FrameOptions& options);
    [[nodiscard]] FrameResults results(std::size_t view) const;
    void set_receivers(std::vector<Receiver> receivers);
    [[nodiscard]] std::vector<glm::vec3> received_light() const;
    [[nodiscard]] ResultBuffer received_light_buffer() const;
    [[nodiscard]] std::vector<std::string> extend(Extension extension);
    void remove_extension(std::string_view name);
    void invalidate();
    void verify(bool on) {
        backend_.clear_new(on);
        runtime_.set_verification(on);
    }
    void tone_map(const std::vector<glm::vec3>& radiance, const Target& target);
    void tone_map(GLuint texture, const Target& target);
    [[nodiscard]] std::vector<FrameReport> take_frames(bool wait);
    [[nodiscard]] Report report(std::size_t view);
    [[nodiscard]] GraphDescription description() const;
    [[nodiscard]] Quality quality() const { return {shape_.quality.scale, frame_.views.front().interleave}; }
    [[nodiscard]] bool settled() const { return schedule_.settled(); }
    [[nodiscard]] const std::vector<PassRecord>& last_passes() const { return last_passes_; }
    [[nodiscard]] Gpu& gpu() { return gpu_; }

 private:
    /// A finished frame whose GPU times have not arrived yet.
    struct PendingFrame {
        FrameReport report;
        Quality quality;
        bool worked_ahead = false;  // for later frames, which it would not have done if anything had moved
    };

    /// The surfaces that the host has drawn of a view, in the last frame.
    struct HostContent {
        HostSurfaces surfaces{};
        glm::uvec2 size{0};  // of the textures
        bool operator==(const HostContent&) const = default;
    };

    /// A frame that is declared: its programs are requested.
    struct Declared {
        CompiledGraph graph;
        FrameHandles frame;
    };

    [[nodiscard]] Declared declare(const Configuration& configuration, const FrameShape& shape,
                                   std::span<const Extension> extensions);
    void install(Declared declared, const Configuration& configuration, const FrameShape& shape,
                 std::vector<Extension> extensions);
    void switch_to(const Configuration& configuration, const FrameShape& shape,
                   std::vector<Extension> extensions);
    /// What the next frame is expected to be like.
    [[nodiscard]] const FrameShape& expected_shape() const {
        return !compiled_ && prepared_ ? *prepared_ : shape_;
    }
    [[nodiscard]] std::vector<FrameShape> shapes_to_prepare(const Configuration& configuration,
                                                            const World& world,
                                                            std::span<const RenderView> views);
    [[nodiscard]] std::vector<std::string> try_to(const Configuration& configuration,
                                                  std::vector<Extension> extensions);
    void require_room_for_maps(const Configuration& configuration) const;
    void require_views(std::span<const RenderView> views) const;
    void set_views(std::span<const RenderView> views);
    void set_view(const ViewHandles& handles, const RenderView& view);
    void set_surfaces(const HostSurfaceInputs& inputs, const HostSurfaces& surfaces, HostContent& last);
    [[nodiscard]] const ViewHandles& view_handles(std::size_t view) const;
    [[nodiscard]] FrameContents contents_now(const World& world);
    [[nodiscard]] double budget_ms(const Configuration& configuration) const;
    void learn_cost(const PendingFrame& frame);
    [[nodiscard]] FrameOutcome outcome() const;
    void match_times(const std::vector<FrameTime>& times);
    [[nodiscard]] bool refines() const;
    [[nodiscard]] VplReport report_vpls(const Vpls& vpls, const ViewHandles& view);
    [[nodiscard]] std::uint32_t count_filled(const ViewHandles& view) const;
    [[nodiscard]] std::optional<double> estimate_error(const ViewHandles& view) const;
    [[nodiscard]] LightReport report_lights(const ViewHandles& view) const;

    std::optional<std::uint32_t> shuffle_;  // RendererOptions::shuffle_passes
    Gpu gpu_;
    gl::GraphBackend backend_;
    GraphRuntime runtime_;
    Configuration configuration_;
    std::vector<Extension> extensions_;
    std::vector<Receiver> receivers_;
    bool compiled_ = false;                     // whether the programs of the graph are: not before the first
    std::optional<FrameShape> prepared_;        // the last frame that was
    FrameShape shape_;                          // of the last frame
    std::array<Tick, 2> contents_revisions_{};  // of the components that determine the contents
    std::uint32_t contents_vpls_ = 0;           // VplSettings::count then
    Tick contents_transforms_ = 0;              // revision of Transform then
    bool contents_depend_on_transforms_ = false;
    std::vector<HostContent> host_contents_;  // by view
    bool surfaces_bound_ = false;  // the host's textures have been bound since the last `switch_to`
    FrameHandles frame_;
    std::uint64_t epoch_ = 0;  // incremented by `invalidate`: cached scene data is void
    FrameSchedule schedule_;
    std::uint32_t received_ = 0;  // receivers in the last frame
    std::vector<PassRecord> last_passes_;
    std::uint64_t next_frame_ = 0;
    std::deque<PendingFrame> pending_;
    std::deque<FrameReport> arrived_;  // complete, but not yet taken
};

}  // namespace candela
