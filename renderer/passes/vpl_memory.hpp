#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

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

/// Index in the memory of each planned path, `no_path` for those that it does not have: paths are known by
/// their light's entity and their index in its sequence.
[[nodiscard]] std::vector<std::uint32_t> match_paths(const VplPaths& plan, const LightTable& lights,
                                                     const VplMemory& memory);
inline constexpr std::uint32_t no_path = 0xffffffffU;

/// Of each light of the table, whether it sends its paths out differently from what the memory has of it: it
/// has moved, turned or changed its shape; false for new ones.
[[nodiscard]] std::vector<std::uint8_t> moved_lights(const LightTable& lights, const VplMemory& memory);

/// The paths of one light, which plans and schedules have in a row.
struct LightPaths {
    gpu::LightKind kind;
    std::uint32_t first;
    std::uint32_t last;  ///< one behind
};

/// Of each light that has paths, in order.
[[nodiscard]] std::vector<LightPaths> paths_by_light(const std::vector<gpu::Path>& paths,
                                                     const LightTable& lights);

/// Most bounces that the plan has for any path of the light.
[[nodiscard]] std::uint32_t longest_path(const std::vector<gpu::Path>& paths, const LightPaths& light);

/// Indices of those paths of the light for which `predicate(i)` holds.
template <class Predicate>
[[nodiscard]] std::vector<std::uint32_t> paths_of(const LightPaths& light, Predicate predicate) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = light.first; i < light.last; ++i) {
        if (predicate(i)) {
            found.push_back(i);
        }
    }
    return found;
}

/// Where paths start, or by their points of the sequence would, on the unit sphere: `to_emission_domain`.
[[nodiscard]] std::vector<glm::dvec3> starts_on_sphere(const VplMemory& memory, gpu::LightKind kind,
                                                       const std::vector<std::uint32_t>& paths,
                                                       glm::vec2 PathMemory::*start = &PathMemory::start);

}  // namespace candela
