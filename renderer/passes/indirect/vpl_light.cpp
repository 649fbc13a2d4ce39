#include "renderer/passes/indirect/vpl_light.hpp"

namespace candela {

std::uint32_t max_vpls_per_invocation(const VplLight& light) {
    if (light.rays) {
        return light.maps ? 512 : 64;  // few need rays: see emitting_surfels
    }
    return std::holds_alternative<LitSurfels>(light.vpls.records) ? 2048 : 8192;
}

std::vector<std::string> vpl_light_variant(const VplLight& light) {
    std::vector<std::string> words;
    if (const auto* const lit = std::get_if<LitSurfels>(&light.vpls.records)) {
        words.emplace_back("SURFELS");
        if (lit->emitters) words.emplace_back("EMITTERS");
        if (lit->sky) words.emplace_back("SKY");
    }
    if (light.maps) words.emplace_back("VPL_VISIBILITY_MAPS");
    if (light.rays && !light.maps) words.emplace_back("VPL_VISIBILITY_RAYS");
    return words;
}

namespace {

void read_records(Pass& pass, const TracedVpls& traced) {
    pass.read(traced.vpls, {Usage::storage, BINDING_TRACED_VPLS});
}

void read_records(Pass& pass, const LitSurfels& lit) {
    pass.read(lit.surfels, {Usage::storage, BINDING_LIT_SURFELS});
    pass.read(lit.points, {Usage::storage, BINDING_LIT_POINTS});
    if (lit.emitters) pass.read(*lit.emitters, {Usage::storage, BINDING_LIT_EMITTERS});
    if (lit.sky) pass.read(lit.sky->patches, {Usage::uniform, UNIFORMS_SKY});
}

}  // namespace

void read_vpl_light(Pass& pass, const VplLight& light) {
    pass.read(light.vpls.counts);
    std::visit([&](const auto& records) { read_records(pass, records); }, light.vpls.records);
    read_vpl_constants(pass, light.common);
    if (light.maps) pass.read(*light.maps, {Usage::sampled, UNIT_VPL_MAPS});
    if (light.rays) read_tracing(pass, *light.rays);
}

}  // namespace candela
