#pragma once

#include <string>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/tools/scene_rays.hpp>

namespace candela::sandbox {

/// A light inside a closed object, which lets none of its light out.
struct EnclosedLight {
    Entity light;
    Entity object;
    bool operator==(const EnclosedLight&) const = default;
};

/// Of the first thousand lights that have a position and cast shadows, those inside closed objects.
[[nodiscard]] std::vector<EnclosedLight> enclosed_lights(const World& world,
                                                         const tools::SceneRays& surfaces);

/// One line that tells of them; empty if there are none.
[[nodiscard]] std::string words_of(const World& world, const std::vector<EnclosedLight>& enclosed);

}  // namespace candela::sandbox
