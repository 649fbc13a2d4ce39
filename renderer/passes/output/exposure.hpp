#pragma once

#include <glm/vec2.hpp>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "shaders/bindings.glsl"

namespace candela {

/// Elements of the buffer that find_exposure writes: the exposure and the log-average luminance, then sums of
/// each work group.
inline constexpr std::uint64_t exposure_values = 1 + EXPOSURE_GROUPS;

/// Adds node `exposure` (compute): finds the exposure of ToneMapSettings::automatic_exposure for the picture
/// `radiance`, on which alone it depends. Returns it in the x of the first element.
[[nodiscard]] BufferHandle<glm::vec2> add_exposure(FrameGraph& graph, Gpu& gpu, TextureHandle radiance);

/// Does the work of the node, also for pictures from elsewhere: for the texture at UNIT_RADIANCE, to the
/// buffer at BINDING_EXPOSURE.
void find_exposure(Gpu& gpu, const gl::Program& program);
inline constexpr const char* exposure_stage = "output/exposure.comp";  ///< of the program

}  // namespace candela
