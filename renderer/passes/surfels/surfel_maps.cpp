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

SurfelMaps assign_slots(std::span<const std::uint64_t> cells, const SurfelMaps* last) {
    SurfelMaps maps{.slots = std::vector<std::uint32_t>(cells.size(), no_slot),
                    .keys = {},
                    .cells = std::vector<std::uint64_t>(cells.size())};
    std::unordered_map<std::uint64_t, std::uint32_t> last_slots;
    if (last != nullptr) {
        for (std::uint32_t slot = 0; slot < last->cells.size(); ++slot) last_slots[last->cells[slot]] = slot;
    }
    std::vector<bool> taken(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto found = last_slots.find(cells[i]);
        if (found == last_slots.end() || found->second >= cells.size()) continue;
        maps.slots[i] = found->second;
        taken[found->second] = true;
    }
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (maps.slots[i] == no_slot) {
            while (taken[next]) ++next;
            maps.slots[i] = next++;
        }
        maps.cells[maps.slots[i]] = cells[i];
    }
    return maps;
}

SurfelMaps place_maps(std::span<gpu::Surfel> surfels, std::span<const std::uint64_t> cells,
                      std::span<const std::uint64_t> ids, const Focus& focus, const SurfelMaps* last) {
    SurfelMaps maps = assign_slots(cells.first(surfels.size()), last);
    maps.keys.resize(surfels.size());
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const bool far = is_far(focus, surfels[i].position);
        maps.keys[maps.slots[i]] = far ? key_of_focus(ids[i], focus) : ids[i];
        surfels[i].map = maps.slots[i] | (far ? SURFEL_MAP_OF_FOCUS : 0U);
    }
    return maps;
}

}  // namespace candela
