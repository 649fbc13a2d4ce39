#include "renderer/passes/surfels/surfel_placement.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "renderer/passes/view/r2_sequence.hpp"

namespace candela {
namespace {

/// One side of a triangle.
struct Side {
    const gpu::TraceTriangle* triangle;
    glm::vec3 normal;  // unit
    std::uint32_t item;
    bool back;
};

/// A point of a cell, with the item and the triangle that it lies on.
struct PlacedPoint : gpu::CellPoint {
    std::uint32_t item = 0;
    SurfacePoint place;
};

/// Sides of triangles: both of double-sided ones.
struct Sides {
    std::vector<Side> sides;
    std::vector<double> area_before;  // by side: area of all sides before it, m²; then the total
};

/// The sides of the triangles that emit light, or of those that do not.
Sides sides_of(const SceneTriangles& scene, bool emitting) {
    Sides all;
    double area = 0.0;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const gpu::TraceTriangle& triangle = scene.triangles[i];
        if (scene.emits[triangle.material] != emitting) continue;
        const glm::vec3 cross = glm::cross(triangle.edge_ab, triangle.edge_ac);
        const float twice_area = glm::length(cross);
        if (!(twice_area > 0.0F)) continue;
        const glm::vec3 front = cross / twice_area;
        for (int side = 0; side < (scene.double_sided[triangle.material] ? 2 : 1); ++side) {
            all.sides.push_back({&triangle, side == 0 ? front : -front, scene.item_of[i], side == 1});
            all.area_before.push_back(area);
            area += 0.5 * static_cast<double>(twice_area);
        }
    }
    all.area_before.push_back(area);
    return all;
}

std::uint32_t hash(std::uint32_t x) {
    x ^= x >> 16U;
    x *= 0x85ebca6bU;
    x ^= x >> 13U;
    x *= 0xc2b2ae35U;
    return x ^ (x >> 16U);
}

/// Barycentric weights of b and c of point `index` in a triangle: the R2 sequence, with the upper half of the
/// unit square folded onto the lower.
glm::vec2 point_in_triangle(std::uint32_t index, std::uint32_t seed) {
    constexpr double unit = 1.0 / 4294967296.0;
    const glm::dvec2 start(hash(seed) * unit, hash(seed ^ 0x9e3779b9U) * unit);
    glm::dvec2 point = r2_point(index, start);
    if (point.x + point.y > 1.0) point = 1.0 - point;
    return glm::vec2(point);
}

/// Interpolated between the corners, in sRGB: gpu::CellPoint::colour.
std::uint32_t colour_at(const gpu::TraceTriangle& triangle, glm::vec2 b) {
    if ((triangle.colour_a & triangle.colour_b & triangle.colour_c) == 0xffffffffU) return 0xffffffffU;
    return glm::packUnorm4x8((1.0F - b.x - b.y) * glm::unpackUnorm4x8(triangle.colour_a) +
                             b.x * glm::unpackUnorm4x8(triangle.colour_b) +
                             b.y * glm::unpackUnorm4x8(triangle.colour_c));
}

/// `count` points, distributed evenly by area.
std::vector<PlacedPoint> spread_points(const Sides& all, std::uint32_t count, std::uint32_t seed) {
    std::vector<PlacedPoint> points;
    const double share = all.area_before.back() / count;
    const double start = hash(seed + 1) * (1.0 / 4294967296.0);
    std::size_t side = 0;
    std::uint32_t index = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double at = (i + start) * share;
        while (side + 1 < all.sides.size() && at >= all.area_before[side + 1]) {
            ++side;
            index = 0;
        }
        const auto side_seed = static_cast<std::uint32_t>(side) * 0x85ebca6bU + seed;
        const glm::vec2 b = point_in_triangle(index++, side_seed);
        const gpu::TraceTriangle& t = *all.sides[side].triangle;
        points.push_back({{.position = t.a + b.x * t.edge_ab + b.y * t.edge_ac,
                           .material = t.material,
                           .normal = all.sides[side].normal,
                           .area = static_cast<float>(share),
                           .uv = t.uv_a + b.x * (t.uv_b - t.uv_a) + b.y * (t.uv_c - t.uv_a),
                           .surfel = 0,
                           .colour = colour_at(t, b)},
                          all.sides[side].item,
                          {t.id & ~TRIANGLE_MASKED, b, all.sides[side].back}});
    }
    return points;
}

