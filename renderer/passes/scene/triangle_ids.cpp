#include "renderer/passes/scene/triangle_ids.hpp"

#include <algorithm>
#include <iterator>

#include "renderer/gpu/gpu_types.hpp"

namespace candela {
namespace {

std::uint64_t entity_of(PrimitiveKey key) {
    return key >> 32U;
}

}  // namespace

std::optional<std::uint32_t> TriangleIds::insert(PrimitiveKey key, std::uint32_t count) {
    const auto place = ranges_.insert({key, {0, count}}).first;
    const auto after = std::next(place);
    const bool is_last = after == ranges_.end();
    const std::uint64_t end = is_last ? TRIANGLE_MASKED : after->second.first;
    std::uint64_t begin = 0;
    std::uint64_t skipped = entity_of(key);  // entities between this one and the one before
    if (place != ranges_.begin()) {
        const auto& [key_before, before] = *std::prev(place);
        begin = std::uint64_t{before.first} + before.count;
        skipped -= entity_of(key_before);
    }
    if (begin + count > end) {
        distribute();
        return std::nullopt;
    }
    // Where it would be if all entities between the neighbours were there.
    const std::uint64_t room = end - begin - count;
    const std::uint64_t between = is_last ? 0 : skipped + entity_of(after->first) - entity_of(key);
    const std::uint64_t offset = is_last        ? std::min(room_ * skipped, room / 2)
                                 : between == 0 ? 0
                                                : room * skipped / between;
    place->second.first = static_cast<std::uint32_t>(begin + offset);
    return place->second.first;
}

/// Half of the ids are for entities that will come behind the last one.
void TriangleIds::distribute() {
    std::uint64_t sum = 0;
    for (const auto& [key, range] : ranges_) sum += range.count;
    room_ = (TRIANGLE_MASKED - sum) / (2 * (entity_of(ranges_.rbegin()->first) + 1));
    std::uint64_t sum_before = 0;
    for (auto& [key, range] : ranges_) {
        range.first = static_cast<std::uint32_t>(sum_before + room_ * entity_of(key));
        sum_before += range.count;
    }
}

}  // namespace candela
