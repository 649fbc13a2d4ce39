#include "renderer/configuration/build_frame.hpp"

#include <algorithm>

#include "renderer/passes/indirect/vpl_gather.hpp"
#include "renderer/passes/indirect/vpl_reconstruct.hpp"
#include "renderer/passes/lights/light_lists.hpp"
#include "renderer/passes/output/accumulate.hpp"
#include "renderer/passes/output/tone_map.hpp"
#include "renderer/passes/shading/deferred.hpp"
#include "renderer/passes/shading/forward.hpp"
#include "renderer/passes/shading/transparent.hpp"
#include "renderer/passes/surfaces/depth_prepass.hpp"
#include "renderer/passes/surfaces/gbuffer.hpp"
#include "renderer/passes/view/view_cull.hpp"
#include "renderer/passes/vpls/surfel_light.hpp"
#include "renderer/passes/vpls/vpl_maps.hpp"

namespace candela {
namespace {

/// Most VPLs that a blended surface evaluates where solid surfaces are interleaved. With fewer, the pattern
/// of which pixel evaluates which VPLs would be visible.
constexpr std::uint32_t most_vpls_of_blended = 1024;

std::optional<TextureHandle> depth_of(const std::optional<VisibleSurfaces>& surfaces) {
    return surfaces ? std::optional(surfaces->depth) : std::nullopt;
}

}  // namespace

FrameHandles build_frame(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                         const FrameExtent& extent) {
    const glm::uvec2 size = extent.size;
    FrameHandles frame;
    frame.request = graph.import_value<ViewRequest>("view request");
    frame.target = graph.texture("target", {extent.target, Format::rgba8}, Lifetime::imported);

    const SceneData scene = add_scene_upload(graph, gpu);
    const Tracing tracing = add_bvh(graph, gpu, scene);
    frame.metrics = tracing.metrics;
    frame.lights = add_lights(graph, tracing.metrics);

    const ShadowMaps shadows =
        add_shadow_maps(graph, gpu, scene, frame.lights, frame.metrics, configuration.shadows);
    frame.shadows = shadows.plan;
    frame.drawn_shadows = shadows.drawn;
    const LightBuffers buffers = add_light_upload(graph, gpu, frame.lights, shadows.plan);
    const SceneLights scene_lights{frame.lights, buffers.lights};
    ValueHandle<CameraView> camera = add_view(graph, frame.request);
    if (configuration.refinement.enabled) {
        frame.refinement_clock = graph.import_value<RefinementClock>("refinement clock");
        frame.refinement = add_refinement(graph, *frame.refinement_clock, scene, frame.lights, camera);
        camera = add_refined_view(graph, frame.request, *frame.refinement);
    }
    const FrameView view = add_view_upload(graph, gpu, camera, size);
    const SceneData seen = add_view_cull(graph, gpu, scene, camera);
    std::optional<MappedVpls> mapped;
    if (configuration.indirect && configuration.vpls.placement == VplPlacement::surfels) {
        frame.epoch = graph.import_value<std::uint64_t>("scene epoch");
        const ValueHandle<SceneMotion> motion = add_scene_motion(graph, scene, *frame.epoch);
        const Surfels surfels = add_surfels(graph, gpu, scene, frame.refinement, configuration.vpls);
        const SurfelVisibility visibility = add_surfel_visibility(graph, gpu, tracing, surfels, motion);
        frame.vpls =
            add_surfel_light(graph, gpu, tracing, visibility, scene_lights, configuration.vpls.bounces);
        mapped = MappedVpls{surfels.plan, surfels.surfels, motion, surfels.set};
    } else if (configuration.indirect) {
        const ValueHandle<VplPlan> plan =
            add_vpl_paths(graph, frame.metrics, frame.lights, frame.refinement, configuration.vpls);
        frame.vpls = add_vpl_trace(graph, gpu, tracing, plan, buffers.lights);
        mapped = MappedVpls{plan, frame.vpls->vpls, {}, {}};
    }
    std::optional<VplLight> vpl_light;
    if (frame.vpls) {
        vpl_light =
            VplLight{.vpls = *frame.vpls,
                     .common = add_vpl_constants(graph, gpu, frame.metrics, frame.vpls->plan,
                                                 configuration.visibility, configuration.geometry_bound)};
        if (configuration.visibility.method == VplVisibility::maps) {
            vpl_light->maps = add_vpl_maps(graph, gpu, tracing, *mapped, vpl_light->common);
        } else if (configuration.visibility.method == VplVisibility::rays) {
            vpl_light->rays = tracing;
        }
    }
    const bool shows_indirect = vpl_light && configuration.show != Show::direct;
    if (!shows_indirect) {
        frame.vpls.reset();  // nothing reads them: their passes are culled
    }
    frame.interleave =
        shows_indirect
            ? std::max(interleaving(configuration.interleave, configuration.vpls.count, extent.target),
                       extent.least_interleave)
            : 1;

    // VPLs are also gathered without interleaving if they are too many for one loop of the shading pass.
    const bool gathers =
        shows_indirect && (frame.interleave > 1 || configuration.vpls.count > most_asked(*vpl_light));

    // Visible surfaces that are found before shading.
    const ShadingPathInfo& path = info_of(configuration.path);
    std::optional<VisibleSurfaces> visible;
    std::optional<Gbuffer> gbuffer;
    if (path.surfaces == SurfaceStage::gbuffer) {
        gbuffer = add_gbuffer(graph, gpu, seen, view);
        visible = {gbuffer->depth, gbuffer->normal};
    } else if (path.surfaces == SurfaceStage::forward_after_prepass || gathers) {
        visible = add_depth_prepass(graph, gpu, seen, view);
    }
    const bool bounds_lists = path.surfaces != SurfaceStage::forward;

    if (path.lights == LightList::tile) {
        const LightGrid grid = add_tile_grid(graph, gpu, size, configuration.lists);
        frame.lists = add_light_tiles(graph, gpu, {scene_lights, view, grid},
                                      bounds_lists ? depth_of(visible) : std::nullopt);
    } else if (path.lights == LightList::cluster) {
        const LightGrid grid = add_cluster_grid(graph, gpu, camera, frame.metrics, size, configuration.lists);
        frame.lists = add_light_clusters(graph, gpu, {scene_lights, view, grid});
    }

    Lighting lighting{.lights = frame.lights,
                      .buffers = buffers,
                      .shadows = shadows,
                      .vpls = shows_indirect ? vpl_light : std::nullopt,
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
        of_blended.lists = add_blended_light_tiles(graph, gpu, frame.lists->inputs, scene.layout);
    }

    if (gathers) {
        const GatheredVpls gathered =
            add_vpl_gather(graph, gpu, *visible, *vpl_light, view, frame.interleave);
        lighting.indirect = gathered.irradiance;
        if (frame.interleave > 1) {
            frame.indirect = add_vpl_reconstruct(graph, gpu, *visible, gathered, *vpl_light, view);
            lighting.indirect = frame.indirect->irradiance;
        }
        lighting.vpls.reset();
    }

    const ShadedSurfaces solid =
        gbuffer ? ShadedSurfaces{add_deferred(graph, gpu, *gbuffer, lighting, view), gbuffer->depth}
                : add_forward(graph, gpu, seen, lighting, view, depth_of(visible));
    TextureHandle radiance = add_transparent(graph, gpu, seen, of_blended, view, solid);
    if (frame.refinement) {
        radiance = add_accumulate(graph, gpu, radiance, *frame.refinement, size);
    }
    add_tone_map(graph, gpu, radiance, frame.target, extent.target, configuration.tone_map);
    return frame;
}

}  // namespace candela
