#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/bvh/box.hpp"
#include "renderer/passes/vpl_memory.hpp"

namespace candela {

/// A VPL as it was recorded, by tile.
struct RecordedVpl {
    glm::vec3 position;
    glm::vec3 normal;
    float throughput;  ///< mean of the channels; 0 where there is no VPL
};

/// What has become of a planned path that the memory has, too.
struct CheckedLength {
    std::uint32_t bounces = 0;  ///< leading bounces that still hold
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
/// Maps of VPLs that are traced are drawn with them; in what is left of the budget those follow that may show
/// geometry which moved, those first whose VPLs' flux times their age is largest.
///
/// What paths carry is shared out by `weigh_by_cells`.
[[nodiscard]] VplMemory schedule(const VplPaths& plan, const LightTable& lights, const VplMemory& memory,
                                 const VplChecks& checks, const ScheduleSettings& settings);

}  // namespace candela
