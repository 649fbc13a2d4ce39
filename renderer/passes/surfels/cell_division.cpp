#include "renderer/passes/surfels/cell_division.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

namespace candela {
namespace {

constexpr float least_cosine = 0.7F;

/// A surfel or a point, and where rays to it end.
struct Seat {
    glm::vec3 position;
    glm::vec3 normal;  // unit
    glm::vec3 above;
};

/// Rays of a cell are so high above its surface, metres.
float lift_of(const gpu::Surfel& surfel) {
    return 0.25F * std::sqrt(surfel.area);
}

Seat seat_of(const glm::vec3& position, const glm::vec3& normal, float lift, const TracedScene& scene,
             float ray_offset) {
    const glm::vec3 start = position + ray_offset * normal;
    const auto hit = nearest_surface(scene, {start, normal, 0.0F, 2.0F * lift});
    return {position, normal, start + (hit ? 0.5F * hit->distance : lift) * normal};
}

/// 0.1 mm, in a scene that is large enough, and rounding.
LayerLimits layer_limits(float ray_offset) {
    return {.reach = std::clamp(1.1e-4F, ray_offset, 50.0F * ray_offset), .tie = 0.25F * ray_offset};
}

std::span<const gpu::CellPoint> points_of(const SurfelSet& set, std::size_t surfel) {
    return std::span(set.points).subspan(set.surfels[surfel].first_point, set.surfels[surfel].point_count);
}

bool sees(const Seat& from, const Seat& to, const TracedScene& scene) {
    return glm::dot(from.normal, to.normal) >= least_cosine && !is_blocked(scene, from.above, to.above);
}

/// The point nearest to the centroid of those that are in no part; none if they have no area.
std::optional<std::uint32_t> middle_of_rest(std::span<const gpu::CellPoint> points,
                                            const CellDivision& division) {
    const auto is_left = [&](std::size_t i) {
        return division.part_of[i] == most_cell_parts && points[i].area > 0.0F;
    };
    glm::vec3 sum(0.0F);
    float area = 0.0F;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!is_left(i)) continue;
        // From one of the points, so that it is exact far from the origin.
        sum += points[i].area * (points[i].position - points[0].position);
        area += points[i].area;
    }
    const glm::vec3 centroid = points[0].position + sum / area;
    std::optional<std::uint32_t> middle;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float distance = glm::distance(points[i].position, centroid);
        if (!is_left(i) || !(distance < distinctly * least)) continue;
        least = distance;
        middle = static_cast<std::uint32_t>(i);
    }
    return middle;
}

/// The division with points that are in no part because they face elsewhere than all parts.
CellDivision joined_by_normal(const SurfelSet& set, std::size_t cell, CellDivision division) {
    const gpu::Surfel& surfel = set.surfels[cell];
    const std::span<const gpu::CellPoint> points = points_of(set, cell);
    const std::vector<std::uint8_t> parts = division.part_of;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (parts[i] != most_cell_parts) continue;
        float best = -1.0F;
        for (std::uint8_t part = 0; part < most_cell_parts; ++part) {
            if (std::ranges::find(parts, part) == parts.end()) continue;
            const glm::vec3 normal = part == 0 ? surfel.normal : points[division.middles[part]].normal;
            const float cosine = glm::dot(normal, points[i].normal);
            if (!(cosine > best)) continue;
            best = cosine;
            division.part_of[i] = part;
        }
        if (best >= least_cosine) division.part_of[i] = most_cell_parts;
    }
    return division;
}

/// Appends a part of a cell, if it has points.
void append_part(SurfelSet& to, const SurfelSet& set, std::size_t cell, const CellDivision& division,
                 std::uint8_t part) {
    gpu::Surfel surfel = set.surfels[cell];
    const std::uint32_t first = surfel.first_point;
    SurfacePoint place = set.surfel_places[cell];
    if (part > 0) {
        const std::uint32_t middle = first + division.middles[part];
        surfel.position = set.points[middle].position;
        surfel.normal = set.points[middle].normal;
        place = set.point_places[middle];
    }
    surfel.position += division.lifts[part] * surfel.normal;
    surfel.first_point = static_cast<std::uint32_t>(to.points.size());
    surfel.area = 0.0F;
    for (std::size_t i = 0; i < division.part_of.size(); ++i) {
        if (division.part_of[i] != part) continue;
        to.points.push_back(set.points[first + i]);
        to.points.back().surfel = static_cast<std::uint32_t>(to.surfels.size());
        to.point_places.push_back(set.point_places[first + i]);
        surfel.area += to.points.back().area;
    }
    surfel.point_count = static_cast<std::uint32_t>(to.points.size()) - surfel.first_point;
    if (surfel.point_count == 0) return;
    surfel.width2 *= surfel.area / set.surfels[cell].area;
    surfel.seed += part;
    to.surfels.push_back(surfel);
    to.ids.push_back(combine_ids(set.ids[cell], part));
    to.patches.push_back(combine_ids(set.patches[cell], part));
    to.surfel_places.push_back(place);
    to.item_of.push_back(set.item_of[cell]);
}

}  // namespace

