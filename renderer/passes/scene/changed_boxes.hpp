#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <candela/graph/execute.hpp>
#include <candela/graph/frame_graph.hpp>
#include "engine/bvh/box.hpp"
#include "renderer/gl/uniforms.hpp"
#include "renderer/gpu/gpu.hpp"
#include "renderer/gpu/gpu_types.hpp"

namespace candela {

/// The boxes if they are at most `most`, else `most` boxes around groups of those that are close together.
[[nodiscard]] std::vector<Box> grouped(std::vector<Box> boxes, std::size_t most);

/// A binary tree whose leaves are the boxes, each enlarged by `slack` metres on all sides. In depth-first
/// order: a box is followed by what is in it, and `next` is the one behind that; a leaf's `next` is the one
/// that follows it.
[[nodiscard]] std::vector<gpu::ChangedBox> box_tree(std::vector<Box> boxes, float slack);

/// The inputs of shaders/scene/changed_boxes.glsl for a pass that traces again only the rays that meet boxes.
class ChangedBoxes {
 public:
    ChangedBoxes(FrameGraph& graph, Pass& pass, std::string_view name);

    /// Uploads the boxes, each enlarged by `slack` metres. Returns the uniforms. `boxes`: result of
    /// changed_boxes.
    [[nodiscard]] gl::Uniforms upload(const Gpu& gpu, Execution& run,
                                      const std::optional<std::vector<Box>>& boxes, float slack) const;

 private:
    BufferHandle<gpu::ChangedBox> tree_;
};

}  // namespace candela
