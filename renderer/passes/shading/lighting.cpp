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

/// Iterations that a light takes on a surface where no ray is traced: a driver without branches runs through
/// each of a ray's loops once nevertheless.
constexpr std::uint32_t iterations_without_ray = 7;

/// Entries of the longest list that a surface may have.
std::uint32_t longest_list(const Execution& run, const Lighting& lighting) {
    if (lighting.lists) return run.value(lighting.lists->bins).longest();
    return static_cast<std::uint32_t>(run.value(lighting.lights.table).entries.size());
}

}  // namespace

std::vector<std::string> lighting_variant(const gl::Limits& limits, const Lighting& lighting) {
    std::vector<std::string> words =
        lighting.vpls ? vpl_light_variant(*lighting.vpls) : std::vector<std::string>{};
    if (lighting.indirect) {
        words.emplace_back("INDIRECT_IRRADIANCE");
    } else if (lighting.vpls) {
        words.emplace_back("VPLS");
        words.push_back(
            fmt::format("MOST_VPLS={}", std::min(vpls_a_loop(limits, *lighting.vpls), lighting.most_vpls)));
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

std::vector<gl::Uniforms> lighting_parts(const gl::Limits& limits, const Execution& run,
                                         const Lighting& lighting, std::uint32_t surfaces) {
    if (!shows_direct(lighting.show)) return loop_parts(limits, 0, 1);
    const auto& lights = run.value(lighting.lights.table).entries;
    const auto casting = static_cast<std::uint64_t>(
        lighting.shadow_rays ? std::ranges::count_if(lights, &LightTable::Entry::casts_shadow) : 0);
    // All rays may be in one part. If that leaves too little for the lights without one, any may have a ray.
    const std::uint64_t rays = casting * surfaces * iterations_a_ray;
    if (rays > limits.loop_iterations / 8 * 7) {
        return loop_parts(limits, longest_list(run, lighting), surfaces * iterations_a_ray);
    }
    gl::Limits without_rays = limits;
    without_rays.loop_iterations -= rays;
    return loop_parts(without_rays, longest_list(run, lighting), surfaces * iterations_without_ray);
}

}  // namespace candela
