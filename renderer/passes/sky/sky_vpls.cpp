#include "renderer/passes/sky/sky_vpls.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"

namespace candela {

SkyPatches add_sky_patches(FrameGraph& graph, const Gpu& gpu, const Sky& sky,
                           std::optional<ValueHandle<Refinement>> refinement) {
    return graph.add("sky-patches", [&](Pass& pass) {
        pass.read(sky.split);
        pass.read(sky.environment);
        if (refinement) pass.read(*refinement);
        const SkyPatches out{.patches = pass.write(graph.buffer<gpu::SkyPatch>(
                                                       "sky patches", MOST_SKY_PATCHES, Lifetime::persistent),
                                                   Usage::copy),
                             .count = pass.write(graph.value<std::uint32_t>("sky patch count"))};
        pass.run([=, &gpu](Execution& run) {
            const std::uint32_t sample = refinement ? run.value(*refinement).set / frames_a_surfel_set : 0;
            const std::vector<gpu::SkyPatch> patches =
                place_sky(run.value(sky.split), run.value(sky.environment), sample);
            upload<gpu::SkyPatch>(gpu, run, out.patches, patches);
            run.set(out.count, static_cast<std::uint32_t>(patches.size()));
        });
        return out;
    });
}

}  // namespace candela
