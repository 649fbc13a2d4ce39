#include <candela/ecs/world.hpp>

#include <algorithm>
#include <atomic>
#include <iterator>

#include <fmt/format.h>

namespace candela {

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

void ChangeLog::add(Change change, std::size_t components) {
    const std::size_t kept = std::max<std::size_t>(1024, components / 4);
    // Half of them at once, so that dropping one takes constant time in the mean.
    if (changes_.size() >= 2 * kept) {
        const auto end = changes_.end() - static_cast<std::ptrdiff_t>(kept);
        before_ = std::prev(end)->tick;
        changes_.erase(changes_.begin(), end);
    }
    changes_.push_back(change);
}

std::optional<std::span<const Change>> ChangeLog::since(Tick tick) const {
    const std::span all(changes_);
    if (tick == before_) return all;
    const auto known = std::ranges::lower_bound(all, tick, {}, &Change::tick);
    if (known == all.end() || known->tick != tick) return std::nullopt;
    return all.subspan(static_cast<std::size_t>(known - all.begin()) + 1);
}

Tick World::next_tick() {
    static std::atomic<Tick> last{0};
    return ++last;
}

World::World(const World& other)
    : generations_(other.generations_), free_(other.free_), live_(other.live_), tick_(other.tick_) {
    for (const auto& [type, pool] : other.pools_) {
        pools_.emplace(type, pool->clone());
    }
}

World& World::operator=(const World& other) {
    return *this = World(other);
}

Entity World::create() {
    if (free_.empty()) {
        free_.push_back(static_cast<std::uint32_t>(generations_.size()));
        generations_.push_back(0);
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
    ++live_;
    return {index, ++generations_[index]};
}

void World::destroy(Entity entity) {
    require_alive(entity, "components to destroy");
    const Tick now = next_tick();
    for (auto& [type, pool] : pools_) {
        if (pool->remove(entity, now)) tick_ = now;
    }
    --live_;
    // An index whose generations are used up is not reused: an old handle could become valid again.
    if (++generations_[entity.index] != std::numeric_limits<std::uint32_t>::max() - 1) {
        free_.push_back(entity.index);
    }
}

bool World::alive(Entity entity) const {
    const bool occupied = entity.generation % 2 == 1;
    return occupied && entity.index < generations_.size() && generations_[entity.index] == entity.generation;
}

void World::require_alive(Entity entity, std::string_view component) const {
    if (!alive(entity)) throw EntityError::not_alive(entity, component);
}

}  // namespace candela
