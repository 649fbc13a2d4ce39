#include "renderer/configuration/build_frame.hpp"

#include <algorithm>

#include <candela/scene/hierarchy.hpp>
#include "renderer/passes/indirect/vpl_gather.hpp"
#include "renderer/passes/indirect/vpl_reconstruct.hpp"
#include "renderer/passes/lights/light_lists.hpp"
#include "renderer/passes/output/accumulate.hpp"
#include "renderer/passes/output/tone_map.hpp"
#include "renderer/passes/shading/deferred.hpp"
#include "renderer/passes/shading/emission.hpp"
#include "renderer/passes/shading/forward.hpp"
#include "renderer/passes/shading/transparent.hpp"
#include "renderer/passes/sky/background.hpp"
#include "renderer/passes/sky/sky_vpls.hpp"
#include "renderer/passes/surfaces/depth_prepass.hpp"
#include "renderer/passes/surfaces/gbuffer.hpp"
#include "renderer/passes/surfels/surfel_light.hpp"
#include "renderer/passes/view/view_cull.hpp"
#include "renderer/passes/vpls/vpl_maps.hpp"

namespace candela {
namespace {

/// Most VPLs that a blended surface evaluates where solid surfaces are interleaved. With fewer, the pattern
/// of which pixel evaluates which VPLs would be visible.
constexpr std::uint32_t most_vpls_of_blended = 1024;

/// The scene and what lights it, independent of the view.
struct LitScene {
    SceneData scene;
    Tracing tracing;
    LightBuffers buffers;
    SceneLights lights;
    ShadowMaps shadows;
    std::optional<Sky> sky;
};

LitScene add_scene(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                   const FrameContents& contents, FrameHandles& frame) {
    const SceneData scene = add_scene_upload(graph, gpu);
    const Tracing tracing = add_bvh(graph, gpu, scene);
    frame.metrics = tracing.metrics;
    std::optional<Sky> sky;
    if (contents.sky) {
        sky = add_sky(graph, gpu.scene_check(), sky_patches(configuration.vpls.count));
    }
    frame.lights = add_lights(graph, gpu.scene_check(), tracing.metrics, sky);
    const ShadowMaps shadows =
        add_shadow_maps(graph, gpu, scene, frame.lights, frame.metrics, configuration.shadows);
    frame.shadows = shadows.plan;
    frame.drawn_shadows = shadows.drawn;
    const LightBuffers buffers = add_light_upload(graph, gpu, frame.lights, shadows.plan);
    return {.scene = scene,
            .tracing = tracing,
            .buffers = buffers,
            .lights = {frame.lights, buffers.lights},
            .shadows = shadows,
            .sky = sky};
}

ValueHandle<CameraView> add_camera(FrameGraph& graph, const Configuration& configuration, const LitScene& lit,
                                   FrameHandles& frame) {
    const ValueHandle<CameraView> camera = add_view(graph, frame.request);
    if (!configuration.refinement.enabled) {
        return camera;
    }
    const auto environment = lit.sky ? std::optional(lit.sky->environment) : std::nullopt;
    frame.refinement_clock = graph.import_value<RefinementClock>("refinement clock");
    frame.refinement =
        add_refinement(graph, *frame.refinement_clock, lit.scene, {frame.lights, environment}, camera);
    return add_refined_view(graph, frame.request, *frame.refinement);
}

/// The configured VPLs, if any is needed. The light of the sky and of surfaces that emit it is direct light,
/// but VPLs carry it. Where there is such light, the VPLs are the same whatever of it is shown, so that
/// direct and indirect light add up to the total: which pixels evaluate which VPLs depends on all of them.
struct WantedVpls {
    VplSettings settings;
    ShownLight shown;
    std::uint32_t count = 0;  ///< about how many there will be

