#include "renderer/passes/surfels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"
#include "renderer/passes/world_triangles.hpp"

namespace candela {
namespace {

/// One side of a triangle.
struct Side {
    const gpu::TraceTriangle* triangle;
    glm::vec3 normal;  // unit
};

/// All sides that reflect.
struct Sides {
    std::vector<Side> sides;
    std::vector<double> area_before;  // m², of the sides before each one; one more for all of them
};

Sides sides_of(std::span<const gpu::TraceTriangle> triangles, const std::vector<bool>& double_sided) {
    Sides all;
    double area = 0.0;
    for (const gpu::TraceTriangle& triangle : triangles) {
        const glm::vec3 cross = glm::cross(triangle.edge_ab, triangle.edge_ac);
        const float twice_area = glm::length(cross);
        if (!(twice_area > 0.0F)) {
            continue;
        }
        const glm::vec3 front = cross / twice_area;
        for (int side = 0; side < (double_sided[triangle.material] ? 2 : 1); ++side) {
            all.sides.push_back({&triangle, side == 0 ? front : -front});
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

/// Point `index` of the sequence R2 in a triangle (Roberts, 2018), folded from the square: weights of b and
/// c.
glm::vec2 point_in_triangle(std::uint32_t index, std::uint32_t seed) {
    constexpr glm::dvec2 step(0.7548776662466927, 0.5698402909980532);
    constexpr double unit = 1.0 / 4294967296.0;
    const glm::dvec2 start(hash(seed) * unit, hash(seed ^ 0x9e3779b9U) * unit);
    glm::dvec2 point = glm::fract(start + step * static_cast<double>(index));
    if (point.x + point.y > 1.0) {
        point = 1.0 - point;
    }
    return glm::vec2(point);
}

/// `count` points, even in area.
std::vector<gpu::CellPoint> spread_points(const Sides& all, std::uint32_t count, std::uint32_t seed) {
    std::vector<gpu::CellPoint> points;
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
        points.push_back({.position = t.a + b.x * t.edge_ab + b.y * t.edge_ac,
                          .material = t.material,
                          .normal = all.sides[side].normal,
                          .area = static_cast<float>(share),
                          .uv = t.uv_a + b.x * (t.uv_b - t.uv_a) + b.y * (t.uv_c - t.uv_a),
                          .pad0 = glm::vec2(0.0F)});
    }
    return points;
}

/// Surfels by where they are, for finding those nearby.
class SurfelGrid {
 public:
    explicit SurfelGrid(float cell) : cell_(cell) {}

    void add(const gpu::CellPoint& surfel) {
        cells_[key(coordinates(surfel.position))].push_back(static_cast<std::uint32_t>(surfels_.size()));
        surfels_.push_back(surfel);
    }

    [[nodiscard]] const std::vector<gpu::CellPoint>& surfels() const { return surfels_; }

    /// The nearest one within about a cell whose surface is the point's: with a normal at least so like its
    /// own, and a plane no farther off than that share of a cell. -1: none.
    [[nodiscard]] int nearest_like(const gpu::CellPoint& point, float least_cosine, float off_plane) const {
        const glm::ivec3 centre = coordinates(point.position);
        float best = std::numeric_limits<float>::infinity();
        int found = -1;
        for (int i = 0; i < 27; ++i) {
            const auto cell = cells_.find(key(centre + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1));
            if (cell == cells_.end()) {
                continue;
            }
            for (const std::uint32_t candidate : cell->second) {
                const gpu::CellPoint& surfel = surfels_[candidate];
                const glm::vec3 apart = point.position - surfel.position;
                const float distance2 = glm::dot(apart, apart);
                if (distance2 < best && glm::dot(point.normal, surfel.normal) >= least_cosine &&
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
    static std::uint64_t key(glm::ivec3 at) {
        const auto part = [](int x) { return static_cast<std::uint64_t>(x) & 0x1fffffU; };
        return part(at.x) | part(at.y) << 21U | part(at.z) << 42U;
    }

    float cell_;
    std::vector<gpu::CellPoint> surfels_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

/// Which surfel each point belongs to. Points that are like none become surfels.
std::vector<std::uint32_t> assign(SurfelGrid& grid, const std::vector<gpu::CellPoint>& points) {
    std::vector<std::uint32_t> owners;
    owners.reserve(points.size());
    for (const gpu::CellPoint& point : points) {
        int owner = grid.nearest_like(point, 0.9F, 0.1F);
        if (owner < 0) {
            owner = grid.nearest_like(point, 0.5F, 0.5F);
        }
        if (owner < 0) {
            owner = static_cast<int>(grid.surfels().size());
            grid.add(point);
        }
        owners.push_back(static_cast<std::uint32_t>(owner));
    }
    return owners;
}

/// The point of each cell that is nearest to the middle of it, which spreads the surfels more evenly (Lloyd,
/// "Least squares quantization in PCM", 1982).
std::vector<gpu::CellPoint> middles(const std::vector<gpu::CellPoint>& points,
                                    const std::vector<std::uint32_t>& owners,
                                    const std::vector<gpu::CellPoint>& surfels) {
    std::vector<glm::vec4> sums(surfels.size(), glm::vec4(0.0F));
    for (std::size_t i = 0; i < points.size(); ++i) {
        sums[owners[i]] += glm::vec4(points[i].position, 1.0F);
    }
    std::vector<gpu::CellPoint> chosen = surfels;
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

SurfelGrid grid_of(const std::vector<gpu::CellPoint>& surfels, float cell) {
    SurfelGrid grid(cell);
    for (const gpu::CellPoint& surfel : surfels) {
        grid.add(surfel);
    }
    return grid;
}

/// Sorts the points by cell. Cells without points are left out.
SurfelSet collect(const SurfelGrid& grid, const std::vector<gpu::CellPoint>& points,
                  const std::vector<std::uint32_t>& owners) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return owners[i]; });
    SurfelSet set;
    std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
    for (const std::uint32_t i : order) {
        if (owners[i] != last) {
            last = owners[i];
            const gpu::CellPoint& surfel = grid.surfels()[last];
            set.surfels.push_back({.position = surfel.position,
                                   .map = static_cast<std::uint32_t>(set.surfels.size()),
                                   .normal = surfel.normal,
                                   .radius2 = 0.0F,
                                   .flux = glm::vec3(0.0F),
                                   .first_point = static_cast<std::uint32_t>(set.points.size()),
                                   .edges_up = glm::vec3(0.0F),
                                   .point_count = 0,
                                   .edges_down = glm::vec3(0.0F),
                                   .area = 0.0F,
                                   .map_origin = surfel.position,
                                   .pad0 = 0.0F});
        }
        gpu::Vpl& surfel = set.surfels.back();
        ++surfel.point_count;
        surfel.area += points[i].area;
        surfel.radius2 = surfel.area / std::numbers::pi_v<float>;
        set.points.push_back(points[i]);
    }
    return set;
}

SurfelSet spread_surfels(const Sides& all, std::uint32_t count, std::uint32_t seed) {
    constexpr int rounds = 2;
    const auto spacing = static_cast<float>(std::sqrt(all.area_before.back() / count));
    const std::vector<gpu::CellPoint> points = spread_points(all, points_a_surfel * count, hash(seed));
    SurfelGrid grid = grid_of(spread_points(all, count, hash(seed ^ 0x5bd1e995U)), spacing);
    std::vector<std::uint32_t> owners = assign(grid, points);
    for (int round = 0; round < rounds; ++round) {
        grid = grid_of(middles(points, owners, grid.surfels()), spacing);
        owners = assign(grid, points);
    }
    return collect(grid, points, owners);
}

VplPaths plan_of(const SurfelSet& set) {
    VplPaths plan;
    plan.vpl_count = plan.map_count = static_cast<std::uint32_t>(set.surfels.size());
    plan.point_count = static_cast<std::uint32_t>(set.points.size());
    plan.maps_due.resize(plan.vpl_count);
    std::iota(plan.maps_due.begin(), plan.maps_due.end(), 0U);
    return plan;
}

SurfelSet place_in_scene(const SceneLayout& layout, const ScenePlacement& placement,
                         const VplSettings& settings) {
    const WorldTriangles world = place_triangles(layout, placement);
    std::vector<std::uint32_t> order(world.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<bool> double_sided;
    for (const auto& material : layout.materials) {
        double_sided.push_back(material->double_sided);
    }
    return place_surfels(trace_triangles(layout, world, order), double_sided, settings.count, settings.seed);
}

}  // namespace

SurfelSet place_surfels(std::span<const gpu::TraceTriangle> triangles, const std::vector<bool>& double_sided,
                        std::uint32_t count, std::uint32_t seed) {
    const Sides all = sides_of(triangles, double_sided);
    if (all.sides.empty() || count == 0) {
        return {};
    }
    constexpr int attempts = 4;
    std::uint32_t wanted = count;
    SurfelSet set = spread_surfels(all, wanted, seed);
    for (int i = 1; i < attempts && set.surfels.size() > count; ++i) {
        wanted = static_cast<std::uint32_t>(std::uint64_t{wanted} * count / set.surfels.size());
        set = spread_surfels(all, std::max(wanted, 1U), seed);
    }
    return set;
}

Surfels add_surfels(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                    std::optional<ValueHandle<Refinement>> refinement, const VplSettings& settings) {
    return graph.add("surfels", [&](Pass& pass) {
        pass.read(scene.layout);
        pass.read(scene.placement);
        if (refinement) {
            pass.read(*refinement);
        }
        pass.parameter(settings.count);
        pass.parameter(settings.seed);
        const Surfels out{
            .plan = pass.write(graph.value<VplPaths>("surfel plan")),
            .surfels = pass.write(graph.buffer<gpu::Vpl>("surfels", 1, Lifetime::persistent), Usage::copy),
            .points = pass.write(graph.buffer<gpu::CellPoint>("cell points", 1, Lifetime::persistent),
                                 Usage::copy)};
        pass.run([=, &gpu, layout = scene.layout, placement = scene.placement](Execution& run) {
            VplSettings of_set = settings;
            of_set.seed += refinement ? run.value(*refinement).set : 0;
            const SurfelSet set = place_in_scene(run.value(layout), run.value(placement), of_set);
            upload<gpu::Vpl>(gpu, run, out.surfels, set.surfels);
            upload<gpu::CellPoint>(gpu, run, out.points, set.points);
            run.set(out.plan, plan_of(set));
        });
        return out;
    });
}

}  // namespace candela
