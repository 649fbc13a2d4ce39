#pragma once

#include <candela/configuration.hpp>

#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/lights/light_table.hpp"
#include "renderer/passes/lights/shadow_maps.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/sky/sky.hpp"

namespace candela {

/// The lights of the scene, for the CPU and in the same order for shaders, and their shadows.
struct SceneLights {
    ValueHandle<LightTable> table;
    BufferHandle<gpu::LightConstants> constants;
    BufferHandle<gpu::Light> buffer;
    ShadowMaps shadows;
};

/// Adds node `lights` (CPU): see add_light_table; the nodes of add_shadow_maps; and `light-upload` (CPU, then
/// upload): the table and the shadows as buffers. `scale`: see shadow_resolution.
[[nodiscard]] SceneLights add_lights(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                     ValueHandle<SceneMetrics> metrics, const std::optional<Sky>& sky,
                                     const ShadowSettings& settings, float scale);

}  // namespace candela
