#include "renderer/passes/surfels/surfel_groups.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace candela {
namespace {

/// Mean position and variance of cells, by area.
struct Spread {
    glm::vec3 mean{0.0F};   // metres
    float area = 0.0F;      // m²
    float variance = 0.0F;  // m², sum over the axes
};

Spread spread_of(std::span<const gpu::Surfel> surfels) {
    // From one of them, so that it is exact far from the origin.
    const glm::dvec3 origin(surfels.front().position);
    glm::dvec3 sum(0.0);
    double area = 0.0, sum2 = 0.0;
    for (const gpu::Surfel& surfel : surfels) {
        const auto weight = static_cast<double>(surfel.area);
        const glm::dvec3 off = glm::dvec3(surfel.position) - origin;
        area += weight;
        sum += weight * off;
        // The variance of a square's positions is a sixth of its area.
        sum2 += weight * (glm::dot(off, off) + static_cast<double>(surfel.width2) / 6.0);
    }
    if (!(area > 0.0)) return {.mean = surfels.front().position, .area = 0.0F, .variance = 0.0F};
    const glm::dvec3 mean = sum / area;
    return {.mean = glm::vec3(origin + mean),
            .area = static_cast<float>(area),
            .variance = static_cast<float>(std::max(sum2 / area - glm::dot(mean, mean), 0.0))};
}

const gpu::Surfel& nearest(std::span<const gpu::Surfel> surfels, const glm::vec3& place) {
    const gpu::Surfel* found = &surfels.front();
    for (const gpu::Surfel& surfel : surfels) {
        const float least = glm::distance(found->position, place);
        if (glm::distance(surfel.position, place) < distinctly * least) found = &surfel;
    }
    return *found;
}

void append_branch(SurfelSet& branches, const SurfelSet& set, std::size_t first, std::size_t count) {
    const auto surfels = std::span(set.surfels).subspan(first, count);
    const Spread spread = spread_of(surfels);
    const gpu::Surfel& middle = nearest(surfels, spread.mean);
    branches.surfels.push_back({.position = middle.position,
                                .first_point = static_cast<std::uint32_t>(branches.points.size()),
                                .normal = middle.normal,
                                .point_count = static_cast<std::uint32_t>(count),
                                .area = spread.area,
                                .width2 = std::max(spread.area, 6.0F * spread.variance)});
    for (const gpu::Surfel& surfel : surfels) {
        gpu::CellPoint point{};
        point.position = surfel.position;
        point.normal = surfel.normal;
        point.area = surfel.area;
        point.surfel = static_cast<std::uint32_t>(branches.surfels.size() - 1);
        branches.points.push_back(point);
    }
    branches.ids.push_back(0);
    branches.item_of.push_back(set.item_of[first]);
}

void append_surfel(SurfelSet& to, const SurfelSet& set, std::size_t i) {
    gpu::Surfel surfel = set.surfels[i];
    const auto first = set.points.begin() + surfel.first_point;
    surfel.first_point = static_cast<std::uint32_t>(to.points.size());
    to.points.insert(to.points.end(), first, first + surfel.point_count);
    const auto index = static_cast<std::uint32_t>(to.surfels.size());
    for (std::size_t p = surfel.first_point; p < to.points.size(); ++p) to.points[p].surfel = index;
    to.surfels.push_back(surfel);
    to.ids.push_back(set.ids[i]);
    to.patches.push_back(set.patches[i]);
    to.item_of.push_back(set.item_of[i]);
    to.branches.push_back(set.branches[i]);
    to.surfel_places.push_back(set.surfel_places[i]);
    const auto place = set.point_places.begin() + set.surfels[i].first_point;
    to.point_places.insert(to.point_places.end(), place, place + surfel.point_count);
}

/// A group of the last surfels of the set, from `first` on. Sets all but its width.
gpu::SurfelGroup group_from(const SurfelSet& set, std::uint32_t first, std::uint32_t middle) {
    const gpu::Surfel& from = set.surfels[middle];
    gpu::SurfelGroup group{.first = first,
                           .count = static_cast<std::uint32_t>(set.surfels.size()) - first,
                           .middle = middle,
                           .width2 = 0.0F,
                           .reach = 0.0F,
                           .thickness = 0.0F};
    for (std::size_t p = set.surfels[first].first_point; p < set.points.size(); ++p) {
        const glm::vec3 off = set.points[p].position - from.position;
        group.reach = std::max(group.reach, glm::length(off));
        group.thickness = std::max(group.thickness, std::abs(glm::dot(off, from.normal)));
    }
    return group;
}

/// Appends the surfels of a part of a branch, as one group. A branch's points are the surfels of the set.
void append_part(GroupedSurfels& to, const SurfelSet& set, const gpu::Surfel& branch,
                 const CellDivision& division, std::uint8_t part) {
    const auto first = static_cast<std::uint32_t>(to.set.surfels.size());
    float area = 0.0F;
    for (std::uint32_t i = 0; i < branch.point_count; ++i) {
        if (division.part_of[i] != part) continue;
        append_surfel(to.set, set, branch.first_point + i);
        area += to.set.surfels.back().area;
    }
    const auto surfels = std::span(to.set.surfels).subspan(first);
    if (surfels.empty()) return;
    const glm::vec3 from =
        part == 0 ? branch.position : set.surfels[branch.first_point + division.middles[part]].position;
    const auto middle = static_cast<std::uint32_t>(&nearest(surfels, from) - to.set.surfels.data());
    to.groups.push_back(group_from(to.set, first, middle));
    to.groups.back().width2 = branch.area > 0.0F ? branch.width2 * area / branch.area : 0.0F;
}

/// Appends the surfels of a branch that are in no part.
void append_rest(GroupedSurfels& to, const SurfelSet& set, const gpu::Surfel& branch,
                 const CellDivision& division) {
    for (std::uint32_t i = 0; i < branch.point_count; ++i) {
        if (division.part_of[i] != most_cell_parts) continue;
        const auto index = static_cast<std::uint32_t>(to.set.surfels.size());
        append_surfel(to.set, set, branch.first_point + i);
        to.groups.push_back(group_from(to.set, index, index));
        to.groups.back().width2 = to.set.surfels.back().width2;
    }
}

}  // namespace

SurfelSet branches_of(const SurfelSet& set) {
    SurfelSet branches;
    const std::size_t count = set.surfels.size() - set.emitting_count;
    for (std::size_t first = 0, next = 0; first < count; first = next) {
        while (next < count && set.branches[next] == set.branches[first]) ++next;
        append_branch(branches, set, first, next - first);
    }
    return branches;
}

GroupedSurfels grouped(const SurfelSet& set, const SurfelSet& branches, std::span<const CellDivision> parts) {
    GroupedSurfels to;
    to.set.surfels.reserve(set.surfels.size());
    to.set.points.reserve(set.points.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (std::uint8_t part = 0; part < most_cell_parts; ++part) {
            append_part(to, set, branches.surfels[i], parts[i], part);
        }
        append_rest(to, set, branches.surfels[i], parts[i]);
    }
    for (std::size_t i = to.set.surfels.size(); i < set.surfels.size(); ++i) append_surfel(to.set, set, i);
    to.set.emitting_count = set.emitting_count;
    return to;
}

}  // namespace candela
