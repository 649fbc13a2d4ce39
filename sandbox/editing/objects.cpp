#include "sandbox/editing/objects.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>

#include <candela/scene/components.hpp>
#include "sandbox/editing/placing.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

/// The name without a number after its last space.
std::string stem_of(const std::string& name) {
    const std::size_t end = name.find_last_not_of("0123456789");
    const bool numbered = end != std::string::npos && end > 0 && end + 1 < name.size() && name[end] == ' ';
    return numbered ? name.substr(0, end) : name;
}

template <class Light>
float brightest(const World& world, float Light::*strength, float otherwise) {
    float most = 0.0F;
    for (auto [entity, light] : world.view<Light>()) most = std::max(most, light.*strength);
    return most > 0.0F ? most : otherwise;
}

void set_light(World& world, Entity entity, LightKind kind, float reach) {
    constexpr float lux = 2.0F;
    const float candela = lux * reach * reach;
    switch (kind) {
        case LightKind::point:
            world.set(entity, PointLight{.intensity = brightest(world, &PointLight::intensity, candela)});
            break;
        case LightKind::spot:
            world.set(entity, SpotLight{.intensity = brightest(world, &SpotLight::intensity, candela)});
            break;
        case LightKind::directional:
            world.set(entity,
                      DirectionalLight{.illuminance = brightest(world, &DirectionalLight::illuminance, lux)});
            break;
    }
}

std::string kind_name(LightKind kind) {
    switch (kind) {
        case LightKind::point:
            return "point light";
        case LightKind::spot:
            return "spot light";
        case LightKind::directional:
            break;
    }
    return "directional light";
}

bool has_children(const World& world, Entity entity) {
    for (auto [child, transform] : world.view<Transform>()) {
        if (transform.parent == entity) return true;
    }
    return false;
}

}  // namespace

bool is_light(const World& world, Entity entity) {
    return world.has<PointLight>(entity) || has_direction(world, entity);
}

bool has_direction(const World& world, Entity entity) {
    return world.has<SpotLight>(entity) || world.has<DirectionalLight>(entity);
}

bool is_present(const World& world, Entity entity) {
    return world.alive(entity) && state_of(world, entity) != EntityState();
}

std::string unique_name(const World& world, const std::string& wanted) {
    std::set<std::string> taken;
    for (auto [entity, name] : world.view<Name>()) taken.insert(name.value);
    if (!taken.contains(wanted)) return wanted;
    const std::string stem = stem_of(wanted);
    int number = 2;
    while (taken.contains(fmt::format("{} {}", stem, number))) ++number;
    return fmt::format("{} {}", stem, number);
}

Entity add_light(World& world, History& history, LightKind kind, const glm::vec3& position,
                 const glm::vec3& direction, float reach) {
    const Entity light = world.create();
    history.begin(world, "add " + kind_name(kind), {light});
    world.set(light, Name{unique_name(world, kind_name(kind))});
    set_light(world, light, kind, reach);
    move_to(world, light, position);
    if (kind != LightKind::point) aim(world, light, direction);
    history.commit(world);
    return light;
}

Entity duplicate(World& world, History& history, Entity entity, const glm::vec3& offset) {
    const std::vector<Entity> originals = family_of(world, entity);
    std::map<Entity, Entity> copies;
    std::vector<Entity> created;
    for (const Entity original : originals) {
        created.push_back(world.create());
        copies[original] = created.back();
    }
    history.begin(world, "copy " + name_of(world, entity), created);
    for (const auto& [original, copy] : copies) {
        EntityState state = state_of(world, original);
        if (state.name) state.name = Name{unique_name(world, state.name->value)};
        if (state.transform && copies.contains(state.transform->parent))
            state.transform->parent = copies.at(state.transform->parent);
        set_state(world, copy, state);
    }
    const Entity copy = copies.at(entity);
    move_to(world, copy, position_of(world, copy) + offset);
    history.commit(world);
    return copy;
}

void remove(World& world, History& history, Entity entity) {
    history.begin(world, "delete " + name_of(world, entity), {entity});
    EntityState rest;
    if (has_children(world, entity)) rest.transform = transform_of(world, entity);
    set_state(world, entity, rest);
    history.commit(world);
}

}  // namespace candela::sandbox
