#include "renderer/passes/surfels/surfel_maps.hpp"

#include <array>
#include <bit>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "renderer/passes/surfels/surfel_ids.hpp"

namespace candela {
namespace {

constexpr std::uint32_t no_slot = 0xffff'ffffU;

bool is_far(const Focus& focus, const glm::vec3& place) {
    return focus.radius > 0.0F && glm::distance(place, focus.centre) > 2.0F * focus.radius;
}

std::uint64_t key_of_focus(std::uint64_t id, const Focus& focus) {
    const auto words = std::bit_cast<std::array<std::uint64_t, sizeof(Focus) / sizeof(std::uint64_t)>>(focus);
    return hash_words(id, words);
}

}  // namespace

SurfelMaps assign_slots(std::span<const std::uint64_t> keys, const SurfelMaps* last) {
    SurfelMaps maps{.slots = std::vector<std::uint32_t>(keys.size(), no_slot),
                    .keys = std::vector<std::uint64_t>(keys.size())};
    std::unordered_map<std::uint64_t, std::uint32_t> last_slots;
    if (last != nullptr) {
        for (std::uint32_t slot = 0; slot < last->keys.size(); ++slot) last_slots[last->keys[slot]] = slot;
    }
    std::vector<bool> taken(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto found = last_slots.find(keys[i]);
        if (found == last_slots.end() || found->second >= keys.size()) continue;
        maps.slots[i] = found->second;
        taken[found->second] = true;
    }
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (maps.slots[i] == no_slot) {
            while (taken[next]) ++next;
            maps.slots[i] = next++;
        }
        maps.keys[maps.slots[i]] = keys[i];
    }
    return maps;
}

SurfelMaps place_maps(std::span<gpu::Surfel> surfels, std::span<const std::uint64_t> ids, const Focus& focus,
                      const SurfelMaps* last) {
    std::vector<std::uint64_t> keys(surfels.size());
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        keys[i] = is_far(focus, surfels[i].position) ? key_of_focus(ids[i], focus) : ids[i];
    }
    SurfelMaps maps = assign_slots(keys, last);
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        surfels[i].map = maps.slots[i] | (keys[i] == ids[i] ? 0U : SURFEL_MAP_OF_FOCUS);
    }
    return maps;
}

}  // namespace candela
