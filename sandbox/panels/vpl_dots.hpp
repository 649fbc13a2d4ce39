#pragma once

#include <functional>
#include <vector>

#include "sandbox/editing/viewport.hpp"
#include "sandbox/window/frame_request.hpp"

namespace candela::sandbox {

/// Whether nothing hides a world-space point from the eye.
using IsVisible = std::function<bool(const glm::vec3& point)>;

/// Draws each VPL as a dot in the colour of its flux, larger the more flux it has; those that walls hide are
/// left out. The one under the pointer is drawn with its normal and a disc of its cell's area, and its values
/// are shown.
void draw_vpl_dots(const std::vector<VplDot>& dots, const Viewport& viewport, const IsVisible& is_visible);

}  // namespace candela::sandbox
