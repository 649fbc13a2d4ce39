#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <candela/scene/animation.hpp>
#include "engine/import/gltf_document.hpp"
#include "engine/import/gltf_nodes.hpp"

namespace candela::gltf {

/// The animations of the scene. `targets` are those of Animations, as indices into the staged entities.
struct ReadAnimations {
    std::vector<std::shared_ptr<const AnimationClip>> clips;
    std::vector<std::size_t> targets;
};

/// The animations that move something of the scene, in the document's order. Channels that do not are left
/// out, each kind with one entry in the document's warnings. Throws SceneError, which names the animation and
/// the problem.
[[nodiscard]] ReadAnimations read_animations(Document& document, const std::vector<StagedEntity>& staged,
                                             ImportBudget& budget);

}  // namespace candela::gltf
