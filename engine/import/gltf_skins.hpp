#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include <candela/scene/components.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_document.hpp"

namespace candela::gltf {

/// A skeleton: its joints as nodes, and their matrices.
struct ReadSkin {
    std::vector<int> joints;
    std::shared_ptr<const std::vector<glm::mat4>> inverse_bind_matrices;  ///< null: identities
};

/// The document's skins in its order; nullopt for those not in `used`. Throws SceneError, which names the
/// skin and the problem.
[[nodiscard]] std::vector<std::optional<ReadSkin>> read_skins(const Document& document,
                                                              const std::vector<bool>& used,
                                                              ImportBudget& budget);

/// The influences of the selected vertices of a primitive: JOINTS_0 and WEIGHTS_0, JOINTS_1 and WEIGHTS_1,
/// and so on. Throws SceneError.
[[nodiscard]] std::vector<std::vector<Influences>> read_influences(const Document& document,
                                                                   const Json& primitive,
                                                                   const Selection& selection,
                                                                   ImportBudget& budget);

}  // namespace candela::gltf
