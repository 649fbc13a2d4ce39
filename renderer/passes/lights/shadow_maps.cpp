#include "renderer/passes/lights/shadow_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/layer_target.hpp"
#include "renderer/passes/inspect/depth_note.hpp"
#include "renderer/passes/lights/light_kind.hpp"
#include "renderer/passes/lights/shadow_draws.hpp"
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {
namespace {

constexpr std::uint32_t cube_faces = 6;
constexpr std::uint32_t most_layers = 2048;  // of an array texture, on every driver (OpenGL 4.5, table 23.53)
constexpr std::uint64_t bytes_per_depth = 4;
/// The map of a directional light shows all of a world. Of one that has more triangles, drawing it takes
/// longer than the rays of many pictures.
constexpr std::uint64_t most_triangles_of_map = 1U << 24U;

/// A matrix to clip space, and gpu::Shadow::depth_scale.
struct MapProjection {
    glm::dmat4 from_view;
    double depth_scale = 0.0;
};

/// With reversed depth: 1 at `near`, 0 at `far`, in metres; `far` may be infinite. `tangent` is that of the
/// half angle.
MapProjection perspective(double tangent, double near, double far) {
    const double depth_scale = near / (1.0 - near / far);
    glm::dmat4 m(0.0);
    m[0][0] = m[1][1] = 1.0 / tangent;
    m[2][2] = depth_scale / far;
    m[2][3] = -1.0;
    m[3][2] = depth_scale;
    return {m, depth_scale};
}

/// With reversed depth: 1 at the viewer, 0 at `depth` metres in front of it.
MapProjection orthographic(glm::dvec2 half_extent, double depth) {
    glm::dmat4 m(1.0);
    m[0][0] = 1.0 / half_extent.x;
    m[1][1] = 1.0 / half_extent.y;
    m[2][2] = 1.0 / depth;
    m[3][2] = 1.0;
    return {m};
}

/// In double precision, so that a scene that is far from the light has its own precision, not that of its
/// distance.
glm::dmat4 look_along(glm::dvec3 position, glm::dvec3 direction, glm::dvec3 up) {
    return glm::lookAt(position, position + direction, up);
}

/// Viewing direction and up vector of a cube face, in the order of OpenGL (OpenGL 4.5, table 8.19).
struct Face {
    glm::vec3 direction;
    glm::vec3 up;
};
const std::array<Face, cube_faces> faces{{{{1, 0, 0}, {0, -1, 0}},
                                          {{-1, 0, 0}, {0, -1, 0}},
                                          {{0, 1, 0}, {0, 0, 1}},
                                          {{0, -1, 0}, {0, 0, -1}},
                                          {{0, 0, 1}, {0, -1, 0}},
                                          {{0, 0, -1}, {0, -1, 0}}}};

/// A shadow of a kind without any map.
gpu::Shadow without_map(std::uint32_t kind, float ray_offset) {
    return {.from_world = glm::mat4(1.0F),
            .depth_scale = 0.0F,
            .layer = 0,
            .kind = kind,
            .ray_offset = ray_offset};
}

ShadowPlan::View view_of(const gpu::Light& light, const MapProjection& projection, const glm::dmat4& view) {
    return {.clip_from_world = glm::mat4(projection.from_view * view),
            .light_position = light.position,
            .depth_scale = static_cast<float>(projection.depth_scale)};
}

gpu::Shadow shadow_of(const ShadowPlan::View& view, float ray_offset) {
    return {.from_world = view.clip_from_world,
            .depth_scale = view.depth_scale,
            .layer = view.layer,
            .kind = view.depth_scale > 0.0F ? SHADOW_PERSPECTIVE : SHADOW_ORTHOGRAPHIC,
            .ray_offset = ray_offset};
}

/// The faces are wider than the cube's by half a texel on each side, so that the four texels around any
/// direction are all in one face.
gpu::Shadow add_cube(ShadowPlan& plan, const gpu::Light& light, const ShadowShape& shape, float ray_offset) {
    const double resolution = plan.resolution.cube;
    const MapProjection projection = perspective(resolution / (resolution - 1.0), shape.near, shape.far);
    gpu::Shadow cube = without_map(SHADOW_CUBE, ray_offset);
    cube.layer = static_cast<std::uint32_t>(plan.shadows.size());
    for (std::uint32_t face = 0; face < cube_faces; ++face) {
        ShadowPlan::View view =
            view_of(light, projection, look_along(light.position, faces[face].direction, faces[face].up));
        view.cube = true;
        view.layer = plan.cubes * cube_faces + face;
        plan.shadows.push_back(shadow_of(view, ray_offset));
        plan.views.push_back(view);
    }
    ++plan.cubes;
    return cube;
}

gpu::Shadow add_map(ShadowPlan& plan, const gpu::Light& light, const ShadowShape& shape, float ray_offset) {
    // Two texels on each side, for the four around a receiver.
    const double margin = 1.0 + 4.0 / plan.resolution.map;
    const MapProjection projection =
        shape.kind == SHADOW_PERSPECTIVE
            ? perspective(margin * shape.tangent, shape.near, shape.far)
            // look_along's x axis is cross(direction, up) = ± tangent; its extent is that of the tangent.
            : orthographic(margin * glm::dvec2(shape.half_extent), shape.far);
    ShadowPlan::View view = view_of(
        light, projection, look_along(light.position, shape.axis, basis_around(shape.axis).bitangent));
    view.layer = plan.maps++;
    plan.views.push_back(view);
    return shadow_of(view, ray_offset);
}

/// Light indices by decreasing flux; lights of equal flux keep their order.
std::vector<std::uint32_t> by_importance(const LightTable& lights) {
    std::vector<std::uint32_t> order(lights.entries.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto power = [&](std::uint32_t i) {
        const glm::vec3& flux = lights.entries[i].flux;
        return flux.r + flux.g + flux.b;
    };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return power(a) > power(b); });
    return order;
}

TextureDesc array_desc(std::uint32_t resolution, std::uint32_t layers) {
    return {{resolution, resolution}, Format::depth32f, TextureShape::array, layers};
}

/// Gives the texture this many layers, or one texel if there are none. Returns whether it keeps its content.
bool reserve(Execution& run, TextureHandle texture, std::uint32_t resolution, std::uint32_t layers) {
    const TextureDesc desc = layers > 0 ? array_desc(resolution, layers) : array_desc(1, 1);
    const bool kept = run.desc(texture) == desc;
    run.reserve(texture, desc);
    return kept;
}

/// The numbers of the plan's views whose shadow maps are missing or outdated.
std::vector<std::size_t> due_views(Execution& run, bool surfaces_changed, const ShadowMaps& out) {
    const ShadowPlan& plan = run.value(out.plan);
    const bool keeps_cubes = reserve(run, out.cubes, plan.resolution.cube, plan.cubes * cube_faces);
    const bool keeps_maps = reserve(run, out.maps, plan.resolution.map, plan.maps);
    const DrawnShadows* const last = run.previous(out.drawn);
    std::map<std::pair<bool, std::uint32_t>, const ShadowPlan::View*> shown;
    if (last != nullptr && !surfaces_changed) {
        for (const ShadowPlan::View& view : last->views) {
            if (view.cube ? keeps_cubes : keeps_maps) shown[{view.cube, view.layer}] = &view;
        }
    }
    std::vector<std::size_t> due;
    due.reserve(plan.views.size());
    for (std::size_t i = 0; i < plan.views.size(); ++i) {
        const auto found = shown.find({plan.views[i].cube, plan.views[i].layer});
        if (found == shown.end() || *found->second != plan.views[i]) due.push_back(i);
    }
    return due;
}

std::uint32_t resolution_of(const ShadowPlan::View& view, const ShadowResolution& resolution) {
    return view.cube ? resolution.cube : resolution.map;
}

/// What the node is made of.
struct ShadowNode {
    SceneData scene;
    ShadowMaps out;
    const gl::Program* program;  // null if nothing casts shadows
    ValueHandle<SceneMetrics> metrics;
};

const gl::Program& shadow_program(Gpu& gpu) {
    return gpu.program({"lights/shadow_maps.vert", "lights/shadow_maps.geom", "lights/shadow_maps.frag"});
}

/// The draws of a view: `count` from number `first` on.
struct DrawRange {
    std::size_t first;
    std::size_t count;
};

/// Uploads the draws of all views, also of those whose maps are kept, so that the buffer depends on no
/// earlier frame. Makes them those that are drawn next, and returns their ranges, by view.
std::vector<DrawRange> upload_draws(const Gpu& gpu, Execution& run, const ShadowNode& node) {
    const ShadowPlan& plan = run.value(node.out.plan);
    std::vector<ShadowCaster> casters;
    if (!plan.views.empty()) {
        casters = shadow_casters(run.value(node.scene.layout), run.value(node.scene.placement),
                                 run.value(node.metrics).ray_offset());
    }
    std::vector<gpu::DrawCommand> draws;
    std::vector<DrawRange> ranges;
    ranges.reserve(plan.views.size());
    for (const ShadowPlan::View& view : plan.views) {
        const std::size_t first = draws.size();
        append_shadow_draws(casters, view.clip_from_world, resolution_of(view, plan.resolution), draws);
        ranges.push_back({first, draws.size() - first});
    }
    upload<gpu::DrawCommand>(gpu, run, node.out.draws, draws);
    gpu.gl().BindBuffer(GL_DRAW_INDIRECT_BUFFER, run.object(node.out.draws));
    return ranges;
}

void draw_views(Gpu& gpu, Execution& run, const ShadowNode& node, const std::vector<std::size_t>& due) {
    const auto& out = node.out;
    const ShadowPlan& plan = run.value(out.plan);
    run.set(out.drawn, {plan.views, static_cast<std::uint32_t>(due.size())});

    // Rays end nearer to the light.
    const float least_distance = 0.5F * run.value(node.metrics).ray_offset();
    bind_meshes(gpu, run, node.scene);
    const std::vector<DrawRange> draws = upload_draws(gpu, run, node);
    LayerTarget target(gpu);
    for (const std::size_t i : due) {
        const ShadowPlan::View& view = plan.views[i];
        const std::uint32_t resolution = resolution_of(view, plan.resolution);
        target.set_layer(run.object(view.cube ? out.cubes : out.maps), view.layer, resolution);
        target.clear();
        if (draws[i].count == 0) continue;
        node.program->use({{"clip_from_world", view.clip_from_world},
                           {"depth_scale", view.depth_scale},
                           {"light_position", view.light_position},
                           {"least_w", view.depth_scale > 0.0F ? least_distance : 0.5F},
                           {"texel", 2.0F / static_cast<float>(resolution)}});
        draw_commands(gpu, draws[i].first, draws[i].count, {.depth_test = gl::DepthTest::nearer});
    }
}

struct PlannedShadows {
    ValueHandle<ShadowPlan> plan;
    BufferHandle<gpu::Shadow> shadows;
};

PlannedShadows add_shadow_plan(FrameGraph& graph, const Gpu& gpu, ValueHandle<LightTable> lights,
                               ValueHandle<SceneMetrics> metrics, const ShadowSettings& settings,
                               float scale) {
    return graph.add("shadow-plan", [&](Pass& pass) {
        pass.read(lights);
        pass.read(metrics);
        pass.parameter(settings);
        pass.parameter(scale);
        const PlannedShadows out{
            .plan = pass.write(graph.value<ShadowPlan>("shadow plan")),
            .shadows = pass.write(growing_buffer<gpu::Shadow>(graph, "shadow buffer"), Usage::copy)};
        pass.run([=, &gpu](Execution& run) {
            ShadowPlan plan = plan_shadows(run.value(lights), run.value(metrics), settings, scale);
            upload<gpu::Shadow>(gpu, run, out.shadows, plan.shadows);
            run.set(out.plan, std::move(plan));
        });
        return out;
    });
}

/// Of the map in this layer; none if no light uses it.
std::optional<DepthTerms> depth_terms(const ShadowPlan& plan, bool cubes, std::uint32_t layer) {
    const auto found = std::ranges::find_if(
        plan.views, [&](const ShadowPlan::View& view) { return view.cube == cubes && view.layer == layer; });
    if (found == plan.views.end()) return std::nullopt;
    const glm::mat4& clip = found->clip_from_world;
    const float slope = glm::length(glm::vec3(clip[0][2], clip[1][2], clip[2][2]));  // of z along the axis
    if (found->depth_scale == 0.0F) return linear_terms(1.0F / slope);
    DepthTerms terms = perspective_terms(found->depth_scale);
    terms[0] = slope;
    return terms;
}

}  // namespace

