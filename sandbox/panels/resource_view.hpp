#pragma once

#include <string>

#include <candela/inspection.hpp>
#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// Draws a resource of the frame graph in place of the picture: as a picture, fitted into the rectangle, or,
/// if it is a buffer, as numbers. Below it are the controls that change `inspection`.
void draw_resource(const std::string& name, Inspection& inspection, const InspectionResult& result,
                   const BufferElements& elements, const Rectangle& scene);

}  // namespace candela::sandbox
