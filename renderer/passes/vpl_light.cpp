#include "renderer/passes/vpl_light.hpp"

#include <numbers>

#include "engine/graph/execute.hpp"

namespace candela {

float vpl_radius2(float bound, std::uint32_t vpl_count, float area) {
    return 4.0F * area / (std::numbers::pi_v<float> * static_cast<float>(vpl_count) * bound);
}

std::uint32_t most_asked(const VplLight& light) {
    return light.rays ? 64 : 8192;
}

std::vector<std::string> vpl_light_variant(const VplLight& light) {
    if (light.maps) {
        return {"VPL_VISIBILITY_MAPS"};
    }
    if (light.rays) {
        return {"VPL_VISIBILITY_RAYS"};
    }
    return {};
}

void read_vpl_light(Pass& pass, const VplLight& light) {
    pass.read(light.metrics);
    pass.read(light.vpls.paths);
    pass.read(light.vpls.vpls, Usage::storage);
    if (light.maps) {
        read_vpl_maps(pass, *light.maps);
    }
    if (light.rays) {
        read_tracing(pass, *light.rays);
    }
    pass.parameter(light.geometry_bound);
}

void bind_vpl_light(const Gpu& gpu, Execution& run, const gl::Program& program, const VplLight& light) {
    const std::uint32_t vpls = run.value(light.vpls.paths).vpl_count;
    program.set("vpl_count", vpls);
    if (vpls == 0) {
        return;
    }
    gpu.bind_storage(BINDING_VPLS, run.object(light.vpls.vpls));
    const SceneMetrics& metrics = run.value(light.metrics);
    program.set("vpl_radius2", vpl_radius2(light.geometry_bound, vpls, metrics.area));
    program.set("crease_slack", 16.0F * metrics.ray_offset());
    if (light.maps) {
        bind_vpl_maps(gpu, run, program, *light.maps, metrics);
    }
    if (light.rays) {
        bind_tracing(gpu, run, program, *light.rays);
        program.set("vpl_ray_offset", metrics.ray_offset());
    }
}

}  // namespace candela
