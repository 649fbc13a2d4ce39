#include <candela/ecs/world.hpp>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <mutex>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include <candela/ecs/world_writer.hpp>

namespace candela {

std::size_t detail::component_index(std::type_index type) {
    static std::mutex mutex;
    static std::unordered_map<std::type_index, std::size_t> indices;
    const std::scoped_lock lock(mutex);
    return indices.try_emplace(type, indices.size()).first->second;
}

std::string to_string(Entity entity) {
    if (!entity) return "the null entity";
    return fmt::format("entity {} (generation {})", entity.index, entity.generation);
}

EntityError EntityError::not_alive(Entity entity, std::string_view component) {
    return EntityError(fmt::format("{} is not alive, so it has no {}", to_string(entity), component));
}

EntityError EntityError::lacks(Entity entity, std::string_view component) {
    return EntityError(fmt::format("{} has no {}", to_string(entity), component));
}

EntityError EntityError::never_alive(Entity entity) {
    return EntityError(fmt::format("{} cannot be created: no entity has that generation", to_string(entity)));
}

UndeclaredAccess UndeclaredAccess::of(std::string_view pass, std::string_view verb,
                                      std::string_view component) {
    return UndeclaredAccess(
        fmt::format("pass '{}' {} {} components without having declared it", pass, verb, component));
}

World& WorldWriter::with_entities() const {
    if (!declared_ || (world_ && declared_->writes_entities)) return *world_;
    throw UndeclaredAccess(
        fmt::format("pass '{}' creates or destroys entities without having declared it", pass()));
}

Entity EntityTable::add() {
    const auto index = static_cast<std::uint32_t>(rows_.size());
    rows_.push_back({.generation = 1});
    ++live_;
    return {index, 1};
}

Entity EntityTable::create(Entity hint) {
    if (!hint) return create();
    if (!is_used(hint.generation) || hint.generation == std::numeric_limits<std::uint32_t>::max()) {
        throw EntityError::never_alive(hint);
    }
    while (rows_.size() <= hint.index) {
        rows_.emplace_back();
        put_on_free_list(static_cast<std::uint32_t>(rows_.size() - 1));
    }
    if (is_used(rows_[hint.index].generation)) return create();
    take_off_free_list(hint.index);
    rows_[hint.index].generation = hint.generation;
    ++live_;
    return hint;
}

void EntityTable::destroy(Entity entity) {
    --live_;
    Row& row = rows_[entity.index];
    row.place = none;
    // An index whose generations are used up is not reused: an old handle could become valid again.
    if (++row.generation != std::numeric_limits<std::uint32_t>::max() - 1) put_on_free_list(entity.index);
}

void EntityTable::put_on_free_list(std::uint32_t index) {
    rows_[index].place = static_cast<std::uint32_t>(free_.size());
    free_.push_back(index);
}

void EntityTable::take_off_free_list(std::uint32_t index) {
    const std::uint32_t place = rows_[index].place;
    if (place == none) return;
    free_[place] = free_.back();
    rows_[free_[place]].place = place;
    free_.pop_back();
}

void Ticks::take() {
    static std::atomic<Tick> taken{0};
    constexpr Tick many = 256;
    last_ = taken.fetch_add(many);
    end_ = last_ + many;
}

void ChangeLog::make_room(std::size_t components) {
    const std::size_t kept = std::max<std::size_t>(1024, components / 4);
    if (changes_.size() < 2 * kept) return changes_.reserve(std::min(2 * kept, 2 * changes_.size() + 16));
    // Half of them at once, so that dropping one takes constant time in the mean.
    const auto end = changes_.end() - static_cast<std::ptrdiff_t>(kept);
    before_ = std::prev(end)->tick;
    changes_.erase(changes_.begin(), end);
}

std::optional<std::span<const Change>> ChangeLog::since(Tick tick) const {
    const std::span all(changes_);
    if (tick == before_) return all;
    const auto known = std::ranges::lower_bound(all, tick, {}, &Change::tick);
    if (known == all.end() || known->tick != tick) return std::nullopt;
    return all.subspan(static_cast<std::size_t>(known - all.begin()) + 1);
}

void PoolBase::remove(std::uint32_t place, Tick now) {
    const Entity entity = entities_[place];
    rows_[entities_.back().index].place = place;
    rows_[entity.index] = {};
    remove_value(place);
    move_last_to(ticks_, place);
    move_last_to(entities_, place);
    changes_.add({now, entity}, entities_.size());
}

World::World(const World& other) : entities_(other.entities_), ticks_(other.ticks_) {
    pools_.reserve(other.pools_.size());
    for (const auto& pool : other.pools_) {
        pools_.push_back(pool ? pool->clone() : nullptr);
    }
}

World& World::operator=(const World& other) {
    return *this = World(other);
}

void World::destroy(Entity entity) {
    entities_.require_alive(entity, "components to destroy");
    std::optional<Tick> now;
    for (const auto& pool : pools_) {
        const std::uint32_t place = pool ? pool->place_of(entity) : PoolBase::absent;
        if (place == PoolBase::absent) continue;
        if (!now) now = ticks_.draw();
        pool->remove(place, *now);
    }
    entities_.destroy(entity);
}

}  // namespace candela
