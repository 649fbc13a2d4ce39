#pragma once

#include <optional>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_check.hpp"
#include "renderer/passes/sky/sky.hpp"

namespace candela {

/// The lights of the world in the form that shaders read.
struct LightTable {
    struct Entry {
        Entity entity;
        gpu::Light light;
        /// Emitted, in lm for intensities in cd (or W for W/sr). Directional: through its footprint.
        glm::vec3 flux{0.0F};
        bool casts_shadow = true;
        bool operator==(const Entry&) const = default;
    };
    std::vector<Entry> entries;
    bool operator==(const LightTable&) const = default;
};

/// Adds node `lights` (CPU): gathers the light components: point lights, then spot lights, then directional
/// lights, then the suns of the sky. Lights that emit nothing, or that `check` does not accept, are left out.
/// Depends on the light components, Transform, the sky and the scene's metrics.
[[nodiscard]] ValueHandle<LightTable> add_light_table(FrameGraph& graph, SceneCheck& check,
                                                      ValueHandle<SceneMetrics> metrics,
                                                      const std::optional<Sky>& sky);

/// Two unit vectors that form an orthonormal basis with the unit vector n, as in shaders/maths.glsl: Duff et
/// al., "Building an Orthonormal Basis, Revisited" (2017), eq. 3.
struct Basis {
    glm::vec3 tangent;
    glm::vec3 bitangent;
};
[[nodiscard]] Basis basis_around(glm::vec3 n);

}  // namespace candela
