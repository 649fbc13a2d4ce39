#include "renderer/passes/sky/sky_vpls.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"

namespace candela {

SkyPatches add_sky_patches(FrameGraph& graph, const Gpu& gpu, const Sky& sky,
                           std::optional<ValueHandle<Refinement>> refinement) {
    return graph.add("sky-patches", [&](Pass& pass) {
        pass.read(sky.split);
        pass.read(sky.environment);
        if (refinement) {
            pass.read(*refinement);
        }
        const SkyPatches out{.vpls = pass.write(growing_buffer<gpu::Vpl>(graph, "sky patches"), Usage::copy),
                             .count = pass.write(graph.value<std::uint32_t>("sky patch count"))};
        pass.run([=, &gpu](Execution& run) {
            const std::uint32_t sample = refinement ? run.value(*refinement).set / frames_a_surfel_set : 0;
            const std::vector<gpu::Vpl> vpls =
                place_sky(run.value(sky.split), run.value(sky.environment), sample);
            upload<gpu::Vpl>(gpu, run, out.vpls, vpls);
            run.set(out.count, static_cast<std::uint32_t>(vpls.size()));
        });
        return out;
    });
}

}  // namespace candela
