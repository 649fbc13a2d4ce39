#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sandbox/editing/viewport.hpp"
#include "sandbox/window/frame_request.hpp"
#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// Whether nothing hides a world-space point from the eye.
using IsVisible = std::function<bool(const glm::vec3& point)>;

/// Draws each VPL as a dot in the colour of its flux, larger the more flux it has; those that walls hide are
/// left out. The one under the pointer, and the chosen one, are drawn with their normals and discs of their
/// cells' areas; the values of the former are shown, and lines lead from the latter to its neighbours. A
/// click on a dot chooses it.
void draw_vpl_dots(const std::vector<VplDot>& dots, const Viewport& viewport, const IsVisible& is_visible,
                   std::optional<glm::vec3>& chosen);

/// Draws the details of the VPL with this index in the upper left corner of the picture. `words`: of it.
/// Closed by the user, it ends the choice.
void draw_vpl_details(std::size_t index, const std::string& words, std::optional<glm::vec3>& chosen,
                      const Rectangle& scene);

}  // namespace candela::sandbox
