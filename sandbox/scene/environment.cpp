#include "sandbox/scene/environment.hpp"

#include <candela/scene/components.hpp>
#include <candela/scene/sky_picture.hpp>

namespace candela::sandbox {

namespace {

Environment to_environment(const SkyChoice& choice) {
    if (const auto* radiance = std::get_if<glm::vec3>(&choice)) {
        return {.radiance = *radiance, .picture = nullptr};
    }
    return {.radiance = glm::vec3(1.0F),
            .picture = load_sky_picture(std::get<std::filesystem::path>(choice))};
}

}  // namespace

Entity environment_entity(const World& world) {
    for (auto [entity, environment] : world.view<Environment>()) return entity;
    return {};
}

void set_environment(World& world, const Environment& environment) {
    for (Entity old = environment_entity(world); old != Entity{}; old = environment_entity(world)) {
        world.remove<Environment>(old);
    }
    const Entity entity = world.create();
    world.set(entity, Name{"environment"});
    world.set(entity, environment);
}

void set_sky(Scene& scene, const SkyChoice& choice) {
    set_environment(scene.world, to_environment(choice));
}

}  // namespace candela::sandbox
