#include "renderer/passes/lights/shadow_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/layer_target.hpp"
#include "renderer/passes/inspect/depth_note.hpp"
#include "renderer/passes/lights/light_kind.hpp"
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {
namespace {

constexpr std::uint32_t cube_faces = 6;
constexpr std::uint32_t most_layers = 2048;  // of an array texture, on every driver (OpenGL 4.5, table 23.53)
constexpr float slope_offset = 1.0F;         // texels: shaders/lights/shadow.glsl relies on it
constexpr std::uint64_t bytes_per_depth = 4;
// Near plane of perspective maps, relative to the scene's radius. Nearer geometry is clamped to it, not
// clipped.
constexpr float relative_near_plane = 1e-3F;

/// Projection with reversed depth and no far plane: depth = near / distance. `tangent` is the tangent of the
/// half angle.
glm::mat4 reversed_perspective(float tangent, float near_plane) {
    glm::mat4 m(0.0F);
    m[0][0] = m[1][1] = 1.0F / tangent;
    m[2][3] = -1.0F;
    m[3][2] = near_plane;
    return m;
}

/// Orthographic projection with reversed depth: 1 at the viewer, 0 at `depth` metres in front of it.
glm::mat4 reversed_orthographic(glm::vec2 half_extent, float depth) {
    glm::mat4 m(1.0F);
    m[0][0] = 1.0F / half_extent.x;
    m[1][1] = 1.0F / half_extent.y;
    m[2][2] = 1.0F / depth;
    m[3][2] = 1.0F;
    return m;
}

glm::mat4 look_along(glm::vec3 position, glm::vec3 direction, glm::vec3 up) {
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

const gpu::Shadow no_shadow{.from_world = glm::mat4(1.0F),
                            .axis = glm::vec3(0.0F),
                            .texel = 0.0F,
                            .near_plane = 0.0F,
                            .layer = 0,
                            .kind = SHADOW_NONE,
                            .ray_offset = 0.0F};

/// Lengths that the maps of all lights have in common, metres.
struct MapLengths {
    float near_plane;
    float ray_offset;
};

gpu::Shadow add_cube(ShadowPlan& plan, const gpu::Light& light, const MapLengths& lengths,
                     std::uint32_t resolution) {
    const gpu::Shadow shadow{.from_world = glm::mat4(1.0F),
                             .axis = glm::vec3(0.0F),
                             .texel = 2.0F / static_cast<float>(resolution),
                             .near_plane = lengths.near_plane,
                             .layer = plan.cubes,
                             .kind = SHADOW_CUBE,
                             .ray_offset = lengths.ray_offset};
    const glm::mat4 projection = reversed_perspective(1.0F, lengths.near_plane);
    for (std::uint32_t face = 0; face < cube_faces; ++face) {
        const glm::mat4 view = look_along(light.position, faces[face].direction, faces[face].up);
        plan.views.push_back({projection * view, true, plan.cubes * cube_faces + face});
    }
    ++plan.cubes;
    return shadow;
}

gpu::Shadow add_map(ShadowPlan& plan, const gpu::Light& light, const ShadowShape& shape,
                    const MapLengths& lengths, std::uint32_t resolution) {
    const float near_plane = lengths.near_plane;
    const auto texels = static_cast<float>(resolution);
    const float margin = 1.0F + 4.0F / texels;  // two texels on each side, for the filter
    const glm::mat4 view =
        look_along(light.position, light.direction, basis_around(light.direction).bitangent);
    gpu::Shadow shadow{.from_world = glm::mat4(1.0F),
                       .axis = light.direction,
                       .texel = 0.0F,
                       .near_plane = near_plane,
                       .layer = plan.maps,
                       .kind = shape.kind,
                       .ray_offset = lengths.ray_offset};
    if (shape.kind == SHADOW_PERSPECTIVE) {
        const float tangent = margin * shape.tangent;
        shadow.texel = 2.0F * tangent / texels;
        shadow.from_world = reversed_perspective(tangent, near_plane) * view;
    } else {
        // look_along's x axis is cross(direction, up) = ± tangent; its extent is that of the tangent.
        const glm::vec2 half = glm::max(shape.half_extent * margin, glm::vec2(near_plane));
        shadow.texel = 2.0F * std::max(half.x, half.y) / texels;
        shadow.from_world = reversed_orthographic(half, std::max(shape.depth, near_plane)) * view;
    }
    plan.views.push_back({shadow.from_world, false, plan.maps});
    ++plan.maps;
    return shadow;
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

TextureDesc cube_desc(std::uint32_t resolution, std::uint32_t cubes) {
    return {{resolution, resolution}, Format::depth32f, TextureShape::cube_array, cubes * cube_faces};
}

TextureDesc map_desc(std::uint32_t resolution, std::uint32_t maps) {
    return {{resolution, resolution}, Format::depth32f, TextureShape::array, maps};
}

struct ShadowPrograms {
    const gl::Program& opaque;
    const gl::Program& masked;
};

void draw_view(Gpu& gpu, Execution& run, const SceneData& scene, const ShadowPrograms& programs,
               const glm::mat4& clip_from_world) {
    constexpr gl::RasterState state{.depth_test = gl::DepthTest::nearer,
                                    .clamps_depth = true,
                                    .slope_offset = -slope_offset};  // away from the light: depth is reversed
    const gl::Uniforms uniforms{{"clip_from_world", clip_from_world}};
    programs.opaque.use(uniforms);
    draw_depth(gpu, run, scene, state);
    programs.masked.use(uniforms);
    draw_masked_depth(gpu, run, scene, state);
}

/// Gives the texture this description. Returns whether it keeps its content.
bool reserve(Execution& run, TextureHandle texture, const TextureDesc& desc) {
    const bool kept = run.desc(texture) == desc;
    run.reserve(texture, desc);
    return kept;
}

/// The views of the plan whose shadow maps are missing or outdated.
std::vector<ShadowPlan::View> due_views(Execution& run, bool surfaces_changed, const ShadowMaps& out,
                                        const ShadowSettings& settings) {
    const ShadowPlan& plan = run.value(out.plan);
    const bool keeps_cubes = reserve(
        run, out.cubes, plan.cubes > 0 ? cube_desc(settings.cube_resolution, plan.cubes) : cube_desc(1, 1));
    const bool keeps_maps =
        reserve(run, out.maps, plan.maps > 0 ? map_desc(settings.map_resolution, plan.maps) : map_desc(1, 1));
    const DrawnShadows* const last = run.previous(out.drawn);
    if (last == nullptr || surfaces_changed) return plan.views;
    std::map<std::pair<bool, std::uint32_t>, const ShadowPlan::View*> shown;
    for (const ShadowPlan::View& view : last->views) {
        if (view.cube ? keeps_cubes : keeps_maps) shown[{view.cube, view.layer}] = &view;
    }
    std::vector<ShadowPlan::View> due;
    std::ranges::copy_if(plan.views, std::back_inserter(due), [&](const ShadowPlan::View& view) {
        const auto found = shown.find({view.cube, view.layer});
        return found == shown.end() || *found->second != view;
    });
    return due;
}

/// What the node is made of.
struct ShadowNode {
    SceneData scene;
    ShadowMaps out;
    ShadowSettings settings;
    ShadowPrograms programs;
};

void draw_views(Gpu& gpu, Execution& run, const ShadowNode& node, const std::vector<ShadowPlan::View>& due) {
    const auto& out = node.out;
    const ShadowSettings& settings = node.settings;
    run.set(out.drawn, {run.value(out.plan).views, static_cast<std::uint32_t>(due.size())});

    bind_meshes(gpu, run, node.scene);
    LayerTarget target(gpu);
    for (const ShadowPlan::View& view : due) {
        target.set_layer(run.object(view.cube ? out.cubes : out.maps), view.layer,
                         view.cube ? settings.cube_resolution : settings.map_resolution);
        target.clear();
        draw_view(gpu, run, node.scene, node.programs, view.clip_from_world);
    }
}

struct PlannedShadows {
    ValueHandle<ShadowPlan> plan;
    BufferHandle<gpu::Shadow> shadows;
};

PlannedShadows add_shadow_plan(FrameGraph& graph, const Gpu& gpu, ValueHandle<LightTable> lights,
                               ValueHandle<SceneMetrics> metrics, const ShadowSettings& settings) {
    return graph.add("shadow-plan", [&](Pass& pass) {
        pass.read(lights);
        pass.read(metrics);
        pass.parameter(settings);
        const PlannedShadows out{
            .plan = pass.write(graph.value<ShadowPlan>("shadow plan")),
            .shadows = pass.write(growing_buffer<gpu::Shadow>(graph, "shadow buffer"), Usage::copy)};
        pass.run([=, &gpu](Execution& run) {
            ShadowPlan plan = plan_shadows(run.value(lights), run.value(metrics), settings);
            upload<gpu::Shadow>(gpu, run, out.shadows, plan.shadows);
            run.set(out.plan, std::move(plan));
        });
        return out;
    });
}

/// Of the map in this layer; none if no light uses it.
std::optional<DepthTerms> depth_terms(const ShadowPlan& plan, bool cubes, std::uint32_t layer) {
    const std::uint32_t map = cubes ? layer / cube_faces : layer;
    const auto found = std::ranges::find_if(plan.shadows, [&](const gpu::Shadow& shadow) {
        return shadow.kind != SHADOW_NONE && shadow.layer == map && (shadow.kind == SHADOW_CUBE) == cubes;
    });
    if (found == plan.shadows.end()) return std::nullopt;
    if (found->kind != SHADOW_ORTHOGRAPHIC) return perspective_terms(found->near_plane);
    const glm::mat4& clip = found->from_world;
    return linear_terms(1.0F / glm::length(glm::vec3(clip[0][2], clip[1][2], clip[2][2])));
}

}  // namespace

ShadowPlan plan_shadows(const LightTable& lights, const SceneMetrics& metrics,
                        const ShadowSettings& settings) {
    ShadowPlan plan;
    plan.shadows.assign(lights.entries.size(), no_shadow);
    const MapLengths lengths{.near_plane = std::max(relative_near_plane * metrics.radius(), 1e-9F),
                             .ray_offset = metrics.ray_offset()};
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
        if (cost > budget || no_layer) {
            ++plan.lights_without;
            continue;
        }
        budget -= cost;
        plan.shadows[i] = cube ? add_cube(plan, entry.light, lengths, settings.cube_resolution)
                               : add_map(plan, entry.light, shape, lengths, settings.map_resolution);
    }
    return plan;
}

ShadowMaps add_shadow_maps(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                           ValueHandle<LightTable> lights, ValueHandle<SceneMetrics> metrics,
                           const ShadowSettings& settings) {
    const PlannedShadows planned = add_shadow_plan(graph, gpu, lights, metrics, settings);
    return graph.add("shadow-maps", [&](Pass& pass) {
        const std::vector<ResourceHandle> surfaces = read_meshes(pass, scene);
        pass.read(planned.plan);
        pass.parameter(settings);
        const ShadowPrograms programs{
            .opaque = gpu.program({"lights/shadow_maps.vert"}),
            .masked = gpu.program({"surfaces/mesh_surface.vert", "surfaces/depth_prepass.frag"},
                                  {"MASKED", "SHADOW_MAP"})};
        const ShadowMaps out{
            .plan = planned.plan,
            .shadows = planned.shadows,
            .cubes = pass.update(graph.texture("shadow cubes", cube_desc(1, 1), Lifetime::persistent),
                                 Usage::layer_target),
            .maps = pass.update(graph.texture("shadow maps", map_desc(1, 1), Lifetime::persistent),
                                Usage::layer_target),
            .drawn = pass.update(graph.value<DrawnShadows>("drawn shadows"))};
        for (const bool cubes : {true, false}) {
            graph.note(cubes ? out.cubes : out.maps,
                       depth_note(planned.plan, [=](const ShadowPlan& drawn, std::uint32_t layer) {
                           return depth_terms(drawn, cubes, layer);
                       }));
        }
        pass.run([=, &gpu](Execution& run) {
            const auto due = due_views(run, run.changed(surfaces), out, settings);
            draw_views(gpu, run, {scene, out, settings, programs}, due);
        });
        return out;
    });
}

void read_shadow_maps(Pass& pass, const ShadowMaps& shadows) {
    pass.read(shadows.shadows, {Usage::storage, BINDING_SHADOWS});
    pass.read(shadows.cubes, {Usage::compared, UNIT_SHADOW_CUBES});
    pass.read(shadows.maps, {Usage::compared, UNIT_SHADOW_MAPS});
}

}  // namespace candela
