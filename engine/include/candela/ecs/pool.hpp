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

/// The ticks of one world: they ascend, and no other world of the process gets the same ones. They are taken
/// from the process's counter many at a time, because threads that change worlds would wait for each other at
/// the counter. A copy has the last tick in common with the original, and takes its next ones from the
/// counter.
class CANDELA_API Ticks {
 public:
    Ticks() = default;
    Ticks(const Ticks& other) : last_(other.last_) {}
    Ticks(Ticks&&) noexcept = default;
    Ticks& operator=(const Ticks& other) { return *this = Ticks(other); }
    Ticks& operator=(Ticks&&) noexcept = default;
    ~Ticks() = default;

    /// The tick of a change.
    [[nodiscard]] Tick draw() {
        if (last_ >= end_) take();
        return ++last_;
    }
    /// Tick of the last change; 0 if never.
    [[nodiscard]] Tick last() const { return last_; }

 private:
    void take();

    Tick last_ = 0;
    Tick end_ = 0;  // last of those taken from the counter
};

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
    void add(Change change, std::size_t components) {
        if (changes_.size() == changes_.capacity()) make_room(components);
        changes_.push_back(change);
    }
    /// Tick of the last change; 0 if never.
    [[nodiscard]] Tick last() const { return changes_.empty() ? 0 : changes_.back().tick; }
    /// All that came after the tick of a change, or after 0; nullopt if that change is not known any more or
    /// was never one of this pool. Valid until the next `add`.
    [[nodiscard]] std::optional<std::span<const Change>> since(Tick tick) const;

 private:
    void make_room(std::size_t components);

    std::vector<Change> changes_;
    Tick before_ = 0;  // tick of the last change that was dropped
};

/// What a pool knows of its components without their type: the one at place i belongs to `entities()[i]`.
/// Finding, inserting and removing take constant time; removing moves the last component into the gap.
class CANDELA_API PoolBase {
 public:
    /// The place of what is not there.
    static constexpr std::uint32_t absent = std::numeric_limits<std::uint32_t>::max();

    PoolBase() = default;
    PoolBase& operator=(const PoolBase&) = delete;
    virtual ~PoolBase() = default;

    [[nodiscard]] virtual std::unique_ptr<PoolBase> clone() const = 0;

    /// Place of the entity's component; `absent` if it has none, as when it is not alive.
    [[nodiscard]] std::uint32_t place_of(Entity entity) const {
        if (entity.index >= rows_.size()) return absent;
        const Row row = rows_[entity.index];
        return row.generation == entity.generation ? row.place : absent;
    }
    /// Tick at which the component at a place last changed.
    [[nodiscard]] Tick changed_at(std::uint32_t place) const { return ticks_[place]; }
    [[nodiscard]] Tick revision() const { return changes_.last(); }
    [[nodiscard]] const std::vector<Entity>& entities() const { return entities_; }
    [[nodiscard]] const ChangeLog& changes() const { return changes_; }

    /// Removes the component at a place at tick `now`.
    void remove(std::uint32_t place, Tick now);

 protected:
    PoolBase(const PoolBase&) = default;

    /// The component of an entity that has none goes to the end.
    void note_insertion(Entity entity, Tick now) {
        if (entity.index >= rows_.size()) rows_.resize(std::size_t{entity.index} + 1);
        rows_[entity.index] = {static_cast<std::uint32_t>(entities_.size()), entity.generation};
        entities_.push_back(entity);
        ticks_.push_back(now);
        changes_.add({now, entity}, entities_.size());
    }
    void note_change(std::uint32_t place, Entity entity, Tick now) {
        ticks_[place] = now;
        changes_.add({now, entity}, entities_.size());
    }

    template <class T>
    static void move_last_to(std::vector<T>& values, std::uint32_t place) {
        if (place + 1 != values.size()) values[place] = std::move(values.back());
        values.pop_back();
    }

 private:
    /// Of an entity. It has the generation too, so that one access tells whether the component is there.
    struct Row {
        std::uint32_t place = absent;
        std::uint32_t generation = 0;
    };

    virtual void remove_value(std::uint32_t place) = 0;

    std::vector<Row> rows_;  // by entity index
    std::vector<Entity> entities_;
    std::vector<Tick> ticks_;
    ChangeLog changes_;
};

/// The components of one type, packed.
template <Component C>
class Pool final : public PoolBase {
 public:
    [[nodiscard]] std::unique_ptr<PoolBase> clone() const override { return std::make_unique<Pool>(*this); }

    /// A pool of a world that has no C.
    [[nodiscard]] static const Pool& none() {
        static const Pool empty;
        return empty;
    }

    /// By place. Valid until the next change of the pool.
    [[nodiscard]] const std::vector<C>& values() const { return values_; }

    /// The entity must be alive and have no component.
    void insert(Entity entity, C value, Tick now) {
        values_.push_back(std::move(value));
        note_insertion(entity, now);
    }
    /// `entity` has the component at the place.
    void replace(std::uint32_t place, Entity entity, C value, Tick now) {
        values_[place] = std::move(value);
        note_change(place, entity, now);
    }
    /// The component, to be changed at tick `now`. Valid until the next change of the pool.
    [[nodiscard]] C& change(std::uint32_t place, Entity entity, Tick now) {
        note_change(place, entity, now);
        return values_[place];
    }

 private:
    void remove_value(std::uint32_t place) override { move_last_to(values_, place); }

    std::vector<C> values_;
};

}  // namespace candela
