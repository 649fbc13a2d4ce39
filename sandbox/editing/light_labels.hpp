#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/tools/scene_rays.hpp>
#include "sandbox/editing/viewport.hpp"

namespace candela::sandbox {

/// The marker of a light, to be drawn.
struct LightLabel {
    Entity entity;
    std::string name;          ///< to be shown; empty for lights that are neither hovered nor selected
    glm::vec2 position{0.0F};  ///< window coordinates
    glm::vec3 colour{1.0F};    ///< linear
    bool hidden = false;       ///< behind a surface
    bool hovered = false;
    bool selected = false;
};

/// The labels of the lights that the picture shows, in the order in which they are drawn: hidden ones first,
/// the hovered and the selected one last.
[[nodiscard]] std::vector<LightLabel> light_labels(const World& world, const Viewport& viewport,
                                                   const tools::SceneRays& surfaces,
                                                   std::optional<Entity> hovered,
                                                   std::optional<Entity> selected);

}  // namespace candela::sandbox
