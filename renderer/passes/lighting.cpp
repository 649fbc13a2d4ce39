#include "renderer/passes/lighting.hpp"

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

std::vector<std::string> lighting_variant(const Lighting& lighting) {
    std::vector<std::string> words =
        lighting.vpls ? vpl_light_variant(*lighting.vpls) : std::vector<std::string>{};
    if (lighting.indirect) {
        words.emplace_back("INDIRECT_IRRADIANCE");
    }
    if (lighting.lists) {
        words.emplace_back("LIGHT_LIST_CELLS");
    }
    if (lighting.lists && lighting.lists->kind == LightList::cluster) {
        words.emplace_back("LIGHT_LIST_PER_SURFACE");
    }
    return words;
}

void read_lighting(Pass& pass, const Lighting& lighting) {
    pass.read(lighting.lights);
    pass.read(lighting.buffers.lights, Usage::storage);
    pass.read(lighting.buffers.shadows, Usage::storage);
    pass.read(lighting.shadows.cubes, Usage::sampled);
    pass.read(lighting.shadows.maps, Usage::sampled);
    if (lighting.vpls) {
        read_vpl_light(pass, *lighting.vpls);
    }
    if (lighting.indirect) {
        pass.read(*lighting.indirect, Usage::sampled);
    }
    if (lighting.lists) {
        read_light_lists(pass, *lighting.lists);
    }
    pass.parameter(lighting.show);
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
    if (lighting.indirect) {
        gpu.gl().BindTextureUnit(UNIT_INDIRECT, run.object(*lighting.indirect));
    } else if (lighting.vpls && lighting.show != Show::direct) {
        bind_vpl_light(gpu, run, program, *lighting.vpls);
    } else {
        program.set("vpl_count", 0U);
    }
}

}  // namespace candela
