#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/component.hpp>
#include <candela/ecs/entity.hpp>

namespace candela {

/// Counts the changes of a world, from 1; 0 means never.
using Tick = std::uint64_t;

/// One component was inserted, changed or removed.
struct Change {
    Tick tick;
    Entity entity;
};

/// The last changes of a pool, oldest first: at least the last thousand or, if that is more, as many as a
/// quarter of its components.
class CANDELA_API ChangeLog {
 public:
    /// `components`: how many the pool has.
    void add(Change change, std::size_t components);
    /// All that came after the tick of a change, or after 0; nullopt if that change is not known any more or
    /// was never one of this pool. Valid until the next `add`.
    [[nodiscard]] std::optional<std::span<const Change>> since(Tick tick) const;

 private:
    std::vector<Change> changes_;
    Tick before_ = 0;  // tick of the last change that was dropped
};

/// The operations on a pool that do not depend on its component type.
class CANDELA_API PoolBase {
 public:
    PoolBase() = default;
    PoolBase& operator=(const PoolBase&) = delete;
    virtual ~PoolBase() = default;

    [[nodiscard]] virtual std::unique_ptr<PoolBase> clone() const = 0;

    /// Removes the entity's component at tick `now`. If it has none, returns false and changes no tick.
    virtual bool remove(Entity entity, Tick now) = 0;

 protected:
    PoolBase(const PoolBase&) = default;
};

/// The components of one type, packed: `values_[i]` belongs to `entities_[i]` and last changed at
/// `ticks_[i]`. Finding, inserting and removing take constant time; removing moves the last component into
/// the gap.
template <Component C>
class Pool final : public PoolBase {
 public:
    [[nodiscard]] std::unique_ptr<PoolBase> clone() const override { return std::make_unique<Pool>(*this); }

    /// Inserts or replaces at tick `now`. If the entity already has an equal value, returns false and changes
    /// no tick.
    bool set(Entity entity, C value, Tick now) {
        const std::uint32_t at = position(entity);
        if (at == absent) {
            insert(entity, std::move(value), now);
        } else {
            if (equal(values_[at], value)) return false;
            values_[at] = std::move(value);
            ticks_[at] = now;
        }
        note_change(entity, now);
        return true;
    }

    bool remove(Entity entity, Tick now) override {
        const std::uint32_t at = position(entity);
        if (at == absent) return false;
        positions_[entities_.back().index] = at;
        positions_[entity.index] = absent;
        move_last_to(values_, at);
        move_last_to(ticks_, at);
        move_last_to(entities_, at);
        note_change(entity, now);
        return true;
    }

    /// Null if the entity has none. Valid until the next change of the pool.
    [[nodiscard]] const C* find(Entity entity) const {
        const std::uint32_t at = position(entity);
        return at == absent ? nullptr : &values_[at];
    }

    /// Tick at which the entity's component last changed; 0 if it has none.
    [[nodiscard]] Tick changed(Entity entity) const {
        const std::uint32_t at = position(entity);
        return at == absent ? 0 : ticks_[at];
    }

    [[nodiscard]] Tick revision() const { return revision_; }
    [[nodiscard]] const std::vector<Entity>& entities() const { return entities_; }
    /// Place of the entity in `entities`; nullopt if it has no component.
    [[nodiscard]] std::optional<std::uint32_t> place(Entity entity) const {
        const std::uint32_t at = position(entity);
        return at == absent ? std::nullopt : std::optional(at);
    }
    [[nodiscard]] const ChangeLog& changes() const { return changes_; }

 private:
    static constexpr std::uint32_t absent = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] std::uint32_t position(Entity entity) const {
        return entity.index < positions_.size() ? positions_[entity.index] : absent;
    }

    void insert(Entity entity, C value, Tick now) {
        if (entity.index >= positions_.size()) positions_.resize(std::size_t{entity.index} + 1, absent);
        positions_[entity.index] = static_cast<std::uint32_t>(entities_.size());
        entities_.push_back(entity);
        values_.push_back(std::move(value));
        ticks_.push_back(now);
    }

    void note_change(Entity entity, Tick now) {
        revision_ = now;
        changes_.add({now, entity}, entities_.size());
    }

    [[nodiscard]] static bool equal(const C& a, const C& b) {
        if constexpr (std::equality_comparable<C>) {
            return a == b;
        } else {
            return false;
        }
    }

    template <class T>
    static void move_last_to(std::vector<T>& values, std::uint32_t at) {
        if (at + 1 != values.size()) values[at] = std::move(values.back());
        values.pop_back();
    }

    std::vector<std::uint32_t> positions_;  // by entity index
    std::vector<Entity> entities_;
    std::vector<C> values_;
    std::vector<Tick> ticks_;
    Tick revision_ = 0;
    ChangeLog changes_;
};

}  // namespace candela