    [[nodiscard]] bool any() const { return shown.emitted || shown.reflected; }
};

WantedVpls wanted_vpls(const Configuration& configuration, const FrameContents& contents) {
    const bool has_emission = contents.emitters || contents.sky;
    WantedVpls wanted{configuration.vpls,
                      {.emitted = has_emission && configuration.show != Show::indirect,
                       .reflected = configuration.indirect && configuration.show != Show::direct}};
    if (has_emission) {
        wanted.settings.placement = VplPlacement::surfels;
    }
    if (!configuration.indirect) {
        wanted.settings.bounces = 0;
    }
    wanted.count = configuration.indirect ? wanted.settings.count : 0;
    wanted.count += contents.emitters ? emitting_surfels(wanted.settings.count) : 0;
    wanted.count += contents.sky ? sky_patches(wanted.settings.count) : 0;
    return wanted;
}

/// Places VPLs and finds their light. Returns what their depth maps are made of.
MappedVpls place_vpls(FrameGraph& graph, Gpu& gpu, const WantedVpls& wanted, const LitScene& lit,
                      FrameHandles& frame) {
    const VplSettings& settings = wanted.settings;
    if (settings.placement == VplPlacement::paths) {
        const ValueHandle<VplPlan> plan =
            add_vpl_paths(graph, frame.metrics, frame.lights, frame.refinement, settings);
        frame.vpls = add_vpl_trace(graph, gpu, lit.tracing, plan, lit.buffers.lights);
        return {plan, frame.vpls->vpls, {}, {}};
    }
    frame.epoch = graph.import_value<std::uint64_t>("scene epoch");
    const ValueHandle<SceneMotion> motion = add_scene_motion(graph, lit.scene, *frame.epoch);
    const Surfels surfels = add_surfels(graph, gpu, lit.scene, frame.refinement, settings);
    const SurfelVisibility visibility = add_surfel_visibility(graph, gpu, lit.tracing, surfels, motion);
    SurfelSources sources{.lights = lit.lights, .sky = {}};
    if (lit.sky) {
        sources.sky = add_sky_patches(graph, gpu, *lit.sky, frame.refinement);
    }
    frame.vpls =
        add_surfel_light(graph, gpu, lit.tracing, visibility, sources, settings.bounces, wanted.shown);
    return {surfels.plan, surfels.surfels, motion, surfels.set};
}

/// The light of the wanted VPLs, if any.
std::optional<VplLight> add_vpls(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                                 const WantedVpls& wanted, const FrameContents& contents, const LitScene& lit,
                                 FrameHandles& frame) {
    if (!wanted.any()) {
        return std::nullopt;
    }
    const MappedVpls mapped = place_vpls(graph, gpu, wanted, lit, frame);
    VplLight light{.vpls = *frame.vpls,
                   .common = add_vpl_constants(graph, gpu, frame.metrics, frame.vpls->plan,
                                               configuration.visibility, configuration.geometry_bound),
                   .emitters = contents.emitters,
                   .sky = contents.sky};
    if (configuration.visibility.method == VplVisibility::maps) {
        light.maps = add_vpl_maps(graph, gpu, lit.tracing, mapped, light.common);
        if (light.emitters || light.sky) {
            light.rays = lit.tracing;
        }
    } else if (configuration.visibility.method == VplVisibility::rays) {
        light.rays = lit.tracing;
    }
    return light;
}

/// Surfaces that are found before they are shaded, if any.
struct FoundSurfaces {
    std::optional<VisibleSurfaces> visible;
    std::optional<Gbuffer> gbuffer;