CellDivision divide_cell(const SurfelSet& set, std::size_t surfel, const TracedScene& scene,
                         std::span<const std::uint32_t> order, float ray_offset) {
    const gpu::Surfel& own = set.surfels[surfel];
    const std::span<const gpu::CellPoint> points = points_of(set, surfel);
    const float lift = lift_of(own);
    std::vector<Seat> seats;
    seats.reserve(points.size());
    for (const gpu::CellPoint& point : points) {
        seats.push_back(seat_of(point.position, point.normal, lift, scene, ray_offset));
    }
    const LayerLimits limits = layer_limits(ray_offset);
    const auto is_hidden = [&](const glm::vec3& position, const glm::vec3& normal,
                               const std::vector<SurfacePoint>& places, std::size_t i) {
        const SurfacePoint& place = places[i];
        return !order.empty() &&
               is_covered(scene, order, {position, normal, place.solid, place.triangle}, limits);
    };
    const bool is_whole = surfel >= set.surfels.size() - set.emitting_count && !divides_emitters(set);
    CellDivision division;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool hidden =
            is_hidden(points[i].position, points[i].normal, set.point_places, own.first_point + i);
        division.part_of.push_back(hidden ? covered_part : most_cell_parts);
    }
    Seat from = seat_of(own.position, own.normal, lift, scene, ray_offset);
    const bool own_hidden = is_hidden(own.position, own.normal, set.surfel_places, surfel);
    for (std::uint8_t part = own_hidden ? 1 : 0; part < most_cell_parts; ++part) {
        if (part > 0) {
            const auto middle = middle_of_rest(points, division);
            if (!middle) break;
            from = seats[*middle];
            division.middles[part] = *middle;
            division.part_of[*middle] = part;
        }
        for (std::size_t i = 0; i < seats.size(); ++i) {
            const bool is_left = division.part_of[i] == most_cell_parts;
            if (!is_left || !(is_whole || sees(from, seats[i], scene))) continue;
            division.part_of[i] = part;
            const float height = glm::dot(from.normal, seats[i].position - from.position);
            division.lifts[part] = std::max(division.lifts[part], height);
        }
        division.lifts[part] = std::min(division.lifts[part], glm::distance(from.position, from.above));
    }
    return division;
}

Box box_of_division(const SurfelSet& set, std::size_t surfel, float ray_offset) {
    const gpu::Surfel& own = set.surfels[surfel];
    const float reach = 2.0F * lift_of(own) + ray_offset;
    Box box;
    box.grow(own.position);
    box.grow(own.position + reach * own.normal);
    for (const gpu::CellPoint& point : points_of(set, surfel)) {
        box.grow(point.position);
        box.grow(point.position + reach * point.normal);
    }
    return box;
}

SurfelSet divided(const SurfelSet& set, std::span<const CellDivision> cells) {
    SurfelSet parts;
    parts.surfels.reserve(set.surfels.size());
    parts.points.reserve(set.points.size());
    const std::size_t first_emitting = set.surfels.size() - set.emitting_count;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const std::size_t before = parts.surfels.size();
        const bool emits = cell >= first_emitting;
        const CellDivision division = emits ? joined_by_normal(set, cell, cells[cell]) : cells[cell];
        for (std::uint8_t part = 0; part < most_cell_parts; ++part) {
            append_part(parts, set, cell, division, part);
        }
        const auto added = static_cast<std::uint32_t>(parts.surfels.size() - before);
        if (emits) parts.emitting_count += added;
    }
    return parts;
}

}  // namespace candela