/// A hash grid of surfels, for finding nearby ones.
class SurfelGrid {
 public:
    explicit SurfelGrid(float cell) : cell_(cell) {}

    void add(const PlacedPoint& surfel) {
        cells_[key(coordinates(surfel.position), surfel.item)].push_back(
            static_cast<std::uint32_t>(surfels_.size()));
        surfels_.push_back(surfel);
    }

    [[nodiscard]] const std::vector<PlacedPoint>& surfels() const { return surfels_; }

    /// Index of the nearest surfel on the surface of `point`, within about the size of a grid cell; -1: none.
    /// The surfel must be on the same item, the cosine between the normals at least `least_cosine`, and the
    /// distance of the point from the surfel's plane at most `off_plane` grid cells.
    [[nodiscard]] int nearest_like(const PlacedPoint& point, float least_cosine, float off_plane) const {
        const glm::ivec3 centre = coordinates(point.position);
        float best = std::numeric_limits<float>::infinity();
        int found = -1;
        for (int i = 0; i < 27; ++i) {
            const auto cell = cells_.find(key(centre + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1, point.item));
            if (cell == cells_.end()) continue;
            for (const std::uint32_t candidate : cell->second) {
                const PlacedPoint& surfel = surfels_[candidate];
                const glm::vec3 apart = point.position - surfel.position;
                const float distance2 = glm::dot(apart, apart);
                if (distance2 < best && surfel.item == point.item &&
                    glm::dot(point.normal, surfel.normal) >= least_cosine &&
                    std::abs(glm::dot(apart, surfel.normal)) <= off_plane * cell_) {
                    best = distance2;
                    found = static_cast<int>(candidate);
                }
            }
        }
        return found;
    }

 private:
    [[nodiscard]] glm::ivec3 coordinates(glm::vec3 position) const {
        return glm::ivec3(glm::floor(position / cell_));
    }
    /// Different cells may have the same key: callers check what they find.
    static std::uint64_t key(glm::ivec3 at, std::uint32_t item) {
        const auto part = [](int x) { return static_cast<std::uint64_t>(x) & 0xffffU; };
        return part(at.x) | part(at.y) << 16U | part(at.z) << 32U | std::uint64_t{item} << 48U;
    }

    float cell_;
    std::vector<PlacedPoint> surfels_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

/// Assigns each point to a surfel. A point without a matching surfel becomes a surfel.
std::vector<std::uint32_t> assign(SurfelGrid& grid, const std::vector<PlacedPoint>& points) {
    std::vector<std::uint32_t> owners;
    owners.reserve(points.size());
    for (const PlacedPoint& point : points) {
        int owner = grid.nearest_like(point, 0.9F, 0.1F);
        if (owner < 0) owner = grid.nearest_like(point, 0.5F, 0.5F);
        if (owner < 0) {
            owner = static_cast<int>(grid.surfels().size());
            grid.add(point);
        }
        owners.push_back(static_cast<std::uint32_t>(owner));
    }
    return owners;
}

/// The point of each cell that is nearest to its centroid: one step of Lloyd relaxation, which distributes
/// the surfels more evenly (Lloyd, "Least squares quantization in PCM", 1982).
std::vector<PlacedPoint> middles(const std::vector<PlacedPoint>& points,
                                 const std::vector<std::uint32_t>& owners,
                                 const std::vector<PlacedPoint>& surfels) {
    std::vector<glm::vec4> sums(surfels.size(), glm::vec4(0.0F));
    for (std::size_t i = 0; i < points.size(); ++i) {
        sums[owners[i]] += glm::vec4(points[i].position, 1.0F);
    }
    std::vector<PlacedPoint> chosen = surfels;
    std::vector<float> best(surfels.size(), std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec4& sum = sums[owners[i]];
        const glm::vec3 off = points[i].position - glm::vec3(sum) / sum.w;
        if (glm::dot(off, off) < best[owners[i]]) {
            best[owners[i]] = glm::dot(off, off);
            chosen[owners[i]] = points[i];
        }
    }
    return chosen;
}

SurfelGrid grid_of(const std::vector<PlacedPoint>& surfels, float cell) {
    SurfelGrid grid(cell);
    for (const PlacedPoint& surfel : surfels) {
        grid.add(surfel);
    }
    return grid;
}

/// Sorts the points by cell. Surfels without points are left out.
SurfelSet collect(const SurfelGrid& grid, const std::vector<PlacedPoint>& points,
                  const std::vector<std::uint32_t>& owners) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return owners[i]; });
    SurfelSet set;
    std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
    for (const std::uint32_t i : order) {
        if (owners[i] != last) {
            last = owners[i];
            const PlacedPoint& surfel = grid.surfels()[last];
            set.item_of.push_back(surfel.item);
            set.surfel_places.push_back(surfel.place);
            set.surfels.push_back({.position = surfel.position,
                                   .first_point = static_cast<std::uint32_t>(set.points.size()),
                                   .normal = surfel.normal,
                                   .point_count = 0,
                                   .area = 0.0F,
                                   .radius2 = 0.0F});
        }
        gpu::Surfel& surfel = set.surfels.back();
        ++surfel.point_count;
        surfel.area += points[i].area;
        surfel.radius2 = surfel.area / std::numbers::pi_v<float>;
        set.points.push_back(points[i]);
        set.point_places.push_back(points[i].place);
        set.points.back().surfel = static_cast<std::uint32_t>(set.surfels.size() - 1);
    }
    return set;
}

