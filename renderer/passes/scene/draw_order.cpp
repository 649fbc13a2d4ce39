#include "renderer/passes/scene/draw_order.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace candela {
namespace {

/// A free place follows so many things in a group that gets new places.
constexpr std::uint32_t things_per_free_place = 8;

/// Most things that are moved to free a place. If all free places are farther away, things are distributed
/// anew.
constexpr std::uint32_t most_moved = 64;

/// The largest share of places in use, of so many that are distributed anew: larger parts of a group must
/// have more room, so that this is rarely done to them.
float most_used(std::uint32_t places, std::uint32_t capacity) {
    constexpr float of_few = 0.94F;
    constexpr float of_all = 0.63F;
    const float smallest = std::log2(2.0F * static_cast<float>(most_moved));
    const float level = std::log2(static_cast<float>(places)) - smallest;
    const float levels = std::max(std::log2(static_cast<float>(capacity)) - smallest, 1.0F);
    return of_few + (of_all - of_few) * level / levels;
}

}  // namespace

void DrawOrder::insert(Group& group, Key key, std::uint32_t thing) {
    const auto begin = keys_.begin() + group.first;
    const auto next = static_cast<std::uint32_t>(std::lower_bound(begin, begin + group.count, key) - begin);
    // Offsets in the group: `after` is the nearest free place behind where the thing belongs, and
    // `before` - 1 that in front of it.
    const auto is_free = [&](std::uint32_t offset) { return things_[group.first + offset] == none; };
    std::uint32_t after = next;
    while (after < group.capacity && after - next < most_moved && !is_free(after)) ++after;
    std::uint32_t before = next;
    while (before > 0 && next - before < after - next && !is_free(before - 1)) --before;

    if (before > 0 && is_free(before - 1)) {
        for (std::uint32_t i = before; i < next; ++i) {
            set(group.first + i - 1, keys_[group.first + i], things_[group.first + i]);
        }
        set(group.first + next - 1, key, thing);
    } else if (after < group.capacity && is_free(after)) {
        for (std::uint32_t i = after; i > next; --i) {
            set(group.first + i, keys_[group.first + i - 1], things_[group.first + i - 1]);
        }
        set(group.first + next, key, thing);
        group.count = std::max(group.count, after + 1);
    } else {
        make_room(group, next);
        return insert(group, key, thing);
    }
    ++group.used;
    ++used_;
}

void DrawOrder::remove(Group& group, std::uint32_t place) {
    set(place, keys_[place], none);
    --group.used;
    --used_;
    while (group.count > 0 && things_[group.first + group.count - 1] == none) --group.count;
}

void DrawOrder::drop(Group& group) {
    if (group.capacity > 0) free_[group.capacity].push_back(group.first);
    group = {};
}

DrawOrder::Key DrawOrder::first_key(const Group& group) const {
    std::uint32_t place = group.first;
    while (things_[place] == none) ++place;
    return keys_[place];
}

void DrawOrder::compact(const std::vector<Group*>& groups) {
    const DrawOrder before = std::exchange(*this, {});
    used_ = before.used_;
    for (Group* const group : groups) *group = copy(before, *group);
    changed_.resize(size());
    std::iota(changed_.begin(), changed_.end(), 0U);
}

/// Makes free places around one of the group: a packed-memory array (Bender, Demaine and Farach-Colton,
/// "Cache-Oblivious B-Trees", 2000).
void DrawOrder::make_room(Group& group, std::uint32_t around) {
    for (std::uint32_t size = 2 * most_moved; size <= group.capacity; size *= 2) {
        const std::uint32_t begin = std::min(around - std::min(around, size / 2), group.capacity - size);
        const auto first = things_.begin() + group.first + begin;
        const auto free = static_cast<std::uint32_t>(std::count(first, first + size, none));
        const float share = static_cast<float>(size - free) / static_cast<float>(size);
        if (share <= most_used(size, group.capacity)) return distribute(group, begin, size);
    }
    grow(group);
}

/// Distributes the things at `size` places of the group evenly over these.
void DrawOrder::distribute(Group& group, std::uint32_t begin, std::uint32_t size) {
    std::vector<std::pair<Key, std::uint32_t>> moved;
    for (std::uint32_t i = group.first + begin; i < group.first + begin + size; ++i) {
        if (things_[i] != none) moved.emplace_back(keys_[i], things_[i]);
    }
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < size; ++i) {
        const bool is_used = next < moved.size() && next * size / moved.size() == i;
        if (is_used) ++next;
        set(group.first + begin + i, moved[next - 1].first, is_used ? moved[next - 1].second : none);
        if (is_used) group.count = std::max(group.count, begin + i + 1);
    }
}

void DrawOrder::grow(Group& group) {
    Group before = std::exchange(group, copy(*this, group));
    for (std::uint32_t i = 0; i < before.count; ++i) set(before.first + i, 0, none);
    drop(before);
}

/// The first of consecutive places that no group has.
std::uint32_t DrawOrder::take_places(std::uint32_t capacity) {
    std::vector<std::uint32_t>& free = free_[capacity];
    if (free.empty()) {
        free.push_back(size());
        things_.resize(things_.size() + capacity, none);
        keys_.resize(things_.size());
    }
    const std::uint32_t first = free.back();
    free.pop_back();
    return first;
}

/// Copies a group of an order, which may be this one, to new places.
DrawOrder::Group DrawOrder::copy(const DrawOrder& from, const Group& group) {
    Group to{.capacity = std::bit_ceil(std::max(8U, 2 * group.used))};
    to.first = take_places(to.capacity);
    for (std::uint32_t i = group.first; i < group.first + group.count; ++i) {
        if (from.things_[i] == none) continue;
        set(to.first + to.count++, from.keys_[i], from.things_[i]);
        ++to.used;
        if (to.used % things_per_free_place == 0 && group.used >= 8 * things_per_free_place) {
            set(to.first + to.count++, from.keys_[i], none);
        }
    }
    return to;
}

std::vector<std::uint32_t> DrawOrder::take_changed() {
    std::vector<std::uint32_t> changed = std::exchange(changed_, {});
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
}

void DrawOrder::set(std::uint32_t place, Key key, std::uint32_t thing) {
    keys_[place] = key;
    things_[place] = thing;
    changed_.push_back(place);
}

}  // namespace candela
