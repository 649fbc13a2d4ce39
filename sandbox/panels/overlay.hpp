#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sandbox/editing/gizmo.hpp"
#include "sandbox/editing/light_labels.hpp"
#include "sandbox/panels/side_labels.hpp"
#include "sandbox/window/app_state.hpp"
#include "sandbox/window/frame_request.hpp"
#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// Draws a ring at the position of each light, fainter where a surface hides it; the names of the selected
/// light and of the one under the pointer.
void draw_lights(const std::vector<LightLabel>& lights);

/// Draws rings around window positions: of what is selected besides that which has the handles.
void draw_rings(const std::vector<glm::vec2>& positions);

/// Draws the handles of the selection; the active one is highlighted.
void draw_gizmo(const Gizmo& gizmo, std::optional<std::size_t> active);

/// Draws the line between two pictures, which a drag moves, and says which one is on which side; of their
/// difference, what it is of.
void draw_comparison(Comparison& comparison, const SideLabels& labels, const Rectangle& scene);

/// The radiance and the colour of a pixel, for example "pixel 12, 34: radiance 0.1 0.2 0.3, colour 90 110
/// 120".
[[nodiscard]] std::string words_of(const ProbedPixel& pixel);

/// Draws the words at the pointer, within the picture.
void draw_probe(const std::string& words, const Rectangle& scene);

/// Draws messages over the lower edge of the picture, also where there is no panel: what has failed, and what
/// was done last.
void draw_messages(const std::vector<std::string>& errors, const std::string& notice, const Rectangle& scene);

}  // namespace candela::sandbox
