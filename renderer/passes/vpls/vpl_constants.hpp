#pragma once

#include <candela/configuration.hpp>

#include <cstdint>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/surfels/surfel_maps.hpp"
#include "renderer/passes/vpls/vpl_counts.hpp"

namespace candela {

/// Layout of the maps of VPLs: square slots in the layers of a 2D array texture.
struct VplAtlas {
    std::uint32_t resolution = 1;  ///< texels along a side of a slot
    std::uint32_t tiles = 1;       ///< slots along a side of a layer
    std::uint32_t side = 1;        ///< texels along a side of a layer: a power of two or the driver's limit
    std::uint32_t layers = 1;
    /// Octahedral distance in metres at which depth is 1 (shaders/vpls/vpl_atlas.glsl); rarely changes while
    /// objects move.
    float near = 1.0F;
    bool operator==(const VplAtlas&) const = default;
};

/// The atlas with the fewest layers, at least one, for `maps` slots, within the limits of the driver. Throws
/// gl::GlError if there is none.
[[nodiscard]] VplAtlas plan_vpl_atlas(std::uint32_t resolution, std::uint32_t maps, const gl::Limits& limits);

/// What VPLs see: the planes behind the texels of their maps (shaders/vpls/vpl_atlas.glsl). 2D arrays.
struct VplMaps {
    TextureHandle depth;   ///< r32f, reversed: 1 near the VPL, 0 where there is no surface
    TextureHandle slopes;  ///< r32ui: two half floats
};

/// Constants of all VPLs, for the CPU and for shaders that include vpl_constants.glsl.
struct VplCommon {
    ValueHandle<VplAtlas> atlas;
    BufferHandle<gpu::VplConstants> constants;
};

/// Adds node `vpl-constants` (CPU, then upload): VplCommon. Depends on the scene's metrics, the
/// counts and the maps of surfels, if it is these that have some.
[[nodiscard]] VplCommon add_vpl_constants(FrameGraph& graph, const Gpu& gpu,
                                          ValueHandle<SceneMetrics> metrics, ValueHandle<VplCounts> counts,
                                          std::optional<ValueHandle<SurfelMaps>> maps,
                                          const VplVisibilitySettings& settings);

/// For a pass whose shader includes vpl_constants.glsl.
void read_vpl_constants(Pass& pass, const VplCommon& common);

}  // namespace candela
