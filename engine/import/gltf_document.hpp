#pragma once

#include <string>
#include <vector>

#include "engine/import/gltf_model.hpp"
#include "engine/import/import_budget.hpp"
#include "engine/import/import_files.hpp"
#include "engine/json/json.hpp"

namespace candela::gltf {

/// A part of a file, which it keeps in memory.
struct Buffer {
    Content content;
    Bytes bytes;
};

/// A checked glTF document with its buffers loaded. Nodes stay as JSON, of which there may be millions.
/// Images stay encoded. Animations and skins are left out.
struct Document {
    Model model;
    std::vector<Buffer> buffers;
    Json nodes;  ///< array
    std::vector<std::string> warnings;
};

/// Parses and checks .gltf or .glb, distinguished by their first bytes, and loads the buffers. Throws
/// SceneError for malformed data and for required extensions that are not supported. The document refers to
/// `bytes`.
[[nodiscard]] Document read_document(Bytes bytes, ImportFiles& files, ImportBudget& budget);

}  // namespace candela::gltf
