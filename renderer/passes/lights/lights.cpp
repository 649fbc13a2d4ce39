#include "renderer/passes/lights/lights.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"

namespace candela {

SceneLights add_lights(FrameGraph& graph, Gpu& gpu, const SceneData& scene, ValueHandle<SceneMetrics> metrics,
                       const std::optional<Sky>& sky, const ShadowSettings& settings, float scale) {
    const ValueHandle<LightTable> table = add_light_table(graph, gpu.scene_check(), metrics, sky);
    const ShadowMaps shadows = add_shadow_maps(graph, gpu, scene, table, metrics, settings, scale);
    return graph.add("light-upload", [&](Pass& pass) {
        pass.read(table);
        const SceneLights out{
            .table = table,
            .constants =
                pass.write(growing_buffer<gpu::LightConstants>(graph, "light constants"), Usage::copy),
            .buffer = pass.write(growing_buffer<gpu::Light>(graph, "light buffer"), Usage::copy),
            .shadows = shadows};
        pass.run([=, &gpu](Execution& run) {
            std::vector<gpu::Light> lights;
            for (const LightTable::Entry& entry : run.value(table).entries) {
                lights.push_back(entry.light);
            }
            const auto count = static_cast<std::uint32_t>(lights.size());
            upload_one(gpu, run, out.constants, gpu::LightConstants{.count = count});
            upload<gpu::Light>(gpu, run, out.buffer, lights);
        });
        return out;
    });
}

}  // namespace candela
