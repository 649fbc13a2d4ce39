#pragma once

#include <concepts>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/component.hpp>
#include <candela/ecs/entity.hpp>
#include <candela/ecs/entity_table.hpp>
#include <candela/ecs/pool.hpp>
#include <candela/ecs/storage.hpp>
#include <candela/ecs/view.hpp>
#include <candela/ecs/world_reads.hpp>

namespace candela {

/// Entities and their components, with the tick of the last change of each component of each entity and of
/// each pool (all components of one type). A value type: copies are independent and keep entities and ticks.
/// No two changes in a process have the same tick, so pools with equal revisions have equal content, also in
/// different worlds. Not synchronised, but different worlds may be changed by different threads. A world that
/// was moved from may only be assigned to or destroyed. The functions that read it are those of WorldReads.
///
/// All functions that take an Entity, except `alive` and `create`, throw EntityError if the entity is not
/// alive.
class CANDELA_API World : public WorldReads<World> {
 public:
    World() = default;
    World(const World& other);
    World(World&&) noexcept = default;
    World& operator=(const World& other);
    World& operator=(World&&) noexcept = default;
    ~World() = default;

    [[nodiscard]] Entity create() { return entities_.create(); }
    /// For hosts that mirror entities of their own: creates an entity with the hint's index and generation if
    /// no live entity has the index, else, and for the null entity, any other. The host answers for it that
    /// nobody holds an older handle that is equal. Takes memory for all indices up to the hint's. EntityError
    /// if no entity may have the generation: generations are odd, and less than 2³² - 1.
    [[nodiscard]] Entity create(Entity hint) { return entities_.create(hint); }
    /// Also removes its components; together this counts as one change.
    void destroy(Entity entity);

    /// Inserts or replaces. If C has operator== and the value equals the current one, nothing changes, the
    /// ticks included.
    template <Component C>
    void set(Entity entity, C value) {
        storage<C>().set(entity, std::move(value));
    }

    /// Nothing happens if the entity has no C.
    template <Component C>
    void remove(Entity entity) {
        storage<C>().remove(entity);
    }

    /// Calls `change(C&)` with a copy of the component and then sets the component to the copy, as `set`
    /// does. If `change` throws, nothing changes. EntityError if the entity has no C.
    ///
    /// A C that can neither be compared nor copied bit by bit is not copied: `change` gets the component
    /// itself, which counts as changed and, if `change` throws, stays as it is then. `change` must not change
    /// other Cs of the world.
    template <Component C, std::invocable<C&> F>
    void edit(Entity entity, F&& change) {
        storage<C>().edit(entity, std::forward<F>(change));
    }

    using WorldReads::revision;
    /// Tick of the last change in any pool; 0 if never.
    [[nodiscard]] Tick revision() const { return ticks_.last(); }

    using WorldReads::storage;
    /// All components of type C, to be read and changed.
    template <Component C>
    [[nodiscard]] Storage<C> storage() {
        return {entities_, pool<C>(), &ticks_};
    }

 private:
    friend WorldReads<World>;
    friend class WorldReader;

    [[nodiscard]] const EntityTable& entity_table() const { return entities_; }

    template <Component C>
    [[nodiscard]] const Pool<C>& pool() const;
    template <Component C>
    [[nodiscard]] Pool<C>& pool();

    EntityTable entities_;
    std::vector<std::unique_ptr<PoolBase>> pools_;  // by component_index; null: never used
    Ticks ticks_;
};

template <Component C>
const Pool<C>& World::pool() const {
    const std::size_t index = component_index<C>();
    if (index < pools_.size() && pools_[index]) return static_cast<const Pool<C>&>(*pools_[index]);
    return Pool<C>::none();
}

template <Component C>
Pool<C>& World::pool() {
    const std::size_t index = component_index<C>();
    if (index >= pools_.size()) pools_.resize(index + 1);
    std::unique_ptr<PoolBase>& pool = pools_[index];
    if (!pool) pool = std::make_unique<Pool<C>>();
    return static_cast<Pool<C>&>(*pool);
}

}  // namespace candela
