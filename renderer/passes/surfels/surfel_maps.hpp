#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/surfels/surfel_focus.hpp"

namespace candela {

/// Where the depth maps of surfels are: VplAtlas. n surfels have maps, in slots 0 to n - 1. A surfel that
/// stays keeps its slot, unless there are no longer so many.
struct SurfelMaps {
    std::vector<std::uint32_t> slots;  ///< by surfel
    std::vector<std::uint64_t> keys;   ///< by slot: maps of the same key are equal, as long as nothing moves
    std::vector<std::uint64_t> cells;  ///< by slot: of which surfel it is: Surfels::cells
    std::vector<std::uint32_t> shown;  ///< by slot: 0: the hemisphere, else 1 more than an index in `foci`
    std::array<Focus, SURFEL_MAP_FOCI> foci{};  ///< radius 0: none shows it
    std::uint32_t outdated = 0;                 ///< maps that should show something else
    bool operator==(const SurfelMaps&) const = default;
};

/// Keeps the slots of the cells that `last` has as well, and gives each other one the lowest slot that is
/// left. `cells`: by surfel, each once. `last`: null if there is none. Sets `slots` and `cells`.
[[nodiscard]] SurfelMaps assign_slots(std::span<const std::uint64_t> cells, const SurfelMaps* last);

/// The same for surfels with these cells and ids (Surfels); also sets gpu::Surfel::map. The map of a surfel
/// that is farther than two radii from the centre of `focus` is a picture of the focus, and another one for
/// each focus. While a focus moves, the surfels follow it a few at a time, and until then keep the maps that
/// they have: `most_new` in a call, unless there are more foci than SURFEL_MAP_FOCI.
[[nodiscard]] SurfelMaps place_maps(std::span<gpu::Surfel> surfels, std::span<const std::uint64_t> cells,
                                    std::span<const std::uint64_t> ids, const Focus& focus,
                                    const SurfelMaps* last, std::uint32_t most_new);

}  // namespace candela
