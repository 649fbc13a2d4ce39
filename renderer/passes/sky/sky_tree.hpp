#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/sky/sky.hpp"

namespace candela {

/// A quadtree over the directions of a sky's picture, in which bright parts can be found.
struct SkyTree {
    static constexpr std::uint32_t width = 128;  ///< of the lowest level; as high as it is wide
    /// From the lowest level to the single root, each in rows like those of the picture. w: how much brighter
    /// than the mean of the sky; xyz: that times direction, summed.
    std::vector<std::vector<glm::vec4>> levels;
    float share = 0.0F;  ///< of the sky's light that is brighter than the mean
};

/// Of the sky without its suns; null: a sky of radiance 1 everywhere.
[[nodiscard]] SkyTree sky_tree(const SkyPicture* picture, const std::vector<SkySun>& suns);

/// The tree as a texture (rgba32f), whose mip levels are its levels: for shaders/sky/sky_tree.glsl.
struct SkyTreeData {
    TextureHandle levels;
    ValueHandle<float> share;
};

/// Adds node `sky-tree` (CPU, then upload). Depends on the picture of the sky.
[[nodiscard]] SkyTreeData add_sky_tree(FrameGraph& graph, Gpu& gpu, const Sky& sky);

}  // namespace candela
