#include "sandbox/editing/objects.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <set>
#include <variant>
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

/// The strength of a new light of this kind: see add_light.
template <class Light>
float usual_strength(const World& world, float reach) {
    float most = 0.0F;
    for (auto [entity, light] : world.view<Light>()) most = std::max(most, strength_of(light));
    if (most > 0.0F) return most;
    constexpr float lux = 2.0F;
    return light_traits<Light>.has_position ? lux * reach * reach : lux;
}

bool has_children(const World& world, Entity entity) {
    for (auto [child, transform] : world.view<Transform>()) {
        if (transform.parent == entity) return true;
    }
    return false;
}

}  // namespace

bool is_light(const World& world, Entity entity) {
    bool found = false;
    visit_lights_of(world, entity, [&](const auto& /*light*/) { found = true; });
    return found;
}

bool has_direction(const World& world, Entity entity) {
    bool found = false;
    visit_lights_of(world, entity,
                    [&]<class Light>(const Light&) { found |= light_traits<Light>.has_direction; });
    return found;
}

bool has_place(const World& world, Entity entity) {
    bool found = false;
    visit_lights_of(world, entity,
                    [&]<class Light>(const Light&) { found |= light_traits<Light>.has_position; });
    return found || !is_light(world, entity);
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

Entity add_light(World& world, History& history, const AnyLight& light, const glm::vec3& position,
                 const glm::vec3& direction, float reach) {
    const Entity entity = world.create();
    const auto add = [&]<class Light>(Light added) {
        const LightTraits<Light>& kind = light_traits<Light>;
        history.begin(world, fmt::format("add {}", kind.name), {entity});
        world.set(entity, Name{unique_name(world, kind.name)});
        strength_of(added) = usual_strength<Light>(world, reach);
        world.set(entity, added);
        move_to(world, entity, position);
        if (kind.has_direction) aim(world, entity, direction);
    };
    std::visit(add, light);
    history.commit(world);
    return entity;
}

std::string title_of(const World& world, std::span<const Entity> entities) {
    if (entities.size() == 1) return name_of(world, entities.front());
    return fmt::format("{} objects", entities.size());
}

std::vector<Entity> roots_of(const World& world, std::span<const Entity> entities) {
    const std::set<Entity> all(entities.begin(), entities.end());
    const auto parent_of = [&](Entity entity) { return transform_of(world, entity).parent; };
    const auto is_below = [&](Entity entity) {
        std::set<Entity> passed{entity};  // parents may form a cycle
        for (Entity at = parent_of(entity); at && passed.insert(at).second; at = parent_of(at)) {
            if (all.contains(at)) return true;
        }
        return false;
    };
    std::vector<Entity> roots;
    std::ranges::copy_if(entities, std::back_inserter(roots),
                         [&](Entity entity) { return !is_below(entity); });
    return roots;
}

std::vector<Entity> duplicate(World& world, History& history, std::span<const Entity> entities,
                              const glm::vec3& offset) {
    std::map<Entity, Entity> copies;
    std::vector<Entity> created;
    for (const Entity entity : entities) {
        for (const Entity original : family_of(world, entity)) {
            created.push_back(world.create());
            copies[original] = created.back();
        }
    }
    history.begin(world, "copy " + title_of(world, entities), created);
    for (const auto& [original, copy] : copies) {
        EntityState state = state_of(world, original);
        if (state.name) state.name = Name{unique_name(world, state.name->value)};
        if (state.transform && copies.contains(state.transform->parent)) {
            state.transform->parent = copies.at(state.transform->parent);
        }
        set_state(world, copy, state);
    }
    std::vector<Entity> of_entities;
    for (const Entity entity : entities) {
        const Entity copy = copies.at(entity);
        move_to(world, copy, position_of(world, copy) + offset);
        of_entities.push_back(copy);
    }
    history.commit(world);
    return of_entities;
}

Entity duplicate(World& world, History& history, Entity entity, const glm::vec3& offset) {
    return duplicate(world, history, std::span(&entity, 1), offset).front();
}

void remove(World& world, History& history, std::span<const Entity> entities) {
    history.begin(world, "delete " + title_of(world, entities), {entities.begin(), entities.end()});
    for (const Entity entity : entities) {
        EntityState rest;
        if (has_children(world, entity)) rest.transform = transform_of(world, entity);
        set_state(world, entity, rest);
    }
    history.commit(world);
}

void remove(World& world, History& history, Entity entity) {
    remove(world, history, std::span(&entity, 1));
}

}  // namespace candela::sandbox
