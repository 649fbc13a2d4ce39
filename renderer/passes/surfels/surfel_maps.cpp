#include "renderer/passes/surfels/surfel_maps.hpp"

#include <algorithm>
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

constexpr std::uint32_t not_yet = 0xffff'ffffU;  // in SurfelMaps::shown

/// What the slots showed that are still those of the same cells.
void keep_shown(SurfelMaps& maps, const SurfelMaps& last) {
    maps.foci = last.foci;
    for (std::size_t slot = 0; slot < std::min(maps.cells.size(), last.cells.size()); ++slot) {
        if (maps.cells[slot] == last.cells[slot]) maps.shown[slot] = last.shown[slot];
    }
}

/// The index of a focus among those of the maps. If it is new and none is free, it takes the place of the one
/// that the fewest show, which get new maps.
std::uint32_t index_of(const Focus& focus, SurfelMaps& maps) {
    const auto found = std::ranges::find(maps.foci, focus);
    if (found != maps.foci.end()) return static_cast<std::uint32_t>(found - maps.foci.begin());
    std::array<std::uint32_t, SURFEL_MAP_FOCI> counts{};
    for (const std::uint32_t shown : maps.shown) {
        if (shown != not_yet && shown > 0) ++counts[shown - 1];
    }
    const auto index = static_cast<std::uint32_t>(std::ranges::min_element(counts) - counts.begin());
    std::ranges::replace(maps.shown, index + 1, not_yet);
    maps.foci[index] = focus;
    return index;
}

void forget_unseen(SurfelMaps& maps) {
    for (std::uint32_t i = 0; i < SURFEL_MAP_FOCI; ++i) {
        if (std::ranges::find(maps.shown, i + 1) == maps.shown.end()) maps.foci[i] = {};
    }
}

}  // namespace

SurfelMaps assign_slots(std::span<const std::uint64_t> cells, const SurfelMaps* last) {
    SurfelMaps maps{.slots = std::vector<std::uint32_t>(cells.size(), no_slot),
                    .keys = {},
                    .cells = std::vector<std::uint64_t>(cells.size()),
                    .shown = {}};
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
                      std::span<const std::uint64_t> ids, const Focus& focus, const SurfelMaps* last,
                      std::uint32_t most_new) {
    SurfelMaps maps = assign_slots(cells.first(surfels.size()), last);
    maps.keys.resize(surfels.size());
    maps.shown.assign(surfels.size(), not_yet);
    if (last != nullptr) keep_shown(maps, *last);
    const std::uint32_t current = focus.radius > 0.0F ? 1 + index_of(focus, maps) : 0;
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const std::uint32_t slot = maps.slots[i];
        const std::uint32_t wanted = is_far(focus, surfels[i].position) ? current : 0;
        std::uint32_t& shown = maps.shown[slot];
        if (shown == not_yet) {
            shown = wanted;
        } else if (shown != wanted && most_new > 0) {
            shown = wanted;
            --most_new;
        } else if (shown != wanted) {
            ++maps.outdated;
        }
        maps.keys[slot] = shown > 0 ? key_of_focus(ids[i], maps.foci[shown - 1]) : ids[i];
        surfels[i].map = slot | shown << SURFEL_MAP_FOCUS_SHIFT;
    }
    forget_unseen(maps);
    return maps;
}

}  // namespace candela
