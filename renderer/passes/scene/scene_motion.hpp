#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "engine/bvh/box.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// Where more has moved, boxes are around groups of things: what the CPU does for each box stays short.
inline constexpr std::size_t most_changed_boxes = 512;

/// What moved in the last frame in which anything moved. Such a frame is called a step.
struct SceneMotion {
    std::uint64_t step = 0;  ///< counts the steps
    bool everything = true;  ///< anything may have changed, such as meshes; `boxes` is empty then
    std::vector<Box> boxes;  ///< world space, around what moved, at its old and new place; most_changed_boxes
    std::uint64_t epoch = 0;   ///< the input of the same name: see add_scene_motion
    SceneGeometry geometry;    ///< after the step
    ScenePlacement placement;  ///< after the step
    bool operator==(const SceneMotion&) const = default;
};

/// Adds node `scene-motion` (CPU): compares the scene with that of its last run. A new value of `epoch` marks
/// everything as changed. Depends on the scene's layout and placement, `epoch`, and its own last result.
[[nodiscard]] ValueHandle<SceneMotion> add_scene_motion(FrameGraph& graph, const SceneData& scene,
                                                        ValueHandle<std::uint64_t> epoch);

/// World-space boxes that enclose everything that changed after step number `done`: at most
/// most_changed_boxes, none if nothing moved. Returns nullopt if anything may have changed, also if more than
/// one step has followed.
[[nodiscard]] std::optional<std::vector<Box>> changed_boxes(const SceneMotion& motion, std::uint64_t done);

}  // namespace candela
