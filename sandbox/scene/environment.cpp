#include "sandbox/scene/environment.hpp"

#include <fmt/format.h>

#include <candela/scene/components.hpp>
#include <candela/scene/sky_picture.hpp>

namespace candela::sandbox {

namespace {

bool has_light(const World& world) {
    for (const auto& [entity, instance] : world.view<MeshInstance>()) {
        if (emits(*instance.mesh)) return true;
    }
    std::size_t lights = world.count<Environment>();
    for_each_light_kind([&]<class Light>(const LightTraits<Light>&) { lights += world.count<Light>(); });
    return lights > 0;
}

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

void light_if_dark(Scene& scene) {
    if (has_light(scene.world)) return;
    set_environment(scene.world, {.radiance = default_sky, .picture = nullptr});
    scene.warnings.push_back(
        fmt::format("the scene has no light: it is shown under a sky of radiance {}", default_sky.r));
}

}  // namespace candela::sandbox
