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

/// The host's framebuffer that a frame is drawn into. The frame fills `size` pixels from the lower left
/// corner. Only colour is written. The host keeps ownership.
struct Target {
    GLuint framebuffer = 0;  ///< GL name; 0: the default framebuffer (the window)
    glm::uvec2 size{1};      ///< pixels
};

/// Flux balance of the indirect light, per colour channel, in the lights' unit of flux (lumens if intensities
/// are in candelas): emitted = absorbed + escaped + truncated + roulette. With surfels, `emitted` counts only
/// the light that reaches surfaces, and the balance holds to within the error caused by the spacing of the
/// surfels.
struct EnergyAccount {
    glm::dvec3 emitted{0.0};    ///< sent out by the real lights
    glm::dvec3 absorbed{0.0};   ///< by surfaces
    glm::dvec3 escaped{0.0};    ///< left the scene, or was cut off by a light's range
    glm::dvec3 truncated{0.0};  ///< reflected at the last bounce and not followed further
    /// Lost where Russian roulette ended paths, minus what the weights of the other paths added. 0 with
    /// surfels.
    glm::dvec3 roulette{0.0};
    glm::dvec3 roulette_error{0.0};  ///< standard error of `roulette`, whose expected value is 0
};

/// Counts of the VPLs and of the work done for them.
struct VplReport {
    std::uint32_t requested = 0;   ///< VplSettings::count
    std::uint32_t alive = 0;       ///< VPLs with a flux above zero
    std::uint32_t paths = 0;       ///< light paths; 0 with surfels
    std::uint32_t rays = 0;        ///< path segments, including those that hit nothing; 0 with surfels
    std::uint32_t interleave = 1;  ///< n: a pixel evaluates one in n² VPLs
    /// Pixels that evaluated additional VPLs, because too few neighbours lie on the same surface.
    std::uint32_t lacking_pixels = 0;
    EnergyAccount flux;
};

/// Counts of the real lights. Lights that emit nothing are not counted.
struct LightReport {
    std::uint32_t count = 0;
    std::uint32_t with_shadow = 0;   ///< lights that have a shadow map
    std::uint32_t shadow_views = 0;  ///< drawn in the last run of `shadow-maps`: 6 per cube, 1 per flat map
    /// Lights that should cast shadows but have no map: over ShadowSettings::budget_mib or the layer limit.
    std::uint32_t without_shadow = 0;
    /// Lights that every cell visits: they have no range, or the light lists would exceed their memory.
    std::uint32_t global = 0;
    std::uint32_t tile_max = 0;  ///< lights visited by the tile or cluster that visits most; 0 without lists
    double tile_mean = 0.0;      ///< lights visited, averaged over all tiles or clusters
};

/// What Renderer::report reads back about the last frame.
struct Report {
    std::string gl_renderer;        ///< GL_RENDERER
    std::uint64_t triangles = 0;    ///< of all instances; blended surfaces are not counted
    std::optional<VplReport> vpls;  ///< none without indirect light
    std::uint32_t refined = 0;      ///< frames that the picture averages; 0 without refinement
    /// Pixels that were shaded: the target's size, or less to keep to the frame budget.
    glm::uvec2 rendered_size{1};
    LightReport lights;
    MemoryUse memory;
};

/// Output of Renderer::describe: plain text, Graphviz DOT, or JSON.
enum class GraphFormat : std::uint8_t { text, dot, json };

/// Renders worlds. An instance belongs to one GL context, which must be current in every call, including the
/// destructor. Instances share nothing. Not synchronised.
class Renderer {
 public:
    /// `get_proc` returns the addresses of GL functions, as glfwGetProcAddress does; it is called only here.
    /// The shaders are embedded in the library; `shader_directory`, if given, is read in their place. Throws
    /// gl::GlError if the context offers less than OpenGL 4.5 or lacks a function, and gl::ProgramError if a
    /// shader does not compile.
    explicit Renderer(const gl::GetProc& get_proc, const std::filesystem::path& shader_directory = {});

