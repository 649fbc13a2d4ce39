#pragma once

#include "engine/import/gltf_document.hpp"
#include "engine/import/import_budget.hpp"

namespace candela::gltf {

// Geometry that is compressed, each kind by a library that is optional when Candela is built. What is decoded
// is put into the document, where the reading of accessors finds it.

/// EXT_meshopt_compression: decodes all buffer views that it has compressed. Throws SceneError, which names
/// the buffer view. Does nothing without meshoptimizer.
void decode_buffer_views(Document& document, ImportBudget& budget);

/// KHR_draco_mesh_compression: decodes what the primitives of a mesh have in no other form. Throws
/// SceneError, which names the buffer view or accessor. Does nothing without Draco.
void decode_primitives(Document& document, const Json& mesh, ImportBudget& budget);

}  // namespace candela::gltf
