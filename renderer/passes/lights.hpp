#pragma once

#include <vector>

#include "engine/ecs/world.hpp"
#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/bvh.hpp"

namespace candela {

/// The lights of the world as shading sees them, their shadows still open.
struct LightTable {
    struct Entry {
        Entity entity;
        gpu::Light light;
        glm::vec3 flux{
            0.0F};  ///< emitted, lm or W as the intensity has it; directional: through its footprint
        bool casts_shadow = true;
        bool operator==(const Entry&) const = default;
    };
    std::vector<Entry> entries;
    bool operator==(const LightTable&) const = default;
};

/// Node `lights` (CPU): gathers the light components, points, then spots, then directional ones. Lights that
/// emit nothing are left out.
[[nodiscard]] ValueHandle<LightTable> add_lights(FrameGraph& graph, ValueHandle<SceneMetrics> metrics);

/// Orthonormal basis around a unit vector, as shaders/maths.glsl has it: Duff et al., "Building an
/// Orthonormal Basis, Revisited" (2017), eq. 3.
struct Basis {
    glm::vec3 tangent;
    glm::vec3 bitangent;
};
[[nodiscard]] Basis basis_around(glm::vec3 n);

}  // namespace candela
