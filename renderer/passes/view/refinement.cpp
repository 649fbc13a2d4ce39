#include "renderer/passes/view/refinement.hpp"

#include <fmt/format.h>
#include <algorithm>

#include <candela/graph/execute.hpp>

namespace candela {

Refined add_refinement(FrameGraph& graph, ValueHandle<RefinementClock> clock, const SceneData& scene,
                       const RefinedLight& light, const std::vector<ValueHandle<CameraView>>& views) {
    return graph.add("refinement", [&](Pass& pass) {
        pass.keeps_state();
        pass.read(clock);
        std::vector<ResourceHandle> lit{scene.layout, scene.placement, light.lights};
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(light.lights);
        if (light.environment) {
            pass.read(*light.environment);
            lit.push_back(*light.environment);
        }
        Refined out{.refinement = pass.update(graph.value<Refinement>("refinement")), .averaged = {}};
        for (std::size_t i = 0; i < views.size(); ++i) {
            pass.read(views[i]);
            out.averaged.push_back(
                pass.update(graph.value<std::uint32_t>(fmt::format("averaged frames of view {}", i + 1))));
        }
        pass.run([=](Execution& run) {
            const Refinement* const last = run.previous(out.refinement);
            const std::uint64_t epoch = run.value(clock).epoch;
            const bool restarts = last == nullptr || last->epoch != epoch || run.changed(lit);
            bool all_moved = true;
            for (std::size_t i = 0; i < views.size(); ++i) {
                const std::uint32_t* const before = run.previous(out.averaged[i]);
                const bool moved = restarts || before == nullptr || run.changed(views[i]);
                all_moved &= moved;
                run.set(out.averaged[i], moved ? 0 : *before + 1);
            }
            Refinement now{.epoch = epoch};
            if (last != nullptr) {
                now.set = all_moved ? 0 : last->set + 1;
                const bool next_surfels = now.set > 0 && now.set % frames_a_surfel_set == 0;
                now.surfel_set = last->surfel_set + (next_surfels ? 1 : 0);
            }
            const std::optional<std::uint32_t> in_turn = run.value(clock).surfel_set;
            if (in_turn) now.surfel_set = *in_turn;
            run.set(out.refinement, now);
        });
        return out;
    });
}

void SurfelSetChoice::read(Pass& pass) const {
    if (refinement) pass.read(*refinement);
    pass.parameter(place);
}

bool SurfelSetChoice::is_next(const Execution& run) const {
    return refinement && place && run.value(*refinement).surfel_set % 2 != *place;
}

std::uint32_t SurfelSetChoice::number(const Execution& run) const {
    if (!refinement) return 0;
    return run.value(*refinement).surfel_set + (is_next(run) ? 1 : 0);
}

ValueHandle<CameraView> add_refined_view(FrameGraph& graph, ValueHandle<ViewRequest> request,
                                         ValueHandle<std::uint32_t> averaged) {
    return graph.add("refined-view", [&](Pass& pass) {
        read_request(pass, request);
        pass.read(averaged);
        const auto out = pass.write(graph.value<CameraView>("refined view"));
        pass.run([=](Execution& run) {
            ViewRequest sampled = run.value(request);
            sampled.jitter += pixel_sample(run.value(averaged));
            run.set(out, requested_view(run.world(), sampled));
        });
        return out;
    });
}

}  // namespace candela
