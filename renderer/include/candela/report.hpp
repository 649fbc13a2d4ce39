#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/graph/records.hpp>
#include <candela/workload.hpp>

namespace candela {

/// CPU and GPU time of one pass in one frame, in milliseconds; 0 if the pass had nothing to do.
struct PassReport {
    std::string name;
    bool ran = false;
    double cpu_ms = 0.0;
    double gpu_ms = 0.0;
    Workload workload = Workload::other;
};

/// Times of one frame, in milliseconds. `index` counts the frames of a renderer from 0; `passes` are in graph
/// order.
struct FrameReport {
    std::uint64_t index = 0;
    double cpu_ms = 0.0;
    double gpu_ms = 0.0;
    std::uint32_t waiting_surfels = 0;  ///< VplReport::waiting after the frame
    std::vector<PassReport> passes;
};

/// Flux balance of the indirect light, per colour channel, in the lights' unit of flux (lumens if intensities
/// are in candelas): emitted = absorbed + escaped + truncated + roulette. With surfels, `emitted` counts only
/// the light that reaches surfaces, and the balance holds to within the error caused by the spacing of the
/// surfels.
struct EnergyAccount {
    glm::dvec3 emitted{0.0};   ///< sent out by the real lights
    glm::dvec3 absorbed{0.0};  ///< by surfaces
    glm::dvec3 escaped{0.0};   ///< left the scene, or was cut off by a light's range
    /// Reflected at the last bounce and not followed further. With surfels, below 0 if they have extrapolated
    /// to a little too much.
    glm::dvec3 truncated{0.0};
    /// Lost where Russian roulette ended paths, minus what the weights of the other paths added. 0 with
    /// surfels.
    glm::dvec3 roulette{0.0};
    glm::dvec3 roulette_error{0.0};  ///< standard error of `roulette`, whose expected value is 0
};

/// Counts of the VPLs and of the work done for them.
struct VplReport {
    std::uint32_t requested = 0;  ///< VplSettings::count; those on emitting surfaces come in addition
    std::uint32_t alive = 0;      ///< VPLs with a flux above zero
    std::uint32_t paths = 0;      ///< light paths; 0 with surfels
    std::uint32_t rays = 0;       ///< path segments, including those that hit nothing; 0 with surfels
    /// Surfels whose shadows are out of date, or in whose place there should be others, which follows in the
    /// next frames: VplSettings::updates
    std::uint32_t waiting = 0;
    std::uint32_t interleave = 1;  ///< n: a pixel evaluates one in n² VPLs
    /// Pixels that evaluated additional VPLs, because too few neighbours lie on the same surface.
    std::uint32_t filled_pixels = 0;
    EnergyAccount flux;
    /// Estimate of the relMSE of the VPLs' light in the view, with its visibility but without interleaving
    /// and refinement; none unless RenderView::estimate_error asked for it. From the difference to another
    /// set of as many VPLs: shaders/README.md, "Error of a set of VPLs". 0.01 is an error of a tenth.
    std::optional<double> estimated_error{};
};

/// Counts of the real lights. Lights that emit nothing are not counted.
struct LightReport {
    std::uint32_t count = 0;
    std::uint32_t with_map = 0;      ///< lights that have a shadow map
    std::uint32_t shadow_views = 0;  ///< drawn in the last run of `shadow-maps`: 6 per cube, 1 per flat map
    /// Lights whose shadows take a ray everywhere, because ShadowSettings::budget_mib or the number of layers
    /// leaves no room for a map, or a directional one's would show more than 2²⁴ triangles.
    std::uint32_t without_map = 0;
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

/// How far rendering is reduced to keep a frame within its time budget.
struct Quality {
    float scale = 1.0F;            ///< rendered size / target size along each axis; then scaled up
    std::uint32_t interleave = 1;  ///< least interleave factor n: see Interleave
    bool operator==(const Quality&) const = default;
};

}  // namespace candela
