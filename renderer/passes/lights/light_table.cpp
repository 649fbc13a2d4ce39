#include "renderer/passes/lights/light_table.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include <candela/graph/execute.hpp>
#include <candela/scene/components.hpp>
#include "renderer/passes/lights/light_kind.hpp"

namespace candela {
namespace {

bool emits(glm::vec3 intensity) {
    return intensity.r > 0.0F || intensity.g > 0.0F || intensity.b > 0.0F;
}

LightTable gather(const WorldReader& world, SceneCheck& check, const SceneMetrics& metrics) {
    LightTable table;
    for (const LightKind* const kind : light_kinds) {
        kind->gather(world, check, metrics, table.entries);
    }
    return table;
}

void append_suns(LightTable& table, const SplitSky& sky, const Environment& environment,
                 const SceneMetrics& metrics) {
    for (const SkySun& sun : sky.suns) {
        const ParallelLight light{.direction = -rotated_sky(sun.direction, environment.rotation),
                                  .illuminance = environment.radiance * sun.light,
                                  .casts_shadow = true};
        table.entries.push_back(directional_entry({}, light, metrics));
    }
}

void drop_dark(LightTable& table) {
    std::erase_if(table.entries,
                  [](const LightTable::Entry& entry) { return !emits(entry.light.intensity); });
}

}  // namespace

glm::vec3 direction_of(const glm::mat4& world) {
    const glm::vec3 axis(world[2]);
    const float length = glm::length(axis);
    return length > 0.0F ? -axis / length : glm::vec3(0.0F, 0.0F, -1.0F);
}

Basis basis_around(glm::vec3 n) {
    const float s = n.z >= 0.0F ? 1.0F : -1.0F;
    const float a = -1.0F / (s + n.z);
    const float b = n.x * n.y * a;
    return {{1.0F + s * n.x * n.x * a, s * b, -s * n.x}, {b, s + n.y * n.y * a, -n.y}};
}

ValueHandle<LightTable> add_light_table(FrameGraph& graph, SceneCheck& check,
                                        ValueHandle<SceneMetrics> metrics, const std::optional<Sky>& sky) {
    return graph.add("lights", [&](Pass& pass) {
        for_each_light_kind([&]<class Light>(const LightTraits<Light>&) { pass.read<Light>(); });
        pass.read<Transform>();
        pass.read(metrics);
        if (sky) {
            pass.read(sky->split);
            pass.read(sky->environment);
        }
        const auto lights = pass.write(graph.value<LightTable>("lights"));
        pass.run([=, &check](Execution& run) {
            LightTable table = gather(run.world(), check, run.value(metrics));
            if (sky) {
                append_suns(table, run.value(sky->split), run.value(sky->environment), run.value(metrics));
            }
            drop_dark(table);
            run.set(lights, std::move(table));
        });
        return lights;
    });
}

}  // namespace candela
