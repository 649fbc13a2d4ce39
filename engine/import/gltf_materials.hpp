#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>

#include <candela/scene/components.hpp>
#include "engine/import/gltf_document.hpp"
#include "engine/import/progress.hpp"

namespace candela::gltf {

/// Where texture coordinates of surfaces come from: a set of the file's, and what KHR_texture_transform does
/// to it.
struct Coordinates {
    int set = 0;                ///< of TEXCOORD_0, TEXCOORD_1, ...
    glm::mat3 transform{1.0F};  ///< of (u, v, 1)
    bool operator==(const Coordinates&) const = default;
};

/// A material, and the texture coordinates of surfaces that have it.
struct ReadMaterial {
    std::shared_ptr<const Material> material;
    Coordinates uv{};                         ///< of Vertex::uv
    std::optional<Coordinates> second_uvs{};  ///< of Primitive::second_uvs, if the material needs them
};

/// The document's materials in its order, followed by the default material (rough white metal, single-sided).
/// Those that no mesh of `used_meshes` has are null. Textures with the same file or buffer view and wrapping
/// share one Image; images that no material uses are not loaded. A texture that cannot be used is left out,
/// with an entry in the document's warnings. What takes the place of an image that is missing or cannot be
/// read (see StandIn) comes with one entry for that image. Throws SceneError, which names the image or
/// sampler and the problem, such as a file outside of the root.
[[nodiscard]] std::vector<ReadMaterial> read_materials(Document& document,
                                                       const std::vector<bool>& used_meshes,
                                                       ImportFiles& files, ImportBudget& budget,
                                                       const Progress& progress);

}  // namespace candela::gltf
