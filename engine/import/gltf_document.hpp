#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/import/gltf_values.hpp"
#include "engine/import/import_budget.hpp"
#include "engine/import/import_files.hpp"

namespace candela::gltf {

/// A part of a file, which it keeps in memory.
struct Buffer {
    Content content;
    Bytes bytes;
};

/// A checked glTF document with its buffers loaded. The rest is read where it is needed: see gltf_values.hpp.
struct Document {
    Json json;
    std::vector<Buffer> buffers;
    std::vector<std::string> warnings;
    // What was compressed, by index. Reading an accessor or a buffer view prefers it.
    std::map<int, std::vector<unsigned char>> decoded_views;  ///< bytes of buffer views
    std::map<int, std::vector<unsigned char>>
        decoded_accessors;      ///< elements of accessors, one after the other
    bool is_quantized = false;  ///< it declares KHR_mesh_quantization, so that attributes may be integers

    /// The objects of a kind, such as "meshes"; empty if there are none.
    [[nodiscard]] const Json& all(std::string_view list) const { return list_in(json, list); }
    /// One of them.
    [[nodiscard]] const Json& at(std::string_view list, int index) const {
        return all(list)[static_cast<std::size_t>(index)];
    }
};

/// Parses and checks .gltf or .glb, distinguished by their first bytes, and loads the buffers. Throws
/// SceneError for malformed data, and std::runtime_error for text that is no JSON; extensions that are not
/// supported are warnings. The document refers to `bytes`.
///
/// TinyGLTF, which the tests compare this with, skips members of a wrong type without a word, copies the
/// binary chunk for each buffer without a URI, and refuses what only Draco or meshoptimizer can fill.
[[nodiscard]] Document read_document(Bytes bytes, ImportFiles& files, ImportBudget& budget);

}  // namespace candela::gltf
