#include "sandbox/editing/history.hpp"

#include <algorithm>
#include <variant>

namespace candela::sandbox {

namespace {

template <class C>
std::optional<C> copy_of(const World& world, Entity entity) {
    const auto* component = world.find<C>(entity);
    return component != nullptr ? std::optional(*component) : std::nullopt;
}

template <class C>
void set_or_remove(World& world, Entity entity, const std::optional<C>& component) {
    if (component) {
        world.set(entity, *component);
    } else {
        world.remove<C>(entity);
    }
}

template <class Light>
std::optional<Light> light_in(const std::vector<AnyLight>& lights) {
    for (const AnyLight& light : lights) {
        if (const auto* of_kind = std::get_if<Light>(&light)) return *of_kind;
    }
    return std::nullopt;
}

void set_states(World& world, const EntityStates& states) {
    for (const auto& [entity, state] : states) set_state(world, entity, state);
}

std::vector<Entity> entities_of(const EntityStates& states) {
    std::vector<Entity> entities;
    entities.reserve(states.size());
    for (const auto& [entity, state] : states) entities.push_back(entity);
    return entities;
}

}  // namespace

EntityState state_of(const World& world, Entity entity) {
    std::vector<AnyLight> lights;
    visit_lights_of(world, entity, [&](const auto& light) { lights.emplace_back(light); });
    return {copy_of<Name>(world, entity),
            copy_of<Transform>(world, entity),
            std::move(lights),
            copy_of<MeshInstance>(world, entity),
            copy_of<Environment>(world, entity),
            copy_of<Camera>(world, entity)};
}

void set_state(World& world, Entity entity, const EntityState& state) {
    set_or_remove(world, entity, state.name);
    set_or_remove(world, entity, state.transform);
    for_each_light_kind([&]<class Light>(const LightTraits<Light>&) {
        set_or_remove(world, entity, light_in<Light>(state.lights));
    });
    set_or_remove(world, entity, state.mesh_instance);
    set_or_remove(world, entity, state.environment);
    set_or_remove(world, entity, state.camera);
}

EntityStates states_of(const World& world, const std::vector<Entity>& entities) {
    EntityStates states;
    states.reserve(entities.size());
    for (const Entity entity : entities) states.emplace_back(entity, state_of(world, entity));
    return states;
}

void History::begin(const World& world, std::string name, const std::vector<Entity>& entities) {
    commit(world);
    open_ = Open{std::move(name), states_of(world, entities)};
}

void History::commit(const World& world) {
    if (!open_) return;
    Open edit = *std::exchange(open_, std::nullopt);
    keep(world, std::move(edit.name), std::move(edit.before), false);
}

void History::cancel(World& world) {
    if (!open_) return;
    set_states(world, std::exchange(open_, std::nullopt)->before);
}

void History::record(const World& world, std::string name, EntityStates before) {
    keep(world, std::move(name), std::move(before), true);
}

bool History::joins(const std::string& name, const EntityStates& before) const {
    return joins_ && !done_.empty() && done_.back().name == name &&
           entities_of(done_.back().before) == entities_of(before);
}

void History::keep(const World& world, std::string name, EntityStates before, bool may_join) {
    EntityStates after = states_of(world, entities_of(before));
    if (after == before) return;
    undone_.clear();
    if (may_join && joins(name, before)) {
        done_.back().after = std::move(after);
        return;
    }
    done_.push_back({std::move(name), std::move(before), std::move(after)});
    joins_ = may_join;
    if (done_.size() > most_) done_.pop_front();
}

std::vector<Entity> History::undo(World& world) {
    commit(world);
    if (done_.empty()) return {};
    joins_ = false;
    undone_.push_back(std::move(done_.back()));
    done_.pop_back();
    set_states(world, undone_.back().before);
    return entities_of(undone_.back().before);
}

std::vector<Entity> History::redo(World& world) {
    commit(world);
    if (undone_.empty()) return {};
    joins_ = false;
    done_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    set_states(world, done_.back().after);
    return entities_of(done_.back().after);
}

std::optional<std::string_view> History::undo_name() const {
    return done_.empty() ? std::nullopt : std::optional<std::string_view>(done_.back().name);
}

std::optional<std::string_view> History::redo_name() const {
    return undone_.empty() ? std::nullopt : std::optional<std::string_view>(undone_.back().name);
}

}  // namespace candela::sandbox
