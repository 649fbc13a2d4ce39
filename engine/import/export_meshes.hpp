#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>

#include <candela/scene/components.hpp>
#include "engine/import/export_draft.hpp"
#include "engine/import/export_materials.hpp"

namespace candela::gltf {

/// Adds meshes and their materials to a draft, each once.
class MeshWriter {
 public:
    explicit MeshWriter(Draft& draft) : draft_(draft), materials_(draft) {}

    /// The index of the mesh; none if it has no triangles. Throws SceneError, which names the mesh or the
    /// material, if something in it is faulty.
    std::optional<std::size_t> index_of(const std::shared_ptr<const Mesh>& mesh);

 private:
    std::optional<std::size_t> add(const Mesh& mesh);
    [[nodiscard]] Json describe(const Primitive& primitive);

    Draft& draft_;
    MaterialWriter materials_;
    std::map<std::shared_ptr<const Mesh>, std::optional<std::size_t>> meshes_;
};

}  // namespace candela::gltf
