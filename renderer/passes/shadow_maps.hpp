#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/lights.hpp"
#include "renderer/passes/scene_upload.hpp"

namespace candela {

/// Sizes of shadow maps, in texels along an edge, and the memory that they may take together.
struct ShadowSettings {
    bool enabled = true;
    std::uint32_t cube_resolution = 512;  ///< of each face: point lights, and spots wider than a map can hold
    std::uint32_t map_resolution = 1024;  ///< spot and directional lights
    std::uint32_t budget_mib = 256;
    bool operator==(const ShadowSettings&) const = default;
};

/// Which lights get a map, and how each is rendered.
struct ShadowPlan {
    /// One rendering of the scene's depth: a map, or a face of a cube.
    struct View {
        glm::mat4 clip_from_world;
        bool cube = false;
        std::uint32_t layer = 0;  ///< of the cube array (face 0 to 5 of cube layer / 6) or of the map array
        bool operator==(const View&) const = default;
    };
    std::vector<std::int32_t> shadow_of_light;  ///< for each light of the table; -1: none
    std::vector<gpu::Shadow> shadows;
    std::vector<View> views;
    std::uint32_t cubes = 0;
    std::uint32_t maps = 0;
    std::uint32_t lights_without = 0;  ///< that should cast shadows and were left out by the budget
    bool operator==(const ShadowPlan&) const = default;
};

/// What the maps show. Does not compare: how much of it a frame had to draw depends on what was there.
struct DrawnShadows {
    std::vector<ShadowPlan::View> views;
    std::uint32_t newly_drawn = 0;  ///< of the views, when the maps last changed
};

struct ShadowMaps {
    ValueHandle<ShadowPlan> plan;
    TextureHandle cubes;  ///< cube array, depth32f, reversed
    TextureHandle maps;   ///< array, depth32f, reversed
    ValueHandle<DrawnShadows> drawn;
};

/// Gives maps to the lights that cast shadows, the strongest flux first, as far as the budget goes.
[[nodiscard]] ShadowPlan plan_shadows(const LightTable& lights, const SceneMetrics& metrics,
                                      const ShadowSettings& settings);

/// Nodes `shadow-plan` (CPU) and `shadow-maps`: depth of the scene from every light that has a map, all
/// triangles from both sides, less the holes of masks and what is blended. Views that show already what they
/// are to show are kept: where a light moves its own are drawn, where a mesh moves all. A point light looks
/// through the six faces of a cube, a spot through its cone, a directional light through the rectangle that
/// the scene covers.
[[nodiscard]] ShadowMaps add_shadow_maps(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                         ValueHandle<LightTable> lights, ValueHandle<SceneMetrics> metrics,
                                         const ShadowSettings& settings);

}  // namespace candela
