#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/scene/components.hpp"
#include "engine/scene/gltf_document.hpp"

namespace candela::gltf {

/// The document's meshes as triangles, in its order; null for one that has no triangle. Strips and fans
/// become lists. Triangles without area are dropped: they show nothing, stop nothing and have no normal.
/// Missing normals are those of the faces, which unshares the vertices; a normal of length zero becomes that
/// of a face at its vertex; missing texture coordinates are zero. Points, lines and what else is left out is
/// added to the document's warnings, once each. Throws SceneError that names the mesh, or the accessor, and
/// the fault.
[[nodiscard]] std::vector<std::shared_ptr<const Mesh>> read_meshes(
    Document& document, const std::vector<std::shared_ptr<const Material>>& materials);

}  // namespace candela::gltf
