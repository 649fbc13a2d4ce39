#include "renderer/passes/view/refinement.hpp"

#include <candela/graph/execute.hpp>

namespace candela {

ValueHandle<Refinement> add_refinement(FrameGraph& graph, ValueHandle<RefinementClock> clock,
                                       const SceneData& scene, const RefinedLight& light,
                                       ValueHandle<CameraView> view) {
    return graph.add("refinement", [&](Pass& pass) {
        pass.remembers();
        pass.read(clock);
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(light.lights);
        if (light.environment) {
            pass.read(*light.environment);
        }
        pass.read(view);
        const auto out = pass.update(graph.value<Refinement>("refinement"));
        pass.run([=, layout = scene.layout, placement = scene.placement](Execution& run) {
            const Refinement* const last = run.previous(out);
            const std::uint64_t epoch = run.value(clock).epoch;
            const bool moved = run.changed(layout) || run.changed(placement) || run.changed(light.lights) ||
                               (light.environment && run.changed(*light.environment)) || run.changed(view);
            Refinement now{.epoch = epoch};
            if (last != nullptr) {
                now.set = last->epoch != epoch || moved ? 0 : last->set + 1;
                const bool next_surfels = now.set > 0 && now.set % frames_a_surfel_set == 0;
                now.surfel_set = last->surfel_set + (next_surfels ? 1 : 0);
            }
            run.set(out, now);
        });
        return out;
    });
}

ValueHandle<CameraView> add_refined_view(FrameGraph& graph, ValueHandle<ViewRequest> request,
                                         ValueHandle<Refinement> refinement) {
    return graph.add("refined-view", [&](Pass& pass) {
        read_request(pass, request);
        pass.read(refinement);
        const auto out = pass.write(graph.value<CameraView>("refined view"));
        pass.run([=](Execution& run) {
            ViewRequest sampled = run.value(request);
            sampled.jitter += pixel_sample(run.value(refinement).set);
            run.set(out, requested_view(run.world(), sampled));
        });
        return out;
    });
}

}  // namespace candela
