#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/ecs/world.hpp"
#include "engine/graph/execute.hpp"
#include "renderer/configuration/build_frame.hpp"
#include "renderer/configuration/configuration.hpp"
#include "renderer/frame_budget.hpp"
#include "renderer/frame_report.hpp"
#include "renderer/gl/graph_backend.hpp"
#include "renderer/gpu.hpp"

namespace candela {

/// Where a frame goes: a framebuffer of the host's (0: its window), drawn from the lower left corner on.
struct Target {
    GLuint framebuffer = 0;
    glm::uvec2 size{1};  ///< pixels
};

/// Where the light went, in the lights' unit of flux: emitted = absorbed + escaped + truncated + roulette. Of
/// surfels `emitted` is what arrives of it at surfaces, and the sum is right to within their spacing.
struct EnergyAccount {
    glm::dvec3 emitted{0.0};
    glm::dvec3 absorbed{0.0};
    glm::dvec3 escaped{0.0};
    glm::dvec3 truncated{0.0};  ///< still reflected when the last bounce was reached
    glm::dvec3 roulette{
        0.0};  ///< lost where paths ended early, less what their continuation was weighted up by
    glm::dvec3 roulette_error{0.0};  ///< standard error of `roulette`, whose expectation is zero
};

/// What became of the VPLs.
struct VplReport {
    std::uint32_t requested = 0;
    std::uint32_t alive = 0;
    std::uint32_t paths = 0;           ///< 0 of surfels
    std::uint32_t rays = 0;            ///< segments of the paths, those that hit nothing included
    std::uint32_t interleave = 1;      ///< n, where a pixel asks one in n² VPLs
    std::uint32_t lacking_pixels = 0;  ///< that asked more of them, as too few neighbours fitted
    EnergyAccount flux;
};

struct LightReport {
    std::uint32_t count = 0;
    std::uint32_t with_shadow = 0;
    std::uint32_t shadow_views = 0;    ///< rendered when shadow maps last changed: 6 a cube, else 1 a light
    std::uint32_t without_shadow = 0;  ///< that should cast shadows but found no room in the budget
    std::uint32_t global = 0;  ///< that every list visits, having no range, or no room in the lists' memory
    std::uint32_t tile_max =
        0;                   ///< lights that the longest list of a tile or cluster visits; 0 without lists
    double tile_mean = 0.0;  ///< the same in the mean of all tiles or clusters
};

/// The state after the last frame.
struct Report {
    std::string gl_renderer;
    std::uint64_t triangles = 0;
    std::optional<VplReport> vpls;  ///< none without indirect light
    std::uint32_t refined = 0;      ///< sets of VPLs in the picture's mean; 0 without refinement
    glm::uvec2 rendered_size{
        1};  ///< pixels that were shaded: the target's, or fewer to keep to the frame budget
    LightReport lights;
    MemoryUse memory;
};

enum class GraphFormat : std::uint8_t { text, dot, json };

/// Renders worlds. One instance belongs to one GL context, which is current in every call, the destructor
/// included. Several instances share nothing.
class Renderer {
 public:
    /// `get_proc` gives the addresses of GL functions, as glfwGetProcAddress does. Shaders come with the
    /// library, or, for those who work on them, from a directory. Throws gl::GlError if the context offers
    /// less than OpenGL 4.5.
    explicit Renderer(const gl::GetProc& get_proc, const std::filesystem::path& shader_directory = {});

    /// Takes a configuration from the next frame on. Gives what is wrong with it, a line each; then the
    /// present one goes on. Scene data, VPLs and shadow maps that both configurations want alike are kept.
    [[nodiscard]] std::vector<std::string> configure(const Configuration& configuration);
    [[nodiscard]] const Configuration& configuration() const { return configuration_; }

    /// Renders the world as the camera (an entity with a Camera) sees it; only what changed since the last
    /// frame is done anew. `jitter` moves the samples off the pixels' centres, in pixels. Leaves the host's
    /// GL state as gl::HostState says. Throws EntityError if there is no such camera, SceneError for
    /// impossible hierarchies, and gl::GlError where the driver runs out of memory; the next call then takes
    /// up from there.
    void render(const World& world, Entity camera, const Target& target, glm::vec2 jitter = glm::vec2(0.0F));

    /// Does everything anew in the next frame. A world is known by its address and its pools' revisions: call
    /// this after putting another world in the place of the last one.
    void invalidate();

    /// For tests: every frame's passes run again, those too that had nothing to do, and `render` throws
    /// GraphError where a pass gives another result than before, as it depends on what it did not declare:
    /// see GraphRuntime::verify. Reads all results back, and takes more than twice the time.
    void verify(bool on) { runtime_.set_verification(on); }

    /// Tone-maps a picture of linear radiance that was averaged elsewhere; row 0 is the bottom.
    void tone_map(const std::vector<glm::vec3>& radiance, const Target& target);

    /// Times of the frames whose GPU times have arrived since the last call, in order; nothing waits for the
    /// GPU, unless `wait` asks for all. Of frames that nobody takes the latest `kept_frames` are kept.
    [[nodiscard]] std::vector<FrameReport> take_frames(bool wait = false);
    static constexpr std::size_t kept_frames = 1024;

    /// Reads back what the last frame left; waits for the GPU.
    [[nodiscard]] Report report();

    /// The graph of the present configuration.
    [[nodiscard]] std::string describe(GraphFormat format) const;

    /// What the last frame was rendered with: less than in full only where that keeps it to the frame budget.
    [[nodiscard]] Quality quality() const { return {quality_.scale, frame_.interleave}; }

    /// Which passes ran in the last frame.
    [[nodiscard]] const std::vector<PassRecord>& last_passes() const { return last_passes_; }

    [[nodiscard]] gl::Device& device() { return gpu_.device(); }

 private:
    using Clock = std::chrono::steady_clock;
    /// A frame whose GPU times have not arrived.
    struct PendingFrame {
        FrameReport report;
        Quality quality;
    };

    void adopt(const Configuration& configuration, glm::uvec2 size, const Quality& quality);
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
    glm::uvec2 size_{1};  // of the target
    Quality quality_;
    Quality quality_in_motion_;
    ViewRequest last_request_;
    Tick last_revision_ = 0;  // of the world, in the last frame
    Clock::time_point last_move_;
    FrameHandles frame_;
    std::uint64_t epoch_ = 0;  // another one: nothing of the scene is known
    RefinementClock refinement_clock_;
    bool refine_ = false;           // whether the next frame is to add another set of VPLs to the mean
    const World* world_ = nullptr;  // of the last frame, if that was finished
    std::vector<PassRecord> last_passes_;
    std::uint64_t next_frame_ = 0;
    std::deque<PendingFrame> pending_;
    std::deque<FrameReport> arrived_;  // nobody has taken
};

}  // namespace candela
