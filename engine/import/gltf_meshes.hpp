#pragma once

#include <memory>
#include <vector>

#include <candela/scene/components.hpp>
#include "engine/import/gltf_document.hpp"
#include "engine/import/gltf_materials.hpp"
#include "engine/import/progress.hpp"

namespace candela::gltf {

/// The document's meshes as triangles, in its order; null for those without triangles and those not in
/// `used`. Only those in `skinned` have influences. Strips and fans become lists. Triangles without area are
/// dropped, unless the mesh changes its shape: they are invisible, block no light and have no normal. If
/// normals are missing, the vertices are unshared and get the normals of their faces. A normal of length zero
/// is replaced by the normal of a face at that vertex. Missing texture coordinates are zero. Each kind of
/// content that is left out, such as points and lines, is added to the document's warnings once. Throws
/// SceneError, which names the mesh and the problem.
[[nodiscard]] std::vector<std::shared_ptr<const Mesh>> read_meshes(
    Document& document, const std::vector<bool>& used, const std::vector<bool>& skinned,
    const std::vector<ReadMaterial>& materials, ImportBudget& budget, const Progress& progress);

}  // namespace candela::gltf
