#include "renderer/tools/reference/scene.hpp"

#include <candela/scene/hierarchy.hpp>
#include "renderer/tools/reference/scene_content.hpp"

namespace candela::reference {

namespace {

std::vector<PlacedCamera> cameras_of(const World& world) {
    std::vector<PlacedCamera> cameras;
    for (auto [entity, camera] : world.view<Camera>()) {
        cameras.push_back({entity, camera, world_matrix(world, entity)});
    }
    return cameras;
}

}  // namespace

SceneContent::SceneContent(const World& world)
    : geometry(world),
      emitters(geometry),
      lights(lights_of(world)),
      emission(lights, geometry.bounds()),
      sky(world),
      cameras(cameras_of(world)) {}

Scene::Scene(const World& world) : content_(std::make_unique<SceneContent>(world)) {}

Scene::~Scene() = default;
Scene::Scene(Scene&& other) noexcept = default;
Scene& Scene::operator=(Scene&& other) noexcept = default;

}  // namespace candela::reference
