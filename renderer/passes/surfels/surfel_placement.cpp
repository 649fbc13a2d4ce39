#include "renderer/passes/surfels/surfel_placement.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <unordered_map>

#include "renderer/passes/view/r2_sequence.hpp"

namespace candela {
namespace {

/// One side of a triangle, or of a part of it.
struct Side {
    const gpu::TraceTriangle* triangle;
    glm::vec3 normal;  // unit
    std::uint32_t item;
    bool back;
    /// Barycentric weights of b and c of the triangle at the corners of the part.
    std::array<glm::vec2, 3> corners{glm::vec2(0.0F, 0.0F), glm::vec2(1.0F, 0.0F), glm::vec2(0.0F, 1.0F)};
    float density = 1.0F;  // of surfels: see density_at

    [[nodiscard]] glm::vec3 at(glm::vec2 weights) const {
        return triangle->a + weights.x * triangle->edge_ab + weights.y * triangle->edge_ac;
    }
};

/// A point of a cell, with the item and the triangle that it lies on.
struct PlacedPoint : gpu::CellPoint {
    std::uint32_t item = 0;
    SurfacePoint place;
    float density = 1.0F;  // of surfels there
};

/// Sides of triangles: both of double-sided ones.
struct Sides {
    std::vector<Side> sides;
    /// By side: the weight, which is area times density, of all sides before it, m²; then that of all.
    std::vector<double> weight_before;
    double weight = 0.0;  // of all

    void add(const Side& side, double area) {
        sides.push_back(side);
        weight_before.push_back(weight);
        weight += area * static_cast<double>(side.density);
    }
};

/// The longest edge of a triangle: from the corner of that index to the next.
struct Edge {
    std::size_t from;
    float length;
};

Edge longest_edge(const std::array<glm::vec3, 3>& corners) {
    Edge longest{0, 0.0F};
    for (std::size_t i = 0; i < 3; ++i) {
        const float length = glm::distance(corners[i], corners[(i + 1) % 3]);
        if (length > longest.length) longest = {i, length};
    }
    return longest;
}

/// Adds a side of that area in parts so small that the density of surfels hardly varies within one.
void add_in_parts(Sides& all, Side side, double area, std::span<const Focus> foci) {
    const std::array<glm::vec3, 3> corners{side.at(side.corners[0]), side.at(side.corners[1]),
                                           side.at(side.corners[2])};
    const glm::vec3 centre = (corners[0] + corners[1] + corners[2]) / 3.0F;
    const Edge longest = longest_edge(corners);
    const auto varies = [&](const Focus& focus) {
        return longest.length >
               0.5F * std::max(focus.radius, glm::distance(centre, focus.centre) - longest.length);
    };
    if (std::ranges::none_of(foci, varies)) {
        side.density = density_at(foci, centre);
        all.add(side, area);
        return;
    }
    const std::size_t to = (longest.from + 1) % 3;
    const glm::vec2 middle = 0.5F * (side.corners[longest.from] + side.corners[to]);
    for (const std::size_t moved : {longest.from, to}) {
        Side half = side;
        half.corners[moved] = middle;
        add_in_parts(all, half, 0.5 * area, foci);
    }
}

/// The sides of the triangles that emit light, or of those that do not.
Sides sides_of(const SceneTriangles& scene, bool emitting) {
    Sides all;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const gpu::TraceTriangle& triangle = scene.triangles[i];
        if (scene.emits[triangle.material] != emitting) continue;
        const glm::vec3 cross = glm::cross(triangle.edge_ab, triangle.edge_ac);
        const float twice_area = glm::length(cross);
        if (!(twice_area > 0.0F)) continue;
        const glm::vec3 front = cross / twice_area;
        const std::uint32_t item = scene.item_of[i];
        const auto foci = scene.foci.empty() ? std::span<const Focus>() : std::span(scene.foci[item]);
        for (int side = 0; side < (scene.double_sided[triangle.material] ? 2 : 1); ++side) {
            add_in_parts(all, {&triangle, side == 0 ? front : -front, item, side == 1},
                         0.5 * static_cast<double>(twice_area), foci);
        }
    }
    all.weight_before.push_back(all.weight);
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

/// `count` points, distributed evenly by area times density.
std::vector<PlacedPoint> spread_points(const Sides& all, std::uint32_t count, std::uint32_t seed) {
    std::vector<PlacedPoint> points;
    const double share = all.weight / count;
    const double start = hash(seed + 1) * (1.0 / 4294967296.0);
    std::size_t index_of_side = 0;
    std::uint32_t index = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double at = (i + start) * share;
        while (index_of_side + 1 < all.sides.size() && at >= all.weight_before[index_of_side + 1]) {
            ++index_of_side;
            index = 0;
        }
        const Side& side = all.sides[index_of_side];
        const auto side_seed = static_cast<std::uint32_t>(index_of_side) * 0x85ebca6bU + seed;
        const glm::vec2 in_part = point_in_triangle(index++, side_seed);
        const auto& corners = side.corners;
        const glm::vec2 b =
            corners[0] + in_part.x * (corners[1] - corners[0]) + in_part.y * (corners[2] - corners[0]);
        const gpu::TraceTriangle& t = *side.triangle;
        points.push_back({{.position = side.at(b),
                           .material = t.material,
                           .normal = side.normal,
                           .area = static_cast<float>(share) / side.density,
                           .uv = t.uv_a + b.x * (t.uv_b - t.uv_a) + b.y * (t.uv_c - t.uv_a),
                           .surfel = 0,
                           .colour = colour_at(t, b)},
                          side.item,
                          {t.id & ~TRIANGLE_MASKED, b, side.back},
                          side.density});
    }
    return points;
}

/// A hash grid of surfels, for finding nearby ones. Where they are less dense, they are in a level of larger
/// cells.
class SurfelGrid {
 public:
    /// `cell`: size of the cells where the density is 1, metres.
    explicit SurfelGrid(float cell) : cell_(cell) {}

