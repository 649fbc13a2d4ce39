#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_motion.hpp"
#include "renderer/passes/surfels/surfel_updates.hpp"
#include "renderer/passes/surfels/surfels.hpp"

namespace candela {

/// Visibility between surfels.
struct SurfelVisibility {
    Surfels surfels;
    /// Half floats, two per word, `surfel_columns` per surfel; 0 if hidden. Layout:
    /// shaders/surfels/surfel.glsl.
    BufferHandle<std::uint32_t> form_factors;
    /// By surfel: scale of its form factors, and the cosine-weighted share of its hemisphere in which no
    /// reflecting surface is visible.
    BufferHandle<glm::vec2> rows;
};

/// How many surfels a surfel gathers from: at most MOST_COLUMNS. If there are more, every n-th represents n
/// surfels.
struct SurfelColumns {
    std::uint32_t count = 0;   ///< columns per surfel; even
    std::uint32_t stride = 1;  ///< n: at least 1
};
[[nodiscard]] SurfelColumns surfel_columns(std::uint32_t surfels);

/// `surfel_count` and the uniforms that follow from it: shaders/surfels/surfel.glsl.
[[nodiscard]] gl::Uniforms count_uniforms(std::uint32_t surfels);

/// Which of the surfels were there before.
struct KeptSurfels {
    std::vector<std::uint32_t> last;  ///< by surfel: its index before, or NO_SURFEL
    bool in_place = true;             ///< there are as many as before, and those that stay keep their indices
    std::uint32_t last_count = 0;     ///< of surfels before

    /// Whether their form factors can be kept. With more than MOST_COLUMNS surfels, it depends on the indices
    /// which pairs have one.
    [[nodiscard]] bool keeps_factors() const;
};
[[nodiscard]] KeptSurfels kept_surfels(std::span<const std::uint64_t> last_ids,
                                       std::span<const std::uint64_t> ids);

/// Adds node `surfel-visibility` (compute). It finds the form factors between surfels, with one ray for each
/// pair of surfels that face each other; the form factor is that of a disc (shaders/vpls/disc.glsl). Factors
/// are then scaled, so that those of a surfel add up to the share of its hemisphere in which rays hit
/// reflecting surfaces (Sinkhorn and Knopp, 1967: shaders/surfels/surfel_rows.comp); without bounds if
/// `shares_items`: a surfel stands for several items. Between surfels that
/// stay (Surfels::ids), and above each of them, only rays that pass through the changed boxes are traced
/// again; with more than MOST_COLUMNS surfels only if all that stay keep their indices. With `tasks`
/// (add_surfel_updates), only rays of the surfels whose turn it is. Depends on surfels, BVH, motion and
/// tasks, and on its own last result.
[[nodiscard]] SurfelVisibility add_surfel_visibility(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                                     const Surfels& surfels, ValueHandle<SceneMotion> motion,
                                                     bool shares_items = false,
                                                     std::optional<ValueHandle<SurfelTasks>> tasks = {});

}  // namespace candela
