#pragma once

#include <candela/configuration.hpp>

#include <cstdint>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/lights/light_table.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// Texels along an edge of shadow maps.
struct ShadowResolution {
    std::uint32_t cube = 0;  ///< of a face
    std::uint32_t map = 0;
    bool operator==(const ShadowResolution&) const = default;
};

/// Halved as often as the sides of the picture are, `scale` being their share of the target's. Shadows are
/// the same with any resolution; only how many pixels need a ray depends on it.
[[nodiscard]] ShadowResolution shadow_resolution(const ShadowSettings& settings, float scale);

/// Which lights get a shadow map, and the views to render for them.
struct ShadowPlan {
    /// One rendering of scene depth: a flat map, or a face of a cube map.
    struct View {
        glm::mat4 clip_from_world;  ///< metres to clip space with reversed depth in [0, 1]
        glm::vec3 light_position;
        float depth_scale = 0.0F;  ///< as gpu::Shadow::depth_scale
        bool cube = false;
        std::uint32_t layer = 0;  ///< of the array of cubes or of maps
        bool operator==(const View&) const = default;
    };
    ShadowResolution resolution;
    std::vector<gpu::Shadow> shadows;  ///< by light of the table, then the faces of cubes
    std::vector<View> views;
    std::uint32_t cubes = 0;  ///< cubes and flat maps: how many lights have one
    std::uint32_t maps = 0;
    std::uint32_t by_rays = 0;  ///< lights whose maps would exceed a limit
    bool operator==(const ShadowPlan&) const = default;
};

/// The views that the maps contain. Has no operator==, because `newly_drawn` depends on what the maps
/// contained before.
struct DrawnShadows {
    std::vector<ShadowPlan::View> views;
    std::uint32_t newly_drawn = 0;  ///< number of views drawn in the last run of the node
};

/// The shadow maps of all lights.
struct ShadowMaps {
    ValueHandle<ShadowPlan> plan;
    BufferHandle<gpu::Shadow> shadows;  ///< as in the plan
    TextureHandle cubes;                ///< 2D array, depth32f, reversed; six layers for each light
    TextureHandle maps;                 ///< 2D array, depth32f, reversed
    ValueHandle<DrawnShadows> drawn;
    BufferHandle<gpu::DrawCommand> draws;  ///< of all views
};

/// Assigns shadow maps to the lights that cast shadows, by decreasing flux, as long as the budget lasts. A
/// directional light has none in a world of more than 2²⁴ triangles.
/// Which lights have one does not depend on `scale`; see shadow_resolution.
[[nodiscard]] ShadowPlan plan_shadows(const LightTable& lights, const SceneMetrics& metrics,
                                      const ShadowSettings& settings, float scale);

/// Adds nodes `shadow-plan` (CPU: plan_shadows, then upload of the shadows) and `shadow-maps` (raster): depth
/// of the scene as seen from every light that has a map (shadow mapping: Williams, "Casting Curved Shadows on
/// Curved Surfaces", 1978). A point light has the six faces of a cube, or one map if the scene is far away, a
/// spot light the cone or the same as a point light, a directional light the rectangle that the scene covers.
/// The maps are conservative, and where one does not decide, shading traces a ray: shaders/README.md, "Shadow
/// maps". Both sides of all triangles are drawn that may be in a map, but no blended surfaces. Views whose
/// content is unchanged are kept: if a light moves, only its views are drawn; if a mesh moves, all are; if
/// the camera moves, none. Depends on meshes, materials, lights and the scene's metrics. `scale`: see
/// shadow_resolution.
[[nodiscard]] ShadowMaps add_shadow_maps(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                         ValueHandle<LightTable> lights, ValueHandle<SceneMetrics> metrics,
                                         const ShadowSettings& settings, float scale);

/// For a pass whose shader includes shadow.glsl.
void read_shadow_maps(Pass& pass, const ShadowMaps& shadows);

}  // namespace candela
