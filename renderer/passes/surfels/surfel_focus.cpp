#include "renderer/passes/surfels/surfel_focus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <candela/graph/execute.hpp>
#include "renderer/passes/scene/traced_scene.hpp"

namespace candela {
namespace {

/// Least radius of a focus, in distances between evenly spread surfels, in which those are dense enough.
constexpr float least_spacings = 4.0F;

constexpr int rays_a_side = 8;
constexpr int ray_count = rays_a_side * rays_a_side;

glm::vec3 forward_of(const CameraView& view) {
    return {-view.view_from_world[0][2], -view.view_from_world[1][2], -view.view_from_world[2][2]};
}

/// Direction i of `ray_count` that are spread evenly, along a spiral on the sphere.
glm::vec3 direction_on_sphere(int i) {
    const float z = static_cast<float>(2 * i + 1) / static_cast<float>(ray_count) - 1.0F;
    const float angle = static_cast<float>(i) * std::numbers::pi_v<float> * (3.0F - std::sqrt(5.0F));
    const float ring = std::sqrt(1.0F - z * z);
    return {ring * std::cos(angle), ring * std::sin(angle), z};
}

std::vector<Ray> rays_around(const glm::vec3& eye) {
    std::vector<Ray> rays;
    rays.reserve(ray_count);
    for (int i = 0; i < ray_count; ++i) rays.push_back({eye, direction_on_sphere(i)});
    return rays;
}

/// Of those rays that meet one.
std::vector<SurfaceHit> nearest_surfaces(const TracedScene& scene, const std::vector<Ray>& rays) {
    std::vector<SurfaceHit> hits;
    for (const Ray& ray : rays) {
        if (const auto hit = nearest_surface(scene, ray)) hits.push_back(*hit);
    }
    return hits;
}

/// Rays onwards from where rays hit, in directions distributed by the cosine to the normal.
std::vector<Ray> rays_onwards(const std::vector<SurfaceHit>& hits, float ray_offset) {
    std::vector<Ray> rays;
    rays.reserve(hits.size());
    for (std::size_t i = 0; i < hits.size(); ++i) {
        // A point of a sphere that touches the surface. Neighbours get different ones; 0.999: never in the
        // surface.
        const glm::vec3 direction =
            hits[i].normal + 0.999F * direction_on_sphere(static_cast<int>(i * 29 % ray_count));
        rays.push_back({hits[i].place + ray_offset * hits[i].normal, glm::normalize(direction)});
    }
    return rays;
}

/// 0 if there are none.
float median_distance(std::vector<SurfaceHit> hits) {
    if (hits.empty()) return 0.0F;
    const auto middle = hits.begin() + std::ssize(hits) / 2;
    std::ranges::nth_element(hits, middle, {}, &SurfaceHit::distance);
    return middle->distance;
}

/// How far the surfaces are that a view sees, and, indoors, those that light them.
float view_distance(const CameraView& view, const TracedScene& scene, float ray_offset) {
    const std::vector<SurfaceHit> seen = nearest_surfaces(scene, rays_through(view, glm::ivec2(rays_a_side)));
    const std::vector<SurfaceHit> around = nearest_surfaces(scene, rays_around(view.eye));
    const std::vector<SurfaceHit> beyond = nearest_surfaces(scene, rays_onwards(seen, ray_offset));
    const float indoors = 2 * beyond.size() > seen.size() ? median_distance(beyond) : 0.0F;
    return std::max({median_distance(seen), median_distance(around), indoors});
}

/// `distance`: view_distance.
std::optional<Focus> focus_of(const CameraView& view, float distance, float spacing) {
    if (!(distance > 0.0F)) return std::nullopt;
    const float radius = 1.5F * std::exp2(std::round(8.0F * std::log2(distance)) / 8.0F);
    if (least_spacings * spacing <= radius) return std::nullopt;
    const float step = radius / 16.0F;
    return Focus{step * glm::round(view.eye / step), radius};
}

/// None if evenly spread surfels are dense enough for a view.
std::vector<Focus> foci_of(const std::vector<CameraView>& views, const std::vector<float>& distances,
                           float area, std::uint32_t count) {
    const float spacing = std::sqrt(area / static_cast<float>(std::max(count, 1U)));
    std::vector<Focus> foci;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto focus = focus_of(views[i], distances[i], spacing);
        if (!focus) return {};
        foci.push_back(*focus);
    }
    return foci;
}

/// Resources of the node.
struct FocusNode {
    SceneData scene;
    Tracing tracing;
    ValueHandle<std::vector<ViewRequest>> requests;
    SurfelFoci out;
};

void find_foci(Execution& run, const FocusNode& node, std::uint32_t count) {
    const TracedScene traced{*run.value(node.tracing.hierarchy), run.value(node.scene.layout),
                             run.value(node.scene.placement)};
    const SceneMetrics& metrics = run.value(node.tracing.metrics);
    const std::vector<CameraView> views = requested_views(run.world(), run.value(node.requests));
    std::vector<float> distances;
    distances.reserve(views.size());
    for (const CameraView& view : views) {
        distances.push_back(view_distance(view, traced, metrics.ray_offset()));
    }
    std::vector<Focus> foci = foci_of(views, distances, metrics.area, count);
    run.set(node.out.of_maps, focus_of_maps(foci));
    run.set(node.out.foci, std::move(foci));
}

}  // namespace

std::vector<Ray> rays_through(const CameraView& view, const glm::ivec2& grid) {
    const glm::vec3 forward = forward_of(view);
    std::vector<Ray> rays;
    for (int i = 0; i < grid.x * grid.y; ++i) {
        const glm::vec2 cell(i % grid.x, i / grid.x);
        const glm::vec2 at = (2.0F * cell + 1.0F) / glm::vec2(grid) - 1.0F;
        const glm::vec4 near = view.world_from_clip * glm::vec4(at, 1.0F, 1.0F);
        const glm::vec3 origin = glm::vec3(near) / near.w;
        rays.push_back({origin, view.orthographic ? forward : glm::normalize(origin - view.eye)});
    }
    return rays;
}

Focus focus_of_maps(std::span<const Focus> foci) {
    if (foci.size() != 1) return {};
    const float radius = std::exp2(std::ceil(std::log2(2.0F * foci.front().radius)));
    const float step = 0.25F * radius;
    return {step * glm::round(foci.front().centre / step), radius};
}

float density_at(std::span<const Focus> foci, const glm::vec3& place) {
    if (foci.empty()) return 1.0F;
    float radii = std::numeric_limits<float>::infinity();
    for (const Focus& focus : foci) {
        radii = std::min(radii, glm::distance(place, focus.centre) / focus.radius);
    }
    radii = std::max(radii, 1.0F);
    return 1.0F / (radii * radii * radii);
}

SurfelFoci add_surfel_focus(FrameGraph& graph, const SceneData& scene, const Tracing& tracing,
                            ValueHandle<std::vector<ViewRequest>> requests, std::uint32_t count) {
    return graph.add("surfel-focus", [&](Pass& pass) {
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(tracing.hierarchy);
        pass.read(tracing.metrics);
        read_requests(pass, requests);
        pass.parameter(count);
        const FocusNode node{.scene = scene,
                             .tracing = tracing,
                             .requests = requests,
                             .out = {.foci = pass.write(graph.value<std::vector<Focus>>("surfel foci")),
                                     .of_maps = pass.write(graph.value<Focus>("focus of maps"))}};
        pass.run([=](Execution& run) { find_foci(run, node, count); });
        return node.out;
    });
}

}  // namespace candela
