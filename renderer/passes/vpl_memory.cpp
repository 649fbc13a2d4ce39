#include "renderer/passes/vpl_memory.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "renderer/passes/emission_cells.hpp"

namespace candela {
namespace {

using LightKey = std::tuple<Entity, gpu::LightKind>;

bool emits_differently(const gpu::Light& a, const gpu::Light& b) {
    return a.kind != b.kind || a.position != b.position || a.direction != b.direction || a.shape != b.shape ||
           a.cos_inner != b.cos_inner || a.cos_outer != b.cos_outer;
}

}  // namespace

std::vector<std::uint32_t> match_paths(const VplPaths& plan, const LightTable& lights,
                                       const VplMemory& memory) {
    std::map<std::tuple<LightKey, std::uint32_t>, std::uint32_t> known;
    for (std::uint32_t k = 0; k < memory.memories.size(); ++k) {
        const PathMemory& path = memory.memories[k];
        const gpu::LightKind kind = memory.lights[memory.paths.paths[k].light].light.kind;
        known.emplace(std::tuple(LightKey(path.light, kind), path.index), k);
    }
    std::vector<std::uint32_t> matches;
    matches.reserve(plan.paths.size());
    for (const gpu::Path& path : plan.paths) {
        const LightTable::Entry& light = lights.entries[path.light];
        const auto found = known.find(std::tuple(LightKey(light.entity, light.light.kind), path.index));
        matches.push_back(found == known.end() ? no_path : found->second);
    }
    return matches;
}

std::vector<std::uint8_t> moved_lights(const LightTable& lights, const VplMemory& memory) {
    std::map<LightKey, const gpu::Light*> before;
    for (const LightTable::Entry& entry : memory.lights) {
        before.emplace(LightKey(entry.entity, entry.light.kind), &entry.light);
    }
    std::vector<std::uint8_t> moved;
    moved.reserve(lights.entries.size());
    for (const LightTable::Entry& entry : lights.entries) {
        const auto found = before.find(LightKey(entry.entity, entry.light.kind));
        moved.push_back(found != before.end() && emits_differently(entry.light, *found->second) ? 1 : 0);
    }
    return moved;
}

std::vector<LightPaths> paths_by_light(const std::vector<gpu::Path>& paths, const LightTable& lights) {
    std::vector<LightPaths> found;
    for (std::uint32_t i = 0; i < paths.size(); ++i) {
        if (i == 0 || paths[i].light != paths[i - 1].light) {
            found.push_back({lights.entries[paths[i].light].light.kind, i, i});
        }
        found.back().last = i + 1;
    }
    return found;
}

std::uint32_t longest_path(const std::vector<gpu::Path>& paths, const LightPaths& light) {
    std::uint32_t bounces = 0;
    for (std::uint32_t i = light.first; i < light.last; ++i) {
        bounces = std::max(bounces, paths[i].vpl_count);
    }
    return bounces;
}

std::vector<glm::dvec3> starts_on_sphere(const VplMemory& memory, gpu::LightKind kind,
                                         const std::vector<std::uint32_t>& paths,
                                         glm::vec2 PathMemory::*start) {
    std::vector<glm::dvec3> points;
    points.reserve(paths.size());
    for (const std::uint32_t i : paths) {
        points.push_back(to_emission_domain(kind, memory.memories[i].*start));
    }
    return points;
}

}  // namespace candela
