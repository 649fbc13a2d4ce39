#include "renderer/passes/shading/lighting.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/loop_parts.hpp"
#include "shaders/bindings.glsl"

namespace candela {

namespace {

std::uint32_t light_count(const LightTable& lights) {
    return static_cast<std::uint32_t>(lights.entries.size());
}

}  // namespace

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
    if (!shows_direct(lighting.show)) words.emplace_back("DIRECT_HIDDEN");
    if (lighting.show == Show::irradiance) {
        words.emplace_back("SHOW_IRRADIANCE");
    } else if (lighting.show == Show::albedo) {
        words.emplace_back("SHOW_ALBEDO");
    } else if (lighting.show == Show::normals) {
        words.emplace_back("SHOW_NORMALS");
    } else if (lighting.show == Show::roughness) {
        words.emplace_back("SHOW_ROUGHNESS");
    } else if (lighting.show == Show::metalness) {
        words.emplace_back("SHOW_METALNESS");
    }
    for (std::string& word : material_variant(lighting.materials)) words.push_back(std::move(word));
    if (lighting.vpls && lighting.materials.bumpy) words.emplace_back("DIRECTED");
    if (lighting.indirect) words = gathered_variant(*lighting.indirect, std::move(words));
    if (lighting.mirror_rays) words.emplace_back("MIRROR_RAYS");
    if (lighting.shadow_rays) words.emplace_back("SHADOW_RAYS");
    if (lighting.lists) words.emplace_back("LIGHT_LIST_CELLS");
    if (lighting.lists && lighting.lists->kind == LightList::cluster) {
        words.emplace_back("LIGHT_LIST_PER_SURFACE");
    }
    return words;
}

void bind_lighting(Gpu& gpu, const Lighting& lighting) {
    if (lighting.materials.glossy) gpu.mirror_shares().bind(UNIT_MIRROR_SHARES);
}

void read_lighting(Pass& pass, const Lighting& lighting) {
    pass.read(lighting.lights.table);
    pass.parameter(lighting.show);
    pass.parameter(lighting.most_vpls);
    if (!shows_light(lighting.show)) return;
    pass.read(lighting.lights.constants, {Usage::uniform, UNIFORMS_LIGHTS});
    pass.read(lighting.lights.buffer, {Usage::storage, BINDING_LIGHTS});
    read_shadow_maps(pass, lighting.lights.shadows);
    if (lighting.shadow_rays) read_tracing(pass, *lighting.shadow_rays);
    if (lighting.vpls) read_vpl_light(pass, *lighting.vpls);
    if (lighting.indirect) read_gathered(pass, *lighting.indirect);
    if (lighting.lists) read_light_lists(pass, *lighting.lists);
}

std::vector<gl::Uniforms> lighting_parts(const Execution& run, const Lighting& lighting) {
    constexpr std::uint32_t few = MOST_SHADOW_RAYS / 4;  // an invocation shades up to four surfaces
    constexpr std::uint32_t most_parts = 64;
    const LightTable& lights = run.value(lighting.lights.table);
    const std::uint32_t count = shows_direct(lighting.show) ? light_count(lights) : 0;
    const bool many_rays =
        lighting.shadow_rays && std::ranges::count_if(lights.entries, &LightTable::Entry::casts_shadow) > few;
    return loop_parts(count, many_rays ? std::clamp(count / most_parts, few, 8192U) : 8192U);
}

}  // namespace candela
