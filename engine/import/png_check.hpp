#pragma once

#include <cstdint>

#include "engine/import/import_files.hpp"

namespace candela::gltf {

/// Throws SceneError if a chunk of the PNG is longer than what is left of it, or if its compressed data grow
/// to more bytes than width x height pixels can have. A decoder would allocate what they claim.
void check_png(Bytes png, std::uint64_t width, std::uint64_t height);

}  // namespace candela::gltf
