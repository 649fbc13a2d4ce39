#include "renderer/passes/sky/sky_vpls.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"

namespace candela {

namespace {

/// Which sample of the sky is shown. As long as it is the same, the patches and their light stay.
ValueHandle<std::uint32_t> add_sample(FrameGraph& graph, ValueHandle<Refinement> refinement) {
    return graph.add("sky-sample", [&](Pass& pass) {
        pass.read(refinement);
        const auto sample = pass.write(graph.value<std::uint32_t>("sky sample"));
        pass.run([=](Execution& run) { run.set(sample, run.value(refinement).set / frames_a_surfel_set); });
        return sample;
    });
}

}  // namespace

SkyPatches add_sky_patches(FrameGraph& graph, const Gpu& gpu, const Sky& sky,
                           std::optional<ValueHandle<Refinement>> refinement) {
    const auto sample = refinement ? std::optional(add_sample(graph, *refinement)) : std::nullopt;
    return graph.add("sky-patches", [&](Pass& pass) {
        pass.read(sky.split);
        pass.read(sky.environment);
        if (sample) pass.read(*sample);
        const SkyPatches out{.patches = pass.write(graph.buffer<gpu::SkyPatch>(
                                                       "sky patches", MOST_SKY_PATCHES, Lifetime::persistent),
                                                   Usage::copy),
                             .count = pass.write(graph.value<std::uint32_t>("sky patch count"))};
        pass.run([=, &gpu](Execution& run) {
            const std::vector<gpu::SkyPatch> patches =
                place_sky(run.value(sky.split), run.value(sky.environment), sample ? run.value(*sample) : 0);
            upload<gpu::SkyPatch>(gpu, run, out.patches, patches);
            run.set(out.count, static_cast<std::uint32_t>(patches.size()));
        });
        return out;
    });
}

}  // namespace candela
