#include "renderer/passes/shading/lighting.hpp"

#include <fmt/format.h>
#include <algorithm>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/loop_parts.hpp"

namespace candela {

namespace {

std::uint32_t light_count(const LightTable& lights) {
    return static_cast<std::uint32_t>(lights.entries.size());
}

bool is_sun_with_shadow(const LightTable::Entry& entry) {
    return entry.casts_shadow && entry.light.kind == LIGHT_DIRECTIONAL;
}

}  // namespace

LightBuffers add_light_upload(FrameGraph& graph, const Gpu& gpu, ValueHandle<LightTable> lights,
                              ValueHandle<ShadowPlan> plan) {
    return graph.add("light-upload", [&](Pass& pass) {
        pass.read(lights);
        pass.read(plan);
        const LightBuffers out{
            .constants = pass.write(
                graph.buffer<gpu::LightConstants>("light constants", 1, Lifetime::persistent), Usage::copy),
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
            upload_one(gpu, run, out.constants, gpu::LightConstants{.count = light_count(table)});
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
        words.push_back(fmt::format("MOST_VPLS={}",
                                    std::min(max_vpls_per_invocation(*lighting.vpls), lighting.most_vpls)));
    }
    if (!shows_direct(lighting.show)) {
        words.emplace_back("DIRECT_HIDDEN");
    }
    if (lighting.show == Show::irradiance) {
        words.emplace_back("SHOW_IRRADIANCE");
    } else if (lighting.show == Show::albedo) {
        words.emplace_back("SHOW_ALBEDO");
    } else if (lighting.show == Show::normals) {
        words.emplace_back("SHOW_NORMALS");
    }
    if (lighting.shadow_rays) {
        words.emplace_back("SHADOW_RAYS");
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
    pass.parameter(lighting.show);
    pass.parameter(lighting.most_vpls);
    if (!shows_light(lighting.show)) {
        return;
    }
    pass.read(lighting.buffers.constants, {Usage::uniform, UNIFORMS_LIGHTS});
    pass.read(lighting.buffers.lights, {Usage::storage, BINDING_LIGHTS});
    pass.read(lighting.buffers.shadows, {Usage::storage, BINDING_SHADOWS});
    pass.read(lighting.shadows.cubes, {Usage::compared, UNIT_SHADOW_CUBES});
    pass.read(lighting.shadows.maps, {Usage::compared, UNIT_SHADOW_MAPS});
    if (lighting.shadow_rays) {
        read_tracing(pass, *lighting.shadow_rays);
    }
    if (lighting.vpls) {
        read_vpl_light(pass, *lighting.vpls);
    }
    if (lighting.indirect) {
        pass.read(*lighting.indirect, {Usage::sampled, UNIT_INDIRECT});
    }
    if (lighting.lists) {
        read_light_lists(pass, *lighting.lists);
    }
}

std::vector<gl::Uniforms> lighting_parts(const Execution& run, const Lighting& lighting) {
    constexpr std::int64_t few_suns = 8;
    const LightTable& lights = run.value(lighting.lights);
    const bool many_rays =
        lighting.shadow_rays && std::ranges::count_if(lights.entries, is_sun_with_shadow) > few_suns;
    return loop_parts(shows_direct(lighting.show) ? light_count(lights) : 0, many_rays ? 8 : 8192);
}

}  // namespace candela
