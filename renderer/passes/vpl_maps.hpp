#pragma once

#include <cstdint>

#include "engine/graph/backend.hpp"
#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// How the evaluator finds out whether a VPL sees a surface.
enum class VplVisibility : std::uint8_t {
    none,  ///< it does not: VPLs shine through walls
    maps,  ///< in a depth map of each VPL's hemisphere
    rays   ///< by a shadow ray through the BVH: exact, and slow on software drivers
};

struct VplVisibilitySettings {
    VplVisibility method = VplVisibility::maps;
    std::uint32_t map_resolution = 64;  ///< texels along a side of a VPL's map
    bool operator==(const VplVisibilitySettings&) const = default;
};

/// How square tiles lie in the layers of a texture array.
struct VplAtlas {
    std::uint32_t resolution = 1;  ///< texels along a side of a tile
    std::uint32_t tiles = 1;       ///< along a side of a layer
    std::uint32_t side = 1;  ///< texels along a side of a layer: a power of two, or what the driver allows
    std::uint32_t layers = 1;
    ObjectId object = 0;  ///< the texture that the maps are in
    float reach = 1.0F;   ///< metres; at least the scene's diameter, and the same while things move
    bool operator==(const VplAtlas&) const = default;
};

/// The smallest atlas for `maps` tiles, by the driver's limits. Throws gl::GlError if there is none.
[[nodiscard]] VplAtlas plan_vpl_atlas(std::uint32_t resolution, std::uint32_t maps, const gl::Limits& limits);

struct VplMaps {
    ValueHandle<VplAtlas> atlas;
    TextureHandle depth;  ///< array, depth32f, reversed: shaders/vpl_atlas.glsl
};

/// Node `vpl-maps`: the depth of the scene as each VPL sees it in the hemisphere above its surface. A texel
/// is traced through the BVH and not rasterised: large triangles are then exact in the curved map, whatever
/// their tessellation, and one map costs as many rays as it has texels, however large the scene. Draws the
/// maps that are due, in one call; all of them where the atlas is new.
[[nodiscard]] VplMaps add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const Vpls& vpls,
                                   const VplVisibilitySettings& settings);

/// For a pass that looks VPLs up in their maps.
void read_vpl_maps(Pass& pass, const VplMaps& maps);
void bind_vpl_maps(const Gpu& gpu, Execution& run, const gl::Program& program, const VplMaps& maps,
                   const SceneMetrics& metrics);

}  // namespace candela
