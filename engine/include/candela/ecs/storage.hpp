#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include <candela/ecs/comparable.hpp>
#include <candela/ecs/entity_table.hpp>
#include <candela/ecs/pool.hpp>
#include <candela/ecs/view.hpp>

namespace candela {

/// The components of one type in a world, for loops over many entities: it has looked up what the functions
/// of World of the same names look up in each call. A light handle, which owns nothing.
///
///     Storage<Transform> transforms = world.storage<Transform>();
///     for (const Entity entity : moving) transforms.set(entity, {.translation = place_of(entity)});
///
/// A Storage<C> reads and changes; it is valid until the world is destroyed, moved or assigned to. A
/// Storage<const C> reads, and is valid only until any C of the world changes.
///
/// All functions that take an Entity throw EntityError if the entity is not alive.
template <class C>
requires Component<std::remove_const_t<C>>
class Storage {
    using Value = std::remove_const_t<C>;
    using PoolOfC = std::conditional_t<std::is_const_v<C>, const Pool<Value>, Pool<Value>>;

 public:
    /// All of one world; `ticks` may be null if C is const.
    Storage(const EntityTable& entities, PoolOfC& pool, Ticks* ticks)
        : table_(&entities), pool_(&pool), ticks_(ticks) {}

    /// Null if the entity has no C. Valid until any C of the world changes.
    [[nodiscard]] const Value* find(Entity entity) const {
        const std::uint32_t at = place_of(entity);
        return at == PoolBase::absent ? nullptr : &pool_->values()[at];
    }
    /// EntityError if the entity has no C. Valid until any C of the world changes.
    [[nodiscard]] const Value& get(Entity entity) const { return pool_->values()[require(entity)]; }
    [[nodiscard]] bool has(Entity entity) const { return place_of(entity) != PoolBase::absent; }

    /// Tick at which the entity's C last changed; 0 if it has none.
    [[nodiscard]] Tick changed(Entity entity) const {
        const std::uint32_t at = place_of(entity);
        return at == PoolBase::absent ? 0 : pool_->changed_at(at);
    }
    /// Tick at which a C was last inserted, changed or removed; 0 if never.
    [[nodiscard]] Tick revision() const { return pool_->revision(); }
    /// See World::changes_since.
    [[nodiscard]] std::optional<std::span<const Change>> changes_since(Tick tick) const {
        return pool_->changes().since(tick);
    }

    /// The entities that have a C, in the order of iteration. Valid until any C of the world changes.
    [[nodiscard]] std::span<const Entity> entities() const { return pool_->entities(); }
    /// Place of the entity in `entities()`; nullopt if it has no C.
    [[nodiscard]] std::optional<std::uint32_t> place(Entity entity) const {
        const std::uint32_t at = place_of(entity);
        return at == PoolBase::absent ? std::nullopt : std::optional(at);
    }

    /// Iterates over tuples (Entity, const C&), as View does.
    [[nodiscard]] auto begin() const { return View<Value>(*pool_).begin(); }
    [[nodiscard]] std::default_sentinel_t end() const { return {}; }

    /// See World::set.
    void set(Entity entity, C value) requires(!std::is_const_v<C>) {
        const std::uint32_t at = place_of(entity);
        if (at == PoolBase::absent) {
            pool_->insert(entity, std::move(value), ticks_->draw());
        } else if (!equal(pool_->values()[at], value)) {
            pool_->replace(at, entity, std::move(value), ticks_->draw());
        }
    }

    /// Nothing happens if the entity has no C.
    void remove(Entity entity) requires(!std::is_const_v<C>) {
        const std::uint32_t at = place_of(entity);
        if (at != PoolBase::absent) pool_->remove(at, ticks_->draw());
    }

    /// See World::edit.
    template <std::invocable<C&> F>
    void edit(Entity entity, F&& change) requires(!std::is_const_v<C>) {
        if constexpr (Comparable<C> || std::is_trivially_copyable_v<C>) {
            C value = get(entity);
            std::forward<F>(change)(value);
            set(entity, std::move(value));
        } else {
            std::forward<F>(change)(pool_->change(require(entity), entity, ticks_->draw()));
        }
    }

 private:
    /// An entity that has a C is alive, so that the world need not be asked.
    [[nodiscard]] std::uint32_t place_of(Entity entity) const {
        const std::uint32_t at = pool_->place_of(entity);
        if (at == PoolBase::absent) table_->require_alive(entity, component_name<Value>());
        return at;
    }
    [[nodiscard]] std::uint32_t require(Entity entity) const {
        const std::uint32_t at = place_of(entity);
        if (at == PoolBase::absent) throw EntityError::lacks(entity, component_name<Value>());
        return at;
    }

    [[nodiscard]] static bool equal(const Value& a, const Value& b) {
        if constexpr (Comparable<Value>) {
            return a == b;
        } else {
            return false;
        }
    }

    const EntityTable* table_;
    PoolOfC* pool_;
    Ticks* ticks_;
};

}  // namespace candela
