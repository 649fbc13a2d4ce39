#include "renderer/passes/sky/sky.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/passes/sky/sky_patches.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {

Sky add_sky(FrameGraph& graph) {
    return graph.add("sky", [&](Pass& pass) {
        pass.read<Environment>();
        const Sky out{
            .environment = pass.write(graph.value<Environment>("environment")),
            .picture = pass.write(graph.value<std::shared_ptr<const SkyPicture>>("environment picture"))};
        pass.run([=](Execution& run) {
            const Environment environment = environment_of(run.world());
            run.set(out.picture, environment.picture);
            run.set(out.environment, environment);
        });
        return out;
    });
}

SkyPatches add_sky_patches(FrameGraph& graph, const Gpu& gpu, const Sky& sky, std::uint32_t count,
                           std::optional<ValueHandle<Refinement>> refinement) {
    const auto split = graph.add("sky-split", [&](Pass& pass) {
        pass.read(sky.picture);
        pass.parameter(count);
        const auto out = pass.write(graph.value<SplitSky>("split sky"));
        pass.run([=](Execution& run) { run.set(out, split_sky(run.value(sky.picture).get(), count)); });
        return out;
    });
    return graph.add("sky-patches", [&](Pass& pass) {
        pass.read(split);
        pass.read(sky.environment);
        if (refinement) {
            pass.read(*refinement);
        }
        const SkyPatches out{
            .vpls = pass.write(graph.buffer<gpu::Vpl>("sky patches", 1, Lifetime::persistent), Usage::copy),
            .count = pass.write(graph.value<std::uint32_t>("sky patch count"))};
        pass.run([=, &gpu](Execution& run) {
            const std::uint32_t sample = refinement ? run.value(*refinement).set / frames_a_surfel_set : 0;
            const std::vector<gpu::Vpl> vpls =
                place_sky(run.value(split), run.value(sky.environment), sample);
            upload<gpu::Vpl>(gpu, run, out.vpls, vpls);
            run.set(out.count, static_cast<std::uint32_t>(vpls.size()));
        });
        return out;
    });
}

}  // namespace candela
