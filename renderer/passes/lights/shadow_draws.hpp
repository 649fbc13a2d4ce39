#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "engine/bvh/box.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// Some triangles that cast shadows.
struct ShadowCaster {
    gpu::DrawCommand draw;
    Box bounds;  ///< contains them; world space, metres
};

/// All triangles that cast shadows, in the order of the items, by parts of their primitives.
/// `margin`: more than the rounding of their positions, metres.
[[nodiscard]] std::vector<ShadowCaster> shadow_casters(const SceneLayout& layout,
                                                       const ScenePlacement& placement, float margin);

/// Appends commands that draw those which may be in a shadow map of `resolution` texels a side. Parts that
/// follow each other in a primitive are drawn by one command.
void append_shadow_draws(std::span<const ShadowCaster> casters, const glm::mat4& clip_from_world,
                         std::uint32_t resolution, std::vector<gpu::DrawCommand>& draws);

}  // namespace candela
