#pragma once

#include <cstddef>
#include <string>

#include <candela/inspection.hpp>
#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// Draws a resource of the frame graph in place of the picture: as a picture, fitted into the rectangle, or,
/// if it is a buffer, as numbers. Below it are the controls that change `inspection`.
void draw_resource(const std::string& name, Inspection& inspection, const InspectionResult& result,
                   const BufferElements& elements, const Rectangle& scene);

/// The numbers of a field of an element that was read: whole ones with all digits, others with four.
[[nodiscard]] std::string words_of(const BufferElements& elements, const ElementField& field,
                                   std::size_t index);

}  // namespace candela::sandbox
