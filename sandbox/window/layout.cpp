#include "sandbox/window/layout.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace candela::sandbox {

Layout make_layout(glm::vec2 window, float scale, const LayoutSettings& settings) {
    constexpr float most_share = 1.0F / 3.0F;
    constexpr float least_width = 170.0F;
    const float status = std::min(settings.status_height, window.y);
    float panel = std::floor(std::min(settings.panel_width * scale, most_share * window.x));
    if (!settings.panel || panel < least_width * scale) panel = 0.0F;

    Layout layout;
    const float button = std::min(status, window.x);
    layout.status = {{0.0F, 0.0F}, {window.x - button, status}};
    layout.panel_button = {{window.x - button, 0.0F}, {button, status}};
    layout.panel = {{window.x - panel, status}, {panel, window.y - status}};
    layout.scene = {{0.0F, status}, glm::max(glm::vec2(window.x - panel, window.y - status), 1.0F)};
    return layout;
}

}  // namespace candela::sandbox
