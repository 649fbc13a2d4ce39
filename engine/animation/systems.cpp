#include <memory>

#include <candela/graph/execute.hpp>
#include <candela/scene/animate.hpp>
#include <candela/scene/components.hpp>

namespace candela {
namespace {

ValueHandle<AnimationFaults> add_players(FrameGraph& graph, ValueHandle<double> seconds) {
    return graph.add("animation", [&](Pass& pass) {
        pass.read(seconds);
        pass.read<AnimationPlayer>();
        pass.write<AnimationPlayer>();
        pass.read<Transform>();
        pass.write<Transform>();
        pass.write<MorphWeights>();
        const auto clock = pass.update(graph.value<double>("animation clock"));
        const auto faults = pass.write(graph.value<AnimationFaults>("animation faults"));
        pass.run([=](Execution& run) {
            const double now = run.value(seconds);
            const double* const before = run.previous(clock);
            run.set(faults, advance_animations(run.world(), before ? now - *before : 0.0));
            run.set(clock, now);
        });
        return faults;
    });
}

ValueHandle<AnimationFaults> add_deformation(FrameGraph& graph) {
    return graph.add("deformation", [&](Pass& pass) {
        pass.read<Transform>();
        pass.read<MeshInstance>();
        pass.read<Skin>();
        pass.read<MorphWeights>();
        pass.read<DeformedMesh>();
        pass.write<DeformedMesh>();
        const auto faults = pass.write(graph.value<AnimationFaults>("deformation faults"));
        pass.run([=, deformer = std::make_shared<MeshDeformer>()](Execution& run) {
            run.set(faults, deformer->update(run.world()));
        });
        return faults;
    });
}

}  // namespace

AnimationSystems add_animation(FrameGraph& graph) {
    const auto seconds = graph.import_value<double>("seconds");
    const auto animation_faults = add_players(graph, seconds);
    return {seconds, animation_faults, add_deformation(graph)};
}

}  // namespace candela
