#pragma once

#include <candela/scene/components.hpp>
#include "engine/import/import_files.hpp"

namespace candela::gltf {

/// Whether WebP is read: libwebp was there when Candela was built.
[[nodiscard]] bool reads_webp();

/// The pixels of a PNG, JPEG or WebP, of which channels of 16 bits keep the high byte. Its size is added to
/// the budget before memory is allocated for it. Throws PieceError for what cannot be decoded, SceneError for
/// what exceeds the budget.
[[nodiscard]] Image decode_image(Bytes encoded, ImportBudget& budget);

}  // namespace candela::gltf
