#pragma once

#include <cstdint>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/vpl_paths.hpp"

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
    float reach = 1.0F;  ///< metres; at least the scene's diameter, and the same while things move
    bool operator==(const VplAtlas&) const = default;
};

/// The smallest atlas for `maps` tiles, by the driver's limits. Throws gl::GlError if there is none.
[[nodiscard]] VplAtlas plan_vpl_atlas(std::uint32_t resolution, std::uint32_t maps, const gl::Limits& limits);

/// What all VPLs have in common, for shaders that include vpl_constants.glsl.
struct VplCommon {
    ValueHandle<VplAtlas> atlas;
    BufferHandle<gpu::VplConstants> constants;
};

/// Squared distance R², in m², from which on a VPL's light hardly grows: shaders/vpl_light.glsl. N VPLs share
/// the area A of the scene's surfaces; R is the diameter of a disc of A/N, R² = 4 A / (π N), the least error
/// in the Cornell box with shadows of VPLs (tests/study). The geometry term is at most 4/3 of 1/R², and
/// `bound` scales that; at infinity the VPL is a point. R shrinks as N grows, and the energy that it costs
/// vanishes.
[[nodiscard]] float vpl_radius2(float bound, std::uint32_t vpl_count, float area);

/// Node `vpl-constants`. `bound`: see `vpl_radius2`.
[[nodiscard]] VplCommon add_vpl_constants(FrameGraph& graph, const Gpu& gpu,
                                          ValueHandle<SceneMetrics> metrics, ValueHandle<VplPlan> plan,
                                          const VplVisibilitySettings& settings, float bound);

/// For a pass whose shader includes vpl_constants.glsl: declares what that reads, and binds it when the pass
/// runs.
void read_vpl_constants(Pass& pass, const VplCommon& common);
void bind_vpl_constants(const Gpu& gpu, Execution& run, const VplCommon& common);

}  // namespace candela
