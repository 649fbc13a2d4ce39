#include "renderer/configuration/build_frame.hpp"

#include "renderer/passes/accumulate.hpp"
#include "renderer/passes/deferred.hpp"
#include "renderer/passes/depth_prepass.hpp"
#include "renderer/passes/forward.hpp"
#include "renderer/passes/gbuffer.hpp"
#include "renderer/passes/light_lists.hpp"
#include "renderer/passes/transparent.hpp"

namespace candela {

FrameHandles build_frame(FrameGraph& graph, Gpu& gpu, const Configuration& configuration, glm::uvec2 size) {
    FrameHandles frame;
    frame.request = graph.import_value<ViewRequest>("view request");
    frame.target = graph.texture("target", {size, Format::rgba8}, Lifetime::imported);

    const SceneData scene = add_scene_upload(graph, gpu);
    const Tracing tracing = add_bvh(graph, gpu, scene);
    frame.metrics = tracing.metrics;
    frame.lights = add_lights(graph, tracing.metrics);

    const ShadowMaps shadows =
        add_shadow_maps(graph, gpu, scene, frame.lights, frame.metrics, configuration.shadows);
    frame.shadows = shadows.plan;
    frame.drawn_shadows = shadows.drawn;
    const LightBuffers buffers = add_light_upload(graph, gpu, frame.lights, shadows.plan);
    const ValueHandle<CameraView> view = add_view(graph, frame.request);
    if (configuration.indirect && configuration.refinement.enabled) {
        frame.refinement_clock = graph.import_value<RefinementClock>("refinement clock");
        frame.refinement = add_refinement(graph, *frame.refinement_clock, scene, frame.lights, view);
    }
    if (configuration.indirect) {
        DueVpls due{
            .paths = add_vpl_paths(graph, frame.metrics, frame.lights, frame.refinement, configuration.vpls),
            .records = vpl_records(graph)};
        if (configuration.vpls.budget > 0) {
            frame.vpl_clock = graph.import_value<VplClock>("vpl clock");
            due = add_vpl_refresh(graph, gpu, scene, tracing,
                                  {due, frame.lights, buffers.lights, *frame.vpl_clock}, configuration.vpls,
                                  configuration.visibility.method == VplVisibility::maps);
        }
        frame.vpls = add_vpl_trace(graph, gpu, tracing, due, buffers.lights);
    }
    std::optional<VplMaps> vpl_maps;
    if (frame.vpls && configuration.visibility.method == VplVisibility::maps) {
        vpl_maps = add_vpl_maps(graph, gpu, tracing, *frame.vpls, configuration.visibility);
    }
    std::optional<Tracing> vpl_rays;
    if (frame.vpls && configuration.visibility.method == VplVisibility::rays) {
        vpl_rays = tracing;
    }

    // The surfaces, as far as they are found before they are shaded.
    const PathParts path = parts_of(configuration.path);
    std::optional<TextureHandle> depth;
    std::optional<Gbuffer> gbuffer;
    if (path.surface == SurfaceStage::gbuffer) {
        gbuffer = add_gbuffer(graph, gpu, scene, view, size);
        depth = gbuffer->depth;
    } else if (path.surface == SurfaceStage::forward_after_prepass) {
        depth = add_depth_prepass(graph, gpu, scene, view, size);
    }

    if (path.list == LightList::tile) {
        frame.lists =
            add_light_tiles(graph, gpu, frame.lights, buffers.lights, view, depth, size, configuration.lists);
    } else if (path.list == LightList::cluster) {
        frame.lists = add_light_clusters(graph, gpu, frame.lights, buffers.lights, view, frame.metrics, size,
                                         configuration.lists);
    }

    const Lighting lighting{.lights = frame.lights,
                            .metrics = frame.metrics,
                            .buffers = buffers,
                            .shadows = shadows,
                            .vpls = frame.vpls,
                            .vpl_maps = vpl_maps,
                            .vpl_rays = vpl_rays,
                            .lists = frame.lists,
                            .show = configuration.show,
                            .geometry_bound = configuration.geometry_bound};
    // Blended surfaces lie in front of what bounds the lists in depth.
    Lighting unbounded = lighting;
    if (path.list == LightList::tile && depth) {
        unbounded.lists = add_blended_light_tiles(graph, gpu, frame.lights, buffers.lights, view,
                                                  scene.layout, size, configuration.lists);
    }

    const ShadedSurfaces solid =
        gbuffer ? ShadedSurfaces{add_deferred(graph, gpu, *gbuffer, lighting, view, size), gbuffer->depth}
                : add_forward(graph, gpu, scene, lighting, view, depth, size);
    TextureHandle radiance = add_transparent(graph, gpu, scene, unbounded, view, solid, size);
    if (frame.refinement) {
        radiance = add_accumulate(graph, gpu, radiance, *frame.refinement, size);
    }
    add_tone_map(graph, gpu, radiance, frame.target, size, configuration.tone_map);
    return frame;
}

}  // namespace candela
