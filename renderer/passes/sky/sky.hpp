#pragma once

#include <memory>

#include <candela/graph/frame_graph.hpp>
#include <candela/scene/components.hpp>
#include "renderer/passes/scene/scene_check.hpp"
#include "renderer/passes/sky/sky_patches.hpp"

namespace candela {

/// The world's sky on the CPU.
struct Sky {
    ValueHandle<Environment> environment;
    ValueHandle<std::shared_ptr<const SkyPicture>> picture;  ///< of the environment; changes less often
    ValueHandle<SplitSky> split;                             ///< of the picture
};

/// The environment that counts, of those that `check` accepts.
[[nodiscard]] Environment accepted_environment(const WorldReader& world, SceneCheck& check);

/// Adds nodes `sky` (CPU): reads the Environment, and `sky-split` (CPU: split_sky into about `count` patches,
/// when the picture changes).
[[nodiscard]] Sky add_sky(FrameGraph& graph, SceneCheck& check, std::uint32_t count);

}  // namespace candela
