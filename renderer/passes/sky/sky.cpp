#include "renderer/passes/sky/sky.hpp"

#include <candela/graph/execute.hpp>

namespace candela {

Environment accepted_environment(const WorldReader& world, SceneCheck& check) {
    return environment_of(world, [&](Entity entity, const Environment& environment) {
        return check.accepts(world, entity, environment);
    });
}

Sky add_sky(FrameGraph& graph, SceneCheck& check, std::uint32_t count) {
    Sky sky = graph.add("sky", [&](Pass& pass) {
        pass.read<Environment>();
        const Sky out{
            .environment = pass.write(graph.value<Environment>("environment")),
            .picture = pass.write(graph.value<std::shared_ptr<const SkyPicture>>("environment picture")),
            .split = {}};
        pass.run([=, &check](Execution& run) {
            const Environment environment = accepted_environment(run.world(), check);
            run.set(out.picture, environment.picture);
            run.set(out.environment, environment);
        });
        return out;
    });
    sky.split = graph.add("sky-split", [&](Pass& pass) {
        pass.read(sky.picture);
        pass.parameter(count);
        const auto out = pass.write(graph.value<SplitSky>("split sky"));
        pass.run([=, picture = sky.picture](Execution& run) {
            run.set(out, split_sky(run.value(picture).get(), count));
        });
        return out;
    });
    return sky;
}

}  // namespace candela