SurfelSet spread_surfels(const Sides& all, std::uint32_t count, std::uint32_t points_a_surfel,
                         std::uint32_t seed) {
    constexpr int rounds = 2;
    const auto spacing = static_cast<float>(std::sqrt(all.area_before.back() / count));
    const std::vector<PlacedPoint> points = spread_points(all, points_a_surfel * count, hash(seed));
    SurfelGrid grid = grid_of(spread_points(all, count, hash(seed ^ 0x5bd1e995U)), spacing);
    std::vector<std::uint32_t> owners = assign(grid, points);
    for (int round = 0; round < rounds; ++round) {
        grid = grid_of(middles(points, owners, grid.surfels()), spacing);
        owners = assign(grid, points);
    }
    return collect(grid, points, owners);
}

/// About `count` surfels with `points_a_surfel` points each on average.
SurfelSet place_surfels(const Sides& all, std::uint32_t count, std::uint32_t points_a_surfel,
                        std::uint32_t seed) {
    if (all.sides.empty() || count == 0) return {};
    constexpr int attempts = 4;
    std::uint32_t wanted = count;
    SurfelSet set = spread_surfels(all, wanted, points_a_surfel, seed);
    for (int i = 1; i < attempts && set.surfels.size() > count; ++i) {
        wanted = static_cast<std::uint32_t>(std::uint64_t{wanted} * count / set.surfels.size());
        set = spread_surfels(all, std::max(wanted, 1U), points_a_surfel, seed);
    }
    return set;
}

/// Appends surfels that emit light.
void append_emitting(SurfelSet& set, const SurfelSet& more) {
    const auto surfels = static_cast<std::uint32_t>(set.surfels.size());
    const auto points = static_cast<std::uint32_t>(set.points.size());
    for (gpu::Surfel surfel : more.surfels) {
        surfel.first_point += points;
        set.surfels.push_back(surfel);
    }
    for (gpu::CellPoint point : more.points) {
        point.surfel += surfels;
        set.points.push_back(point);
    }
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(set.item_of, more.item_of);
    append(set.surfel_places, more.surfel_places);
    append(set.point_places, more.point_places);
    set.emitting_count = static_cast<std::uint32_t>(more.surfels.size());
}

}  // namespace

SurfelSet place_surfels(const SceneTriangles& scene, const SurfelCounts& counts, std::uint32_t seed) {
    SurfelSet set = place_surfels(sides_of(scene, false), counts.reflecting, points_a_surfel, seed);
    append_emitting(set, place_surfels(sides_of(scene, true), counts.emitting, points_an_emitter, seed));
    return set;
}

}  // namespace candela
