#include "renderer/passes/lighting.hpp"

#include <algorithm>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {

namespace {

std::uint32_t shown_lights(const Execution& run, const Lighting& lighting) {
    const std::size_t lights = run.value(lighting.lights).entries.size();
    return lighting.show == Show::indirect ? 0U : static_cast<std::uint32_t>(lights);
}

/// Stride at which VPLs are evaluated if they are too many. Odd, so that all bounces are evaluated equally
/// often: paths often have an even number of VPLs.
std::uint32_t vpl_stride(std::uint32_t vpl_count, std::uint32_t most) {
    return vpl_count <= most ? 1 : (vpl_count + most - 1) / most | 1U;
}

}  // namespace

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
    } else if (lighting.vpls) {
        words.emplace_back("VPLS");
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

    program.set("light_count", shown_lights(run, lighting));
    begin_lighting_part(program, 0);
    if (lighting.lists) {
        bind_light_lists(gpu, run, program, *lighting.lists);
    }
    if (lighting.indirect) {
        gpu.gl().BindTextureUnit(UNIT_INDIRECT, run.object(*lighting.indirect));
    } else if (lighting.vpls) {
        bind_vpl_light(gpu, run, program, *lighting.vpls);
        const std::uint32_t vpls = run.value(lighting.vpls->vpls.plan).vpl_count;
        const std::uint32_t most = std::min(most_asked(*lighting.vpls), lighting.most_vpls);
        program.set("vpl_stride", lighting.show == Show::direct ? 0U : vpl_stride(vpls, most));
    }
}

std::uint32_t lighting_parts(const Execution& run, const Lighting& lighting) {
    return std::max((shown_lights(run, lighting) + most_visited - 1) / most_visited, 1U);
}

void begin_lighting_part(const gl::Program& program, std::uint32_t part) {
    program.set("lights_before", part * most_visited);
    program.set("lights_now", most_visited);
}

}  // namespace candela
