#include "renderer/passes/surfels/surfel_focus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <candela/graph/execute.hpp>
#include "engine/bvh/traverse.hpp"
#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {
namespace {

/// Least radius of a focus, in distances between evenly spread surfels, in which those are dense enough.
constexpr float least_spacings = 4.0F;

/// The scene on the CPU.
struct TracedScene {
    const SceneHierarchy& hierarchy;
    const SceneLayout& layout;
    const ScenePlacement& placement;
};

/// Distance along the ray to the nearest surface, in lengths of its direction; infinite if there is none.
float distance_along(const TracedScene& scene, const Ray& ray) {
    float nearest = ray.t_max;
    traverse(scene.hierarchy.top.bvh, ray, [&](std::uint32_t leaf) {
        const std::uint32_t object = scene.hierarchy.top.leaves[leaf].object;
        const SceneLayout::Drawable& drawable = scene.layout.drawables[object];
        const std::span<const Vertex> vertices = vertices_of(drawable, scene.placement.deformed);
        const glm::mat4& world = scene.placement.world[drawable.item];
        traverse(scene.hierarchy.objects[object].bvh, ray, [&](std::uint32_t i) {
            const auto hit = intersect(place_triangle(scene.layout, drawable, vertices, i, world), i, ray);
            if (hit) nearest = std::min(nearest, hit->t);
            return nearest;
        });
        return nearest;
    });
    return nearest;
}

constexpr int rays_a_side = 8;
constexpr int ray_count = rays_a_side * rays_a_side;

/// Rays from the eye through a grid of points in the picture.
std::vector<Ray> rays_through(const CameraView& view) {
    const glm::vec3 forward(-view.view_from_world[0][2], -view.view_from_world[1][2],
                            -view.view_from_world[2][2]);
    std::vector<Ray> rays;
    for (int i = 0; i < ray_count; ++i) {
        const glm::vec2 cell(i % rays_a_side, i / rays_a_side);
        const glm::vec2 at = (2.0F * cell + 1.0F) / static_cast<float>(rays_a_side) - 1.0F;
        const glm::vec4 near = view.world_from_clip * glm::vec4(at, 1.0F, 1.0F);
        const glm::vec3 origin = glm::vec3(near) / near.w;
        rays.push_back({origin, view.orthographic ? forward : glm::normalize(origin - view.eye)});
    }
    return rays;
}

/// Rays in all directions, spread evenly along a spiral on the sphere.
std::vector<Ray> rays_around(const glm::vec3& eye) {
    std::vector<Ray> rays;
    for (int i = 0; i < ray_count; ++i) {
        const float z = static_cast<float>(2 * i + 1) / static_cast<float>(ray_count) - 1.0F;
        const float angle = static_cast<float>(i) * std::numbers::pi_v<float> * (3.0F - std::sqrt(5.0F));
        const float ring = std::sqrt(1.0F - z * z);
        rays.push_back({eye, {ring * std::cos(angle), ring * std::sin(angle), z}});
    }
    return rays;
}

/// Median distance of the surfaces that the rays hit, metres; 0 if they hit none.
float median_distance(const TracedScene& scene, const std::vector<Ray>& rays) {
    std::vector<float> distances;
    for (const Ray& ray : rays) {
        const float distance = distance_along(scene, ray);
        if (std::isfinite(distance)) distances.push_back(distance);
    }
    if (distances.empty()) return 0.0F;
    const auto middle = distances.begin() + std::ssize(distances) / 2;
    std::ranges::nth_element(distances, middle);
    return *middle;
}

std::optional<Focus> focus_of(const CameraView& view, const TracedScene& scene, float spacing) {
    const float distance =
        std::max(median_distance(scene, rays_through(view)), median_distance(scene, rays_around(view.eye)));
    if (!(distance > 0.0F)) return std::nullopt;
    const float radius = 2.0F * std::exp2(std::floor(std::log2(distance)));
    if (least_spacings * spacing <= radius) return std::nullopt;
    const float step = 0.25F * radius;
    return Focus{step * glm::round(view.eye / step), radius};
}

}  // namespace

float density_at(std::span<const Focus> foci, const glm::vec3& place) {
    if (foci.empty()) return 1.0F;
    float radii = std::numeric_limits<float>::infinity();
    for (const Focus& focus : foci)
        radii = std::min(radii, glm::distance(place, focus.centre) / focus.radius);
    radii = std::max(radii, 1.0F);
    return 1.0F / (radii * radii * radii);
}

ValueHandle<std::vector<Focus>> add_surfel_focus(FrameGraph& graph, const SceneData& scene,
                                                 const Tracing& tracing,
                                                 ValueHandle<std::vector<ViewRequest>> requests,
                                                 std::uint32_t count) {
    return graph.add("surfel-focus", [&](Pass& pass) {
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(tracing.hierarchy);
        pass.read(tracing.metrics);
        pass.read(requests);
        pass.read<Camera>();
        pass.read<Transform>();
        pass.parameter(count);
        const auto out = pass.write(graph.value<std::vector<Focus>>("surfel foci"));
        pass.run([=](Execution& run) {
            const TracedScene traced{*run.value(tracing.hierarchy), run.value(scene.layout),
                                     run.value(scene.placement)};
            const float area = run.value(tracing.metrics).area;
            const float spacing = std::sqrt(area / static_cast<float>(std::max(count, 1U)));
            std::vector<Focus> foci;
            for (const ViewRequest& request : run.value(requests)) {
                const auto focus = focus_of(requested_view(run.world(), request), traced, spacing);
                if (!focus) return run.set(out, std::vector<Focus>{});
                foci.push_back(*focus);
            }
            run.set(out, foci);
        });
        return out;
    });
}

}  // namespace candela