    /// Switches to `configuration` from the next frame on. Returns the errors, one per string; if there are
    /// any, the current configuration stays. Scene data, VPLs and shadow maps are kept where their settings
    /// do not change.
    [[nodiscard]] std::vector<std::string> configure(const Configuration& configuration);
    [[nodiscard]] const Configuration& configuration() const { return configuration_; }

    /// Renders `world` as seen by `camera`, an entity with a Camera, into `target`. Only passes whose inputs
    /// have changed since the last frame run. `jitter` moves the samples off the pixel centres, in rendered
    /// pixels, +x right, +y up. Restores the host's GL state as described at gl::HostState.
    ///
    /// Throws EntityError if there is no such camera, SceneError if an entity's parents form a cycle or were
    /// destroyed, and gl::GlError if the target's size is 0 or above the driver's limit, if a driver limit is
    /// exceeded, or if the driver runs out of memory. After an exception, the next call runs the passes that
    /// did not finish.
    void render(const World& world, Entity camera, const Target& target, glm::vec2 jitter = glm::vec2(0.0F));

    /// Makes the next frame compute everything again. A world is recognised by its address and the revisions
    /// of its component pools: call this after putting another world at the address of the last one.
    void invalidate();

    /// For tests. Runs the passes of every frame a second time where that is possible, including passes that
    /// had nothing to do. `render` then throws GraphError where a pass gives another result than before,
    /// because it depends on an input that it does not declare: see GraphRuntime::verify. Reads all results
    /// back and takes more than twice the time.
    void verify(bool on) { runtime_.set_verification(on); }

    /// Tone-maps a picture of linear radiance that was computed elsewhere, for example an average of frames,
    /// into `target`. `radiance` holds target.size.x × target.size.y pixels row by row, the bottom row first.
    /// Throws gl::GlError if it holds another number of pixels.
    void tone_map(const std::vector<glm::vec3>& radiance, const Target& target);

    /// CPU and GPU times of the frames whose GPU times have arrived since the last call, oldest first. Does
    /// not wait for the GPU unless `wait` is set; then it returns all finished frames. Of frames that are not
    /// taken, the latest `kept_frames` are kept.
    [[nodiscard]] std::vector<FrameReport> take_frames(bool wait = false);
    static constexpr std::size_t kept_frames = 1024;

    /// Reads counts and sums of the last frame back; waits for the GPU. Call it after a frame was rendered
    /// with the current configuration; before the first frame it throws GraphError.
    [[nodiscard]] Report report();

    /// The frame graph of the current configuration: passes, resources and barriers.
    [[nodiscard]] std::string describe(GraphFormat format) const;

    /// Quality of the last frame. `scale` is below 1 only to keep the frame within its budget; `interleave`
    /// is the factor n that was used.
    [[nodiscard]] Quality quality() const { return {quality_.scale, frame_.interleave}; }

    /// All passes of the last frame, with whether each ran. Empty between a change of the configuration and
    /// the next frame.
    [[nodiscard]] const std::vector<PassRecord>& last_passes() const { return last_passes_; }

    /// For limits, debug messages and object counts of the GL context. Lives as long as the renderer.
    [[nodiscard]] gl::Device& device() { return gpu_.device(); }

 private:
    using Clock = std::chrono::steady_clock;
    /// A finished frame whose GPU times have not arrived yet.
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
    Tick last_revision_ = 0;  // the world's, in the last frame
    Clock::time_point last_move_;
    FrameHandles frame_;
    std::uint64_t epoch_ = 0;  // incremented by `invalidate`: cached scene data is void
    RefinementClock refinement_clock_;
    bool refine_ = false;           // whether the next frame adds another sample to the mean
    const World* world_ = nullptr;  // world of the last frame; null if it threw or after `invalidate`
    std::vector<PassRecord> last_passes_;
    std::uint64_t next_frame_ = 0;
    std::deque<PendingFrame> pending_;
    std::deque<FrameReport> arrived_;  // complete, but not yet taken
};

}  // namespace candela
