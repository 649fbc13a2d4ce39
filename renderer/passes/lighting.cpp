#include "renderer/passes/lighting.hpp"

#include <numbers>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {

LightBuffers add_light_upload(FrameGraph& graph, const Gpu& gpu, ValueHandle<LightTable> lights,
                              ValueHandle<ShadowPlan> plan) {
    return graph.add("light-upload", [&](Pass& pass) {
        pass.read(lights);
        pass.read(plan);
        const LightBuffers out{
            .lights =
                pass.write(graph.buffer<gpu::Light>("light buffer", 1, Lifetime::persistent), Usage::copy),
            .shadows =
                pass.write(graph.buffer<gpu::Shadow>("shadow buffer", 1, Lifetime::persistent), Usage::copy)};
        pass.run([=, &gpu](Execution& run) {
            const LightTable& table = run.value(lights);
            const ShadowPlan& shadows = run.value(plan);
            std::vector<gpu::Light> records;
            for (std::size_t i = 0; i < table.entries.size(); ++i) {
                records.push_back(table.entries[i].light);
                records.back().shadow = shadows.shadow_of_light[i];
            }
            upload<gpu::Light>(gpu, run, out.lights, records);
            upload<gpu::Shadow>(gpu, run, out.shadows, shadows.shadows);
        });
        return out;
    });
}

float vpl_radius2(float bound, std::uint32_t vpl_count, float area) {
    return 4.0F * area / (std::numbers::pi_v<float> * static_cast<float>(vpl_count) * bound);
}

std::vector<std::string> lighting_variant(const Lighting& lighting) {
    std::vector<std::string> words;
    if (lighting.lists) {
        words.emplace_back("LIGHT_LIST_CELLS");
    }
    if (lighting.lists && lighting.lists->kind == LightList::cluster) {
        words.emplace_back("LIGHT_LIST_PER_SURFACE");
    }
    if (lighting.vpl_maps) {
        words.emplace_back("VPL_VISIBILITY_MAPS");
    } else if (lighting.vpl_rays) {
        words.emplace_back("VPL_VISIBILITY_RAYS");
    }
    return words;
}

void read_lighting(Pass& pass, const Lighting& lighting) {
    pass.read(lighting.lights);
    pass.read(lighting.metrics);
    pass.read(lighting.buffers.lights, Usage::storage);
    pass.read(lighting.buffers.shadows, Usage::storage);
    pass.read(lighting.shadows.cubes, Usage::sampled);
    pass.read(lighting.shadows.maps, Usage::sampled);
    if (lighting.vpls) {
        pass.read(lighting.vpls->paths);
        pass.read(lighting.vpls->vpls, Usage::storage);
    }
    if (lighting.vpl_maps) {
        read_vpl_maps(pass, *lighting.vpl_maps);
    }
    if (lighting.vpl_rays) {
        read_tracing(pass, *lighting.vpl_rays);
    }
    if (lighting.lists) {
        read_light_lists(pass, *lighting.lists);
    }
    pass.parameter(lighting.show);
    pass.parameter(lighting.geometry_bound);
}

void bind_lighting(const Gpu& gpu, Execution& run, const gl::Program& program, const Lighting& lighting) {
    gpu.bind_storage(BINDING_LIGHTS, run.object(lighting.buffers.lights));
    gpu.bind_storage(BINDING_SHADOWS, run.object(lighting.buffers.shadows));
    gpu.gl().BindTextureUnit(UNIT_SHADOW_CUBES, run.object(lighting.shadows.cubes));
    gpu.gl().BindTextureUnit(UNIT_SHADOW_MAPS, run.object(lighting.shadows.maps));
    gpu.shadow_sampler().bind(UNIT_SHADOW_CUBES);
    gpu.shadow_sampler().bind(UNIT_SHADOW_MAPS);

    const auto lights = static_cast<std::uint32_t>(run.value(lighting.lights).entries.size());
    program.set("light_count", lighting.show == Show::indirect ? 0U : lights);
    if (lighting.lists) {
        bind_light_lists(gpu, run, program, *lighting.lists);
    }
    const bool indirect = lighting.vpls && lighting.show != Show::direct;
    const std::uint32_t vpls = indirect ? run.value(lighting.vpls->paths).vpl_count : 0U;
    program.set("vpl_count", vpls);
    if (vpls == 0) {
        return;
    }
    gpu.bind_storage(BINDING_VPLS, run.object(lighting.vpls->vpls));
    const SceneMetrics& metrics = run.value(lighting.metrics);
    program.set("vpl_radius2", vpl_radius2(lighting.geometry_bound, vpls, metrics.area));
    program.set("crease_slack", 16.0F * metrics.ray_offset());
    if (lighting.vpl_maps) {
        bind_vpl_maps(gpu, run, program, *lighting.vpl_maps, metrics);
    }
    if (lighting.vpl_rays) {
        bind_tracing(gpu, run, program, *lighting.vpl_rays);
        program.set("vpl_ray_offset", metrics.ray_offset());
    }
}

}  // namespace candela
