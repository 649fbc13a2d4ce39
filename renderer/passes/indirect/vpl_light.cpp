#include "renderer/passes/indirect/vpl_light.hpp"

namespace candela {

std::uint32_t max_vpls_per_invocation(const VplLight& light) {
    if (light.rays) {
        return light.maps ? 512 : 64;  // few need rays: see emitting_surfels
    }
    return light.vpls.points ? 2048 : 8192;
}

std::vector<std::string> vpl_light_variant(const VplLight& light) {
    std::vector<std::string> words;
    if (light.vpls.points) {
        words.emplace_back("SURFELS");
    }
    if (light.emitters) {
        words.emplace_back("EMITTERS");
    }
    if (light.sky) {
        words.emplace_back("SKY");
    }
    if (light.maps) {
        words.emplace_back("VPL_VISIBILITY_MAPS");
    }
    if (light.rays && !light.maps) {
        words.emplace_back("VPL_VISIBILITY_RAYS");
    }
    return words;
}

void read_vpl_light(Pass& pass, const VplLight& light) {
    pass.read(light.vpls.plan);
    pass.read(light.vpls.vpls, {Usage::storage, BINDING_VPLS});
    read_vpl_constants(pass, light.common);
    if (light.vpls.points) {
        pass.read(*light.vpls.points, {Usage::storage, BINDING_LIT_POINTS});
    }
    if (light.maps) {
        pass.read(*light.maps, {Usage::sampled, UNIT_VPL_MAPS});
    }
    if (light.rays) {
        read_tracing(pass, *light.rays);
    }
}

}  // namespace candela
