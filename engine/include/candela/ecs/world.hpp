#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <typeindex>
#include <unordered_map>
#include <utility>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/component.hpp>
#include <candela/ecs/entity.hpp>
#include <candela/ecs/pool.hpp>
#include <candela/ecs/view.hpp>

namespace candela {

/// Entities and their components, with the tick of the last change of each component of each entity and of
/// each pool (all components of one type). A value type: copies are independent and keep entities and ticks.
/// No two changes in a process have the same tick, so pools with equal revisions have equal content, also in
/// different worlds. Not synchronised, but different worlds may be changed by different threads. A world that
/// was moved from may only be assigned to or destroyed.
///
/// All functions that take an Entity, except `alive`, throw EntityError if the entity is not alive.
class CANDELA_API World {
 public:
    World() = default;
    World(const World& other);
    World(World&&) noexcept = default;
    World& operator=(const World& other);
    World& operator=(World&&) noexcept = default;
    ~World() = default;

    [[nodiscard]] Entity create();
    /// Also removes its components; together this counts as one change.
    void destroy(Entity entity);
    [[nodiscard]] bool alive(Entity entity) const;
    /// Number of live entities.
    [[nodiscard]] std::size_t size() const { return live_; }

    /// Inserts or replaces. If C has operator== and the value equals the current one, nothing changes, the
    /// ticks included.
    template <Component C>
    void set(Entity entity, C value);

    /// Nothing happens if the entity has no C.
    template <Component C>
    void remove(Entity entity);

    /// Calls `change(C&)` with a copy of the component and then sets the component to the copy, as `set`
    /// does. If `change` throws, nothing changes. EntityError if the entity has no C.
    template <Component C, std::invocable<C&> F>
    void edit(Entity entity, F&& change);

    /// Null if the entity has no C. Valid until any C of the world changes.
    template <Component C>
    [[nodiscard]] const C* find(Entity entity) const;

    /// EntityError if the entity has no C. Valid until any C of the world changes.
    template <Component C>
    [[nodiscard]] const C& get(Entity entity) const;

    template <Component C>
    [[nodiscard]] bool has(Entity entity) const {
        return find<C>(entity) != nullptr;
    }

    /// Tick at which the entity's C last changed; 0 if it has none.
    template <Component C>
    [[nodiscard]] Tick changed(Entity entity) const;

    /// Tick at which a C was last inserted, changed or removed; 0 if never.
    template <Component C>
    [[nodiscard]] Tick revision() const;

    /// The entities whose C was inserted, changed or removed since the pool's revision was `tick`, oldest
    /// change first, an entity as often as it was changed. Nullopt if `tick` is none of the pool's revisions,
    /// or one so long ago that not all changes since are known: then anything may have changed. At least the
    /// last thousand are known, or, if that is more, as many as a quarter of the pool. Valid until any C of
    /// the world changes.
    template <Component C>
    [[nodiscard]] std::optional<std::span<const Change>> changes_since(Tick tick) const;

    /// The entities that have a C, in the order of `view<C>()`. Valid until any C of the world changes.
    template <Component C>
    [[nodiscard]] std::span<const Entity> entities() const;

    /// Place of the entity in `entities<C>()`; nullopt if it has no C.
    template <Component C>
    [[nodiscard]] std::optional<std::uint32_t> place(Entity entity) const;

    /// Tick of the last change in any pool; 0 if never.
    [[nodiscard]] Tick revision() const { return tick_; }

    /// Number of entities that have a C.
    template <Component C>
    [[nodiscard]] std::size_t count() const;

    /// The entities that have every one of `Cs`; see View for the order and for what invalidates it.
    template <Component C, Component... Cs>
    [[nodiscard]] View<C, Cs...> view() const {
        return View<C, Cs...>(pool<C>(), pool<Cs>()...);
    }

 private:
    void require_alive(Entity entity, std::string_view component) const;
    [[nodiscard]] static Tick next_tick();

    template <Component C>
    [[nodiscard]] const Pool<C>* pool() const;

    // Per index: its generation, which is odd while an entity uses the index. An Entity with an even
    // generation is never alive, so not even an invented handle can refer to a free index.
    std::vector<std::uint32_t> generations_;
    std::vector<std::uint32_t> free_;
    std::size_t live_ = 0;
    std::unordered_map<std::type_index, std::unique_ptr<PoolBase>> pools_;
    Tick tick_ = 0;
};

template <Component C>
const Pool<C>* World::pool() const {
    const auto found = pools_.find(typeid(C));
    return found == pools_.end() ? nullptr : static_cast<const Pool<C>*>(found->second.get());
}

template <Component C>
void World::set(Entity entity, C value) {
    require_alive(entity, component_name<C>());
    auto& pool = pools_[typeid(C)];
    if (!pool) pool = std::make_unique<Pool<C>>();
    const Tick now = next_tick();
    if (static_cast<Pool<C>&>(*pool).set(entity, std::move(value), now)) tick_ = now;
}

template <Component C>
void World::remove(Entity entity) {
    require_alive(entity, component_name<C>());
    const auto pool = pools_.find(typeid(C));
    const Tick now = next_tick();
    if (pool != pools_.end() && pool->second->remove(entity, now)) tick_ = now;
}

template <Component C, std::invocable<C&> F>
void World::edit(Entity entity, F&& change) {
    C value = get<C>(entity);
    std::forward<F>(change)(value);
    set<C>(entity, std::move(value));
}

template <Component C>
const C* World::find(Entity entity) const {
    require_alive(entity, component_name<C>());
    const Pool<C>* components = pool<C>();
    return components ? components->find(entity) : nullptr;
}

template <Component C>
const C& World::get(Entity entity) const {
    const C* component = find<C>(entity);
    if (!component) throw EntityError::lacks(entity, component_name<C>());
    return *component;
}

template <Component C>
Tick World::changed(Entity entity) const {
    require_alive(entity, component_name<C>());
    const Pool<C>* components = pool<C>();
    return components ? components->changed(entity) : 0;
}

template <Component C>
Tick World::revision() const {
    const Pool<C>* components = pool<C>();
    return components ? components->revision() : 0;
}

template <Component C>
std::optional<std::span<const Change>> World::changes_since(Tick tick) const {
    const Pool<C>* components = pool<C>();
    if (components) return components->changes().since(tick);
    return tick == 0 ? std::optional(std::span<const Change>()) : std::nullopt;
}

template <Component C>
std::span<const Entity> World::entities() const {
    const Pool<C>* components = pool<C>();
    return components ? std::span(components->entities()) : std::span<const Entity>();
}

template <Component C>
std::optional<std::uint32_t> World::place(Entity entity) const {
    require_alive(entity, component_name<C>());
    const Pool<C>* components = pool<C>();
    return components ? components->place(entity) : std::nullopt;
}

template <Component C>
std::size_t World::count() const {
    const Pool<C>* components = pool<C>();
    return components ? components->entities().size() : 0;
}

}  // namespace candela
