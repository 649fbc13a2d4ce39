#include "renderer/passes/vpl_light.hpp"

#include "engine/graph/execute.hpp"

namespace candela {

std::uint32_t most_asked(const VplLight& light) {
    if (light.rays) {
        return 64;
    }
    return light.vpls.points ? 2048 : 8192;
}

std::vector<std::string> vpl_light_variant(const VplLight& light) {
    std::vector<std::string> words;
    if (light.vpls.points) {
        words.emplace_back("SURFELS");
    }
    if (light.maps) {
        words.emplace_back("VPL_VISIBILITY_MAPS");
    }
    if (light.rays) {
        words.emplace_back("VPL_VISIBILITY_RAYS");
    }
    return words;
}

void read_vpl_light(Pass& pass, const VplLight& light) {
    pass.read(light.vpls.plan);
    pass.read(light.vpls.vpls, Usage::storage);
    read_vpl_constants(pass, light.common);
    if (light.vpls.points) {
        pass.read(*light.vpls.points, Usage::storage);
    }
    if (light.maps) {
        pass.read(*light.maps, Usage::sampled);
    }
    if (light.rays) {
        read_tracing(pass, *light.rays);
    }
}

void bind_vpl_light(const Gpu& gpu, Execution& run, const gl::Program& program, const VplLight& light) {
    gpu.bind_storage(BINDING_VPLS, run.object(light.vpls.vpls));
    bind_vpl_constants(gpu, run, light.common);
    if (light.vpls.points) {
        gpu.bind_storage(BINDING_LIT_POINTS, run.object(*light.vpls.points));
    }
    if (light.maps) {
        gpu.gl().BindTextureUnit(UNIT_VPL_MAPS, run.object(*light.maps));
        gpu.shadow_sampler().bind(UNIT_VPL_MAPS);
    }
    if (light.rays) {
        bind_tracing(gpu, run, program, *light.rays);
    }
}

}  // namespace candela