ShadowResolution shadow_resolution(const ShadowSettings& settings, float scale) {
    constexpr std::uint32_t least = 16;
    const auto halvings = static_cast<std::uint32_t>(std::clamp(std::floor(-std::log2(scale)), 0.0F, 16.0F));
    const auto reduced = [&](std::uint32_t resolution) {
        return std::max(resolution >> halvings, std::min(resolution, least));
    };
    return {reduced(settings.cube_resolution), reduced(settings.map_resolution)};
}

ShadowPlan plan_shadows(const LightTable& lights, const SceneMetrics& metrics, const ShadowSettings& settings,
                        float scale) {
    ShadowPlan plan;
    plan.resolution = shadow_resolution(settings, scale);
    plan.shadows.assign(lights.entries.size(), without_map(SHADOW_NONE, 0.0F));
    const auto bytes = [](std::uint64_t resolution, std::uint64_t layers) {
        return resolution * resolution * layers * bytes_per_depth;
    };
    std::uint64_t budget = settings.enabled ? static_cast<std::uint64_t>(settings.budget_mib) << 20U : 0;
    for (const std::uint32_t i : by_importance(lights)) {
        const LightTable::Entry& entry = lights.entries[i];
        if (!entry.casts_shadow || !settings.enabled) continue;
        const ShadowShape shape = light_kinds[entry.light.kind]->shadow(entry.light, metrics);
        const bool cube = shape.kind == SHADOW_CUBE;
        const std::uint64_t cost =
            cube ? bytes(settings.cube_resolution, cube_faces) : bytes(settings.map_resolution, 1);
        const bool no_layer = cube ? (plan.cubes + 1) * cube_faces > most_layers : plan.maps == most_layers;
        const bool shows_all = entry.light.kind == LIGHT_DIRECTIONAL;
        const bool too_many = shows_all && metrics.triangles > most_triangles_of_map;
        if (cost > budget || no_layer || too_many) {
            ++plan.by_rays;
            plan.shadows[i] = without_map(SHADOW_BY_RAYS, metrics.ray_offset());
            continue;
        }
        budget -= cost;
        const gpu::Shadow shadow = cube ? add_cube(plan, entry.light, shape, metrics.ray_offset())
                                        : add_map(plan, entry.light, shape, metrics.ray_offset());
        plan.shadows[i] = shadow;  // a cube has added its faces to the list
    }
    return plan;
}

