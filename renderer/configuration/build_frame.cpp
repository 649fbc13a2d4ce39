#include "renderer/configuration/build_frame.hpp"

#include "renderer/passes/deferred.hpp"
#include "renderer/passes/forward.hpp"
#include "renderer/passes/gbuffer.hpp"

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
    const LightBuffers buffers = add_light_upload(graph, gpu, frame.lights, shadows.plan);
    if (configuration.indirect) {
        frame.vpls = add_vpl_trace(graph, gpu, tracing, frame.lights, buffers.lights, configuration.vpls);
    }
    const Lighting lighting{.lights = frame.lights,
                            .metrics = frame.metrics,
                            .buffers = buffers,
                            .shadows = shadows,
                            .vpls = frame.vpls,
                            .show = configuration.show,
                            .geometry_bound = configuration.geometry_bound};

    const ValueHandle<CameraView> view = add_view(graph, frame.request);
    TextureHandle radiance;
    if (configuration.path == ShadingPath::forward) {
        radiance = add_forward(graph, gpu, scene, lighting, view, size);
    } else {
        const Gbuffer gbuffer = add_gbuffer(graph, gpu, scene, view, size);
        radiance = add_deferred(graph, gpu, gbuffer, lighting, view, size);
    }
    add_tone_map(graph, gpu, radiance, frame.target, size, configuration.tone_map);
    return frame;
}

}  // namespace candela
