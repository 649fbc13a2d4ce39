#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <candela/inspection.hpp>
#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// Draws a resource of the frame graph in place of the picture: as a picture, fitted into the rectangle, or,
/// if it is a buffer, as numbers. Over it are the controls that change `inspection`, the values of the texel
/// under the pointer, and a histogram.
void draw_resource(const std::string& name, Inspection& inspection, const InspectionResult& result,
                   const BufferElements& elements, const Rectangle& scene);

/// The texel of an inspected texture, or the tile, that a picture in this rectangle of the window shows under
/// a pointer; nullopt beside it.
[[nodiscard]] std::optional<glm::uvec2> texel_at(const InspectionResult& result, const Rectangle& picture,
                                                 glm::vec2 pointer);

/// Where the texel is, and its values by channel, for example "texel 5, 3: 0.25 1 0".
[[nodiscard]] std::string words_of(const InspectedTexel& texel, std::string_view unit);

/// The numbers of a field of an element that was read: whole ones with all digits, others with four.
[[nodiscard]] std::string words_of(const BufferElements& elements, const ElementField& field,
                                   std::size_t index);

}  // namespace candela::sandbox