ShadowMaps add_shadow_maps(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                           ValueHandle<LightTable> lights, ValueHandle<SceneMetrics> metrics,
                           const ShadowSettings& settings, float scale) {
    const PlannedShadows planned = add_shadow_plan(graph, gpu, lights, metrics, settings, scale);
    return graph.add("shadow-maps", [&](Pass& pass) {
        const std::vector<ResourceHandle> surfaces = read_meshes(pass, scene);
        pass.read(scene.placement);
        pass.read(planned.plan);
        pass.read(metrics);
        const gl::Program* const program = scene.kinds.any() ? &shadow_program(gpu) : nullptr;
        const ShadowMaps out{
            .plan = planned.plan,
            .shadows = planned.shadows,
            .cubes = pass.update(graph.texture("shadow cubes", array_desc(1, 1), Lifetime::persistent),
                                 Usage::layer_target),
            .maps = pass.update(graph.texture("shadow maps", array_desc(1, 1), Lifetime::persistent),
                                Usage::layer_target),
            .drawn = pass.update(graph.value<DrawnShadows>("drawn shadows")),
            .draws = pass.write(growing_buffer<gpu::DrawCommand>(graph, "shadow draws"), Usage::copy)};
        for (const bool cubes : {true, false}) {
            graph.note(cubes ? out.cubes : out.maps,
                       depth_note(planned.plan, [=](const ShadowPlan& drawn, std::uint32_t layer) {
                           return depth_terms(drawn, cubes, layer);
                       }));
        }
        pass.run([=, &gpu](Execution& run) {
            const auto due = due_views(run, run.changed(surfaces), out);
            draw_views(gpu, run, {scene, out, program, metrics}, due);
        });
        return out;
    });
}

void read_shadow_maps(Pass& pass, const ShadowMaps& shadows) {
    pass.read(shadows.shadows, {Usage::storage, BINDING_SHADOWS});
    pass.read(shadows.cubes, {Usage::sampled, UNIT_SHADOW_CUBES});
    pass.read(shadows.maps, {Usage::sampled, UNIT_SHADOW_MAPS});
}

}  // namespace candela
