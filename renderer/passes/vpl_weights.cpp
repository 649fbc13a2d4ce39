#include "renderer/passes/vpl_weights.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderer/passes/emission_cells.hpp"

namespace candela {
namespace {

/// Place of a bounce of a path.
std::uint32_t place_of(const VplMemory& schedule, std::uint32_t path, std::uint32_t bounce) {
    return schedule.paths.paths[path].first_vpl + bounce;
}

float& weight(VplMemory& schedule, std::uint32_t path, std::uint32_t bounce) {
    return schedule.paths.places[place_of(schedule, path, bounce)].weight;
}

/// Cells of the points of the sequence of those paths that the plan takes to a bounce; kept once worked out.
std::vector<double> plan_areas(VplMemory& schedule, const std::vector<std::uint32_t>& planned,
                               std::uint32_t bounce, const std::vector<glm::dvec3>& points,
                               EmissionDomain domain) {
    std::vector<double> areas;
    areas.reserve(planned.size());
    for (const std::uint32_t i : planned) {
        areas.push_back(schedule.plan_areas[place_of(schedule, i, bounce)]);
    }
    if (areas.front() == 0.0) {
        areas = emission_cells(points, domain).areas;
        for (std::size_t k = 0; k < planned.size(); ++k) {
            schedule.plan_areas[place_of(schedule, planned[k], bounce)] = areas[k];
        }
    }
    return areas;
}

/// By how much the plan's weight, which all of these paths share, departs from their cells' in the diagram of
/// their points of the sequence; the less, the farther a path starts from there, and not at all from the mean
/// distance between paths on. So a light's first small move does not show as a change from the plan's weights
/// to the cells', nor does its last.
std::vector<double> departures(VplMemory& schedule, gpu::LightKind kind,
                               const std::vector<std::uint32_t>& planned, std::uint32_t bounce) {
    const EmissionDomain domain = emission_domain(kind);
    const auto points = starts_on_sphere(schedule, kind, planned, &PathMemory::canonical_start);
    const auto starts = starts_on_sphere(schedule, kind, planned);
    const std::vector<double> areas = plan_areas(schedule, planned, bounce, points, domain);
    const double cell = area_of(domain) / static_cast<double>(planned.size());
    std::vector<double> factors;
    factors.reserve(planned.size());
    for (std::size_t k = 0; k < planned.size(); ++k) {
        const double nearness = std::max(0.0, 1.0 - glm::distance(points[k], starts[k]) / std::sqrt(cell));
        factors.push_back(areas[k] > 0.0 ? glm::mix(1.0, cell / areas[k], nearness) : 1.0);
    }
    return factors;
}

void weigh(VplMemory& schedule, const LightPaths& light, std::uint32_t bounce) {
    const std::vector<gpu::Path>& paths = schedule.paths.paths;
    const auto planned = paths_of(light, [&](std::uint32_t i) { return paths[i].vpl_count > bounce; });
    const auto there = paths_of(light, [&](std::uint32_t i) { return paths[i].bounces > bounce; });
    const std::vector<double> factors = departures(schedule, light.kind, planned, bounce);
    std::vector<double> shares =
        emission_cells(starts_on_sphere(schedule, light.kind, there), emission_domain(light.kind)).areas;
    double of_all = 0.0;
    for (std::size_t k = 0; k < there.size(); ++k) {
        const auto in_plan = std::ranges::lower_bound(planned, there[k]) - planned.begin();
        shares[k] *= factors[static_cast<std::size_t>(in_plan)];
        of_all += shares[k];
    }
    double sum = 0.0;
    for (const std::uint32_t i : planned) {
        sum += static_cast<double>(weight(schedule, i, bounce));
    }
    for (std::size_t k = 0; k < there.size(); ++k) {
        weight(schedule, there[k], bounce) = static_cast<float>(sum * shares[k] / of_all);
    }
}

}  // namespace

void weigh_by_cells(VplMemory& schedule, const LightTable& lights) {
    const std::vector<gpu::Path>& paths = schedule.paths.paths;
    const auto departed = [&](std::uint32_t i) {
        return !schedule.memories[i].canonical || paths[i].bounces < paths[i].vpl_count;
    };
    for (const LightPaths& light : paths_by_light(paths, lights)) {
        if (paths_of(light, departed).empty()) {
            continue;
        }
        for (std::uint32_t bounce = 0; bounce < longest_path(paths, light); ++bounce) {
            weigh(schedule, light, bounce);
        }
    }
}

}  // namespace candela