    [[nodiscard]] std::optional<TextureHandle> depth() const {
        return visible ? std::optional(visible->depth) : std::nullopt;
    }
};

/// `needed`: by a pass other than that which shades.
FoundSurfaces find_surfaces(FrameGraph& graph, Gpu& gpu, SurfaceStage stage, const SceneData& seen,
                            const FrameView& view, bool needed) {
    if (stage == SurfaceStage::gbuffer) {
        const Gbuffer gbuffer = add_gbuffer(graph, gpu, seen, view);
        return {VisibleSurfaces{gbuffer.depth, gbuffer.normal}, gbuffer};
    }
    if (stage == SurfaceStage::forward_after_prepass || needed) {
        return {add_depth_prepass(graph, gpu, seen, view), {}};
    }
    return {};
}

/// The light lists of the shading path; none if each surface evaluates all lights. `depth` bounds tiles.
std::optional<LightLists> add_lists(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                                    const LitScene& lit, const FrameView& view,
                                    std::optional<TextureHandle> depth) {
    switch (info_of(configuration.path).lights) {
        case LightList::all:
            break;
        case LightList::tile: {
            const LightGrid grid = add_tile_grid(graph, gpu, view.size, configuration.lists);
            return add_light_tiles(graph, gpu, {lit.lights, view, grid}, depth);
        }
        case LightList::cluster: {
            const LightGrid grid = add_cluster_grid(graph, gpu, view.camera, lit.tracing.metrics, view.size,
                                                    configuration.lists);
            return add_light_clusters(graph, gpu, {lit.lights, view, grid});
        }
    }
    return std::nullopt;
}

/// Irradiance that is gathered from the VPLs before surfaces are shaded.
TextureHandle gather_vpls(FrameGraph& graph, Gpu& gpu, const VisibleSurfaces& visible, const VplLight& light,
                          const FrameView& view, FrameHandles& frame) {
    const GatheredVpls gathered = add_vpl_gather(graph, gpu, visible, light, view, frame.interleave);
    if (frame.interleave == 1) {
        return gathered.irradiance;
    }
    frame.indirect = add_vpl_reconstruct(graph, gpu, visible, gathered, light, view);
    return frame.indirect->irradiance;
}

}  // namespace

WorldContents contents_of(const World& world, SceneCheck& check) {
    WorldContents contents;
    const auto is_placed = [&](Entity entity) {
        contents.depend_on_transforms = true;
        return check.accepts_at(world, entity, world_matrix(world, entity));
    };
    FrameContents& of_frame = contents.of_frame;
    for (const auto& [entity, instance] : world.view<MeshInstance>()) {
        of_frame.emitters =
            check.accepts(world, entity, instance) && emits(*instance.mesh) && is_placed(entity);
        if (of_frame.emitters) {
            break;
        }
    }
    const Environment environment = accepted_environment(world, check);
    of_frame.sky = environment.radiance != glm::vec3(0.0F);
    of_frame.suns = environment.picture != nullptr;
    for (const auto& [entity, light] : world.view<DirectionalLight>()) {
        if (check.accepts(world, entity, light) && light.casts_shadow) {
            of_frame.suns |= is_placed(entity);
        }
    }
    return contents;
}

FrameHandles build_frame(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                         const FrameExtent& extent, const FrameContents& contents) {
    FrameHandles frame;
    frame.request = graph.import_value<ViewRequest>("view request");
    frame.target = graph.texture("target", {extent.target, Format::rgba8}, Lifetime::imported);

    const LitScene lit = add_scene(graph, gpu, configuration, contents, frame);
    const ValueHandle<CameraView> camera = add_camera(graph, configuration, lit, frame);
    const FrameView view = add_view_upload(graph, gpu, camera, extent.size);
    const SceneData seen = add_view_cull(graph, gpu, lit.scene, camera);

    const WantedVpls wanted = wanted_vpls(configuration, contents);
    const std::uint32_t vpl_count = wanted.count;
    const std::optional<VplLight> vpls = add_vpls(graph, gpu, configuration, wanted, contents, lit, frame);
    if (vpls) {
        frame.interleave = std::max(interleaving(configuration.interleave, vpl_count, extent.target),
                                    extent.least_interleave);
    }
    // VPLs are also gathered without interleaving if they are too many for one loop of the shading pass.
    const bool gathers = vpls && (frame.interleave > 1 || vpl_count > most_asked(*vpls));

    const ShadingPathInfo& path = info_of(configuration.path);
    const FoundSurfaces found = find_surfaces(graph, gpu, path.surfaces, seen, view, gathers);
    const bool bounds_lists = path.surfaces != SurfaceStage::forward;
    frame.lists =
        add_lists(graph, gpu, configuration, lit, view, bounds_lists ? found.depth() : std::nullopt);

    Lighting lighting{.lights = frame.lights,
                      .buffers = lit.buffers,
                      .shadows = lit.shadows,
                      .sun_rays = contents.suns && configuration.shadows.enabled ? std::optional(lit.tracing)
                                                                                 : std::nullopt,
                      .vpls = vpls,
                      .lists = frame.lists,
                      .show = configuration.show};
    // Blended surfaces evaluate VPLs while they are shaded, because the gathered irradiance is that of the
    // solid surface at the pixel. They lie in front of the depths that bound the light lists, so they get
    // lists without depth bounds.
    Lighting of_blended = lighting;
    if (frame.interleave > 1) {
        of_blended.most_vpls = most_vpls_of_blended;
    }
    if (path.lights == LightList::tile && bounds_lists) {
        of_blended.lists = add_blended_light_tiles(graph, gpu, frame.lists->inputs, lit.scene.layout);
    }
    if (gathers) {
        lighting.indirect = gather_vpls(graph, gpu, *found.visible, *vpls, view, frame);
        lighting.vpls.reset();
    }

    ShadedSurfaces solid =
        found.gbuffer
            ? ShadedSurfaces{add_deferred(graph, gpu, *found.gbuffer, lighting, view), found.gbuffer->depth}
            : add_forward(graph, gpu, seen, lighting, view, found.depth());
    const bool shows_emitters = contents.emitters && configuration.show != Show::indirect;
    if (shows_emitters) {
        solid.radiance = add_emission(graph, gpu, seen, view, solid);
    }
    if (lit.sky && configuration.show != Show::indirect) {
        solid.radiance = add_background(graph, gpu, *lit.sky, view, solid);
    }
    TextureHandle radiance = add_transparent(graph, gpu, seen, of_blended, view, solid, shows_emitters);
    if (frame.refinement) {
        radiance = add_accumulate(graph, gpu, radiance, *frame.refinement, extent.size);
    }
    add_tone_map(graph, gpu, radiance, frame.target, extent.target, configuration.tone_map);
    return frame;
}

}  // namespace candela
