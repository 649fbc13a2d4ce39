#include "sandbox/editing/light_labels.hpp"

#include <algorithm>

#include "sandbox/editing/light_picking.hpp"

namespace candela::sandbox {

namespace {

int order_of(const LightLabel& label) {
    if (label.selected) return 3;
    if (label.hovered) return 2;
    return label.hidden ? 0 : 1;
}

}  // namespace

std::vector<LightLabel> light_labels(const World& world, const Viewport& viewport,
                                     const tools::SceneRays& surfaces, std::optional<Entity> hovered,
                                     std::optional<Entity> selected) {
    std::vector<LightLabel> labels;
    for (LightMarker& marker : light_markers(world)) {
        const std::optional<glm::vec2> at = project(viewport, marker.position);
        if (!at || !viewport.contains(*at)) continue;
        LightLabel label{marker.entity,
                         {},
                         *at,
                         marker.colour,
                         false,
                         marker.entity == hovered,
                         marker.entity == selected};
        label.hidden = surfaces.blocked(ray_through(viewport, *at).origin, marker.position);
        if (label.hovered || label.selected) label.name = std::move(marker.name);
        labels.push_back(std::move(label));
    }
    std::stable_sort(labels.begin(), labels.end(),
                     [](const LightLabel& a, const LightLabel& b) { return order_of(a) < order_of(b); });
    return labels;
}

}  // namespace candela::sandbox