    void add(const PlacedPoint& surfel) {
        const int level = level_of(surfel);
        levels_[static_cast<std::size_t>(level)] = true;
        cells_[key(coordinates(surfel.position, level), surfel.item, level)].push_back(
            static_cast<std::uint32_t>(surfels_.size()));
        surfels_.push_back(surfel);
    }

    [[nodiscard]] const std::vector<PlacedPoint>& surfels() const { return surfels_; }

    /// Index of the nearest surfel on the surface of `point`, within about the size of a grid cell; -1: none.
    /// The surfel must be on the same item, the cosine between the normals at least `least_cosine`, and the
    /// distance of the point from the surfel's plane at most `off_plane` grid cells.
    [[nodiscard]] int nearest_like(const PlacedPoint& point, float least_cosine, float off_plane) const {
        Nearest nearest;
        const int level = level_of(point);
        for (int near = std::max(level - 1, 0); near <= std::min(level + 1, last_level); ++near) {
            if (levels_[static_cast<std::size_t>(near)]) find(point, near, least_cosine, off_plane, nearest);
        }
        return nearest.surfel;
    }

 private:
    static constexpr int last_level = 31;

    struct Nearest {
        int surfel = -1;
        float distance2 = std::numeric_limits<float>::infinity();
    };

    /// Replaces `nearest` by a nearer one of a level, if there is one.
    void find(const PlacedPoint& point, int level, float least_cosine, float off_plane,
              Nearest& nearest) const {
        const glm::ivec3 centre = coordinates(point.position, level);
        for (int i = 0; i < 27; ++i) {
            const auto cell =
                cells_.find(key(centre + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1, point.item, level));
            if (cell == cells_.end()) continue;
            for (const std::uint32_t candidate : cell->second) {
                const PlacedPoint& surfel = surfels_[candidate];
                const glm::vec3 apart = point.position - surfel.position;
                const float distance2 = glm::dot(apart, apart);
                if (distance2 < nearest.distance2 && surfel.item == point.item &&
                    glm::dot(point.normal, surfel.normal) >= least_cosine &&
                    std::abs(glm::dot(apart, surfel.normal)) <= off_plane * cell_size(level)) {
                    nearest = {static_cast<int>(candidate), distance2};
                }
            }
        }
    }

    /// Cells of a level are twice as wide as those of the one before.
    static int level_of(const PlacedPoint& point) {
        return std::clamp(static_cast<int>(-0.5F * std::log2(point.density)), 0, last_level);
    }
    [[nodiscard]] float cell_size(int level) const { return std::ldexp(cell_, level); }
    [[nodiscard]] glm::ivec3 coordinates(glm::vec3 position, int level) const {
        return glm::ivec3(glm::floor(position / cell_size(level)));
    }
    /// Different cells may have the same key: callers check what they find.
    static std::uint64_t key(glm::ivec3 at, std::uint32_t item, int level) {
        const auto part = [](int x) { return static_cast<std::uint64_t>(x) & 0xffffU; };
        const std::uint64_t place = part(at.x) | part(at.y) << 16U | part(at.z) << 32U;
        return (place | std::uint64_t{item} << 48U) ^ static_cast<std::uint64_t>(level) << 58U;
    }

    float cell_;
    std::bitset<last_level + 1> levels_;  // those that have surfels
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
        sums[owners[i]] += glm::vec4(points[i].position, 1.0F) / points[i].density;  // by area
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
    const auto spacing = static_cast<float>(std::sqrt(all.weight / count));
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
