#pragma once

#include <vector>

#include <candela/scene/components.hpp>
#include "renderer/tools/reference/emission.hpp"
#include "renderer/tools/reference/emitters.hpp"
#include "renderer/tools/reference/geometry.hpp"
#include "renderer/tools/reference/lights.hpp"
#include "renderer/tools/reference/sky.hpp"

namespace candela::reference {

struct PlacedCamera {
    Entity entity;
    Camera camera;
    glm::mat4 to_world;
};

/// The contents of a Scene.
struct SceneContent {
    explicit SceneContent(const World& world);

    Geometry geometry;
    Emitters emitters;
    std::vector<Light> lights;
    Emission emission;
    SkyLight sky;
    std::vector<PlacedCamera> cameras;
};

}  // namespace candela::reference
