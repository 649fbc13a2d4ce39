#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/bvh/box.hpp"
#include "renderer/passes/lights.hpp"
#include "renderer/passes/vpl_paths.hpp"

namespace candela {

/// What is remembered of a scheduled path, beside its records on the GPU.
struct PathMemory {
    Entity light;
    std::uint32_t index = 0;  ///< within the light's sequence
    /// Traced from its point of the sequence, from its light as it still is, in geometry that is still there:
    /// full regeneration would give the same.
    bool canonical = false;
    bool located = false;             ///< whether the next two are known
    glm::vec2 start{0.0F};            ///< on the light, in the unit square: shaders/emission.glsl
    glm::vec2 canonical_start{0.0F};  ///< its point of the sequence
    bool operator==(const PathMemory&) const = default;
};

/// A depth map that shows geometry which has since moved.
struct StaleMap {
    std::uint32_t age = 0;    ///< schedules since then; 0: the map is up to date
    float throughput = 0.0F;  ///< of its VPL, mean of the channels
    bool operator==(const StaleMap&) const = default;
};

/// A schedule and what the next one builds on.
struct VplMemory {
    VplPaths paths;
    std::vector<PathMemory> memories;  ///< of each path
    std::vector<StaleMap> maps;        ///< of each tile
    std::vector<LightTable::Entry> lights;
    /// Of each place: the cell of its path's point of the sequence among those that get as far, sr; 0: not
    /// yet worked out.
    std::vector<double> plan_areas;
    bool operator==(const VplMemory&) const = default;
};

/// A VPL as it was recorded, by tile.
struct RecordedVpl {
    glm::vec3 position;
    glm::vec3 normal;
    float throughput;  ///< mean of the channels; 0 where there is no VPL
};

/// What has become of a planned path that the memory has, too.
struct CheckedLength {
    std::uint32_t length = 0;  ///< leading bounces that still hold
    glm::vec2 start{0.0F};
    glm::vec2 canonical_start{0.0F};
};

/// What was found out about the memory in this frame.
struct VplChecks {
    std::vector<CheckedLength>
        paths;               ///< of each planned path; empty: nothing that they depend on has changed
    std::vector<Box> moved;  ///< boxes, in world space, in which geometry changed
    std::vector<RecordedVpl> records;  ///< by tile; needed where something moved and there are maps
};

struct ScheduleSettings {
    std::uint32_t budget = 8;  ///< VPLs, and as many maps, at least 1
    std::uint32_t tiles = 0;   ///< at least as many as any plan has VPLs
    bool maps = false;         ///< whether VPLs have depth maps
};

/// Index in the memory of each planned path, `no_path` for those that it does not have: paths are known by
/// their light's entity and their index in its sequence.
[[nodiscard]] std::vector<std::uint32_t> match_paths(const VplPaths& plan, const LightTable& lights,
                                                     const VplMemory& memory);
inline constexpr std::uint32_t no_path = 0xffffffffU;

/// Whether two states of a light send their paths out differently: it has moved, turned or changed its shape.
[[nodiscard]] bool emits_differently(const gpu::Light& a, const gpu::Light& b);

/// Of each light of the table, whether it emits differently from what the memory has of it; false for new
/// ones.
[[nodiscard]] std::vector<std::uint8_t> moved_lights(const LightTable& lights, const VplMemory& memory);

/// A memory in which all is to be done: the plan as it is, which regenerates everything.
[[nodiscard]] VplMemory schedule_all(const VplPaths& plan, const LightTable& lights,
                                     const ScheduleSettings& settings);

/// What to trace and draw in this frame, of what the plan asks for: Laine et al., "Incremental Instant
/// Radiosity for Real-Time Indirect Illumination" (EGSR 2007), section 4.
///
/// Bounces that no longer hold are dropped at once, with all that follow them; so are paths that the plan no
/// longer has. Up to `budget` bounces are traced: first those that are missing, paths without any before
/// others. A path is never split: one that alone is longer than the budget is traced in a frame of its own.
/// A new path of a light that moves starts where its light's paths are sparsest, else at its point of the
/// sequence. What is left of the budget goes, for lights that stand still, into bringing further paths to
/// their points of the sequence, so that at rest the state becomes that of full regeneration; for lights that
/// move, into moving paths from where they are much too dense.
///
/// A light whose paths are all canonical has the plan's weights. Otherwise a path carries the flux of its
/// cell in the Voronoi diagram of starts on the light; bounces further on that of the diagram of those paths
/// that get there, and the sum at each bounce is the plan's. Paths that have hardly departed from their
/// points of the sequence carry as much more or less than that as they do there.
///
/// Maps of VPLs that are traced are drawn with them; in what is left of the budget those follow that may show
/// geometry which moved, those first whose VPLs' flux times their age is largest.
[[nodiscard]] VplMemory schedule(const VplPaths& plan, const LightTable& lights, const VplMemory& memory,
                                 const VplChecks& checks, const ScheduleSettings& settings);

}  // namespace candela
