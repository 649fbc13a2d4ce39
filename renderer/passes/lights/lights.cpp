#include "renderer/passes/lights/lights.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include <candela/graph/execute.hpp>
#include <candela/scene/components.hpp>
#include "renderer/passes/lights/light_kind.hpp"

namespace candela {
namespace {

bool emits(glm::vec3 intensity) {
    return intensity.r > 0.0F || intensity.g > 0.0F || intensity.b > 0.0F;
}

LightTable gather(const World& world, const SceneMetrics& metrics) {
    LightTable table;
    for (const LightKind* const kind : light_kinds) {
        kind->gather(world, metrics, table.entries);
    }
    std::erase_if(table.entries,
                  [](const LightTable::Entry& entry) { return !emits(entry.light.intensity); });
    return table;
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

ValueHandle<LightTable> add_lights(FrameGraph& graph, ValueHandle<SceneMetrics> metrics) {
    return graph.add("lights", [&](Pass& pass) {
        for (const LightKind* const kind : light_kinds) {
            kind->read(pass);
        }
        pass.read<Transform>();
        pass.read(metrics);
        const auto lights = pass.write(graph.value<LightTable>("lights"));
        pass.run([=](Execution& run) { run.set(lights, gather(run.world(), run.value(metrics))); });
        return lights;
    });
}

}  // namespace candela
