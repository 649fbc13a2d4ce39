#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/bvh/box.hpp"
#include "engine/graph/frame_graph.hpp"
#include "renderer/gl/program.hpp"
#include "renderer/passes/scene_upload.hpp"

namespace candela {

/// What has moved since the frame in which something moved before.
struct SceneMotion {
    std::uint64_t step = 0;   ///< counts the frames in which something moved
    bool everything = true;   ///< meshes came, went or changed; `boxes` is empty then
    std::vector<Box> boxes;   ///< world space, around what moved, as it was and as it is
    std::uint64_t epoch = 0;  ///< of the host's: see add_scene_motion
    SceneGeometry geometry;   ///< at the end of the step
    ScenePlacement placement;
    bool operator==(const SceneMotion&) const = default;
};

/// Node `scene-motion` (CPU). Another `epoch` than before: everything is as if it had changed.
[[nodiscard]] ValueHandle<SceneMotion> add_scene_motion(FrameGraph& graph, const SceneData& scene,
                                                        ValueHandle<std::uint64_t> epoch);

/// Outside of which boxes all is as it was after the step `done`: at most MOST_CHANGED_BOXES of them, none
/// where nothing moved. Nothing: anything may have changed.
[[nodiscard]] std::optional<std::vector<Box>> changed_boxes(const SceneMotion& motion, std::uint64_t done);

/// Sets the uniforms of shaders/changed_boxes.glsl; `slack` metres are added on all sides.
void set_changed_boxes(const gl::Program& program, const std::optional<std::vector<Box>>& boxes, float slack);

}  // namespace candela
