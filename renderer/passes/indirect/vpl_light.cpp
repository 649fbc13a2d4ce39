#include "renderer/passes/indirect/vpl_light.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "renderer/gpu/loop_parts.hpp"

namespace candela {
namespace {

/// Iterations of loops that a VPL takes at a surface, if few VPLs are seen by rays. A surface near the cell
/// of a surfel evaluates its points.
std::uint32_t iterations_if_few_have_rays(const VplLight& light) {
    if (light.rays) {
        return light.maps ? iterations_a_ray / 16 : iterations_a_ray / 2;  // few need rays
    }
    return std::holds_alternative<LitSurfels>(light.vpls.records) ? 31 : 7;
}

}  // namespace

std::uint32_t iterations_a_vpl(const VplLight& light, const VplCounts& counts) {
    const std::uint32_t few = iterations_if_few_have_rays(light);
    if (!light.rays || counts.sources() == 0) return few;
    const std::uint64_t with_rays = counts.sources() - counts.mapped();
    return std::max(few, static_cast<std::uint32_t>(iterations_a_ray / 2 * with_rays / counts.sources()));
}

std::uint32_t vpls_a_loop(const gl::Limits& limits, const VplLight& light) {
    constexpr std::uint64_t all = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(limits.loop_iterations / iterations_if_few_have_rays(light), 1, all));
}

std::vector<std::string> vpl_light_variant(const VplLight& light) {
    std::vector<std::string> words;
    if (const auto* const lit = std::get_if<LitSurfels>(&light.vpls.records)) {
        words.emplace_back("SURFELS");
        if (lit->emitters) words.emplace_back("EMITTERS");
        if (lit->sky) words.emplace_back("SKY");
        if (lit->balanced) words.emplace_back("BALANCED");
    }
    if (light.maps) words.emplace_back("VPL_VISIBILITY_MAPS");
    if (light.rays && !light.maps) words.emplace_back("VPL_VISIBILITY_RAYS");
    return words;
}

namespace {

void read_records(Pass& pass, const TracedVpls& traced) {
    pass.read(traced.vpls, {Usage::sampled, UNIT_TRACED_VPLS});
}

void read_records(Pass& pass, const LitSurfels& lit) {
    pass.read(lit.surfels, {Usage::sampled, UNIT_LIT_SURFELS});
    pass.read(lit.points, {Usage::sampled, UNIT_LIT_POINTS});
    if (lit.emitters) pass.read(*lit.emitters, {Usage::storage, BINDING_LIT_EMITTERS});
    if (lit.sky) pass.read(lit.sky->patches, {Usage::uniform, UNIFORMS_SKY});
}

}  // namespace

void read_vpl_light(Pass& pass, const VplLight& light) {
    pass.read(light.vpls.counts);
    std::visit([&](const auto& records) { read_records(pass, records); }, light.vpls.records);
    read_vpl_constants(pass, light.common);
    if (light.maps) {
        pass.read(light.maps->depth, {Usage::sampled, UNIT_VPL_MAPS});
        pass.read(light.maps->slopes, {Usage::sampled, UNIT_VPL_SLOPES});
    }
    if (light.rays) read_tracing(pass, *light.rays);
}

}  // namespace candela
