#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>

#include "renderer/passes/surfels/patch_tree.hpp"

namespace candela {

/// A cut through trees of patches: some are opened, so that their halves count in their place. The others
/// that are roots or halves of opened ones are its cells. It holds ids only, so that it outlives the trees.
struct PatchCut {
    struct Place {
        double weight = 0.0;  ///< what it was worth to be opened
        bool opened = false;
    };
    /// By id of a root: how many times its area its cells stand for. Other roots have no cells.
    std::unordered_map<std::uint64_t, double> scales;
    std::unordered_map<std::uint64_t, Place> places;  ///< by id of a patch, of cells and opened ones

    [[nodiscard]] bool opens(std::uint64_t id) const {
        const auto found = places.find(id);
        return found != places.end() && found->second.opened;
    }
    /// Adds a cut of other roots.
    void merge(PatchCut&& other) {
        scales.merge(other.scales);
        places.merge(other.places);
    }
};

/// The way from one cut to another.
struct CutWay {
    const PatchCut& from;
    const PatchCut& to;
};

struct CutLimits {
    std::size_t cells = 0;      ///< of the cut, at most, unless `from` has more
    std::size_t new_cells = 0;  ///< that `from` doesn't have, about
    double gain = 1.0;  ///< patches are opened only if worth that many times the least that `to` opens
};

/// What is to be done until a cut is the one that it follows.
struct ChangesLeft {
    std::uint32_t all = 0;    ///< patches to open or to close; 0: it is
    std::uint32_t gains = 0;  ///< of these, to open, and worth it
    ChangesLeft& operator+=(const ChangesLeft& other) {
        all += other.all;
        gains += other.gains;
        return *this;
    }
    bool operator==(const ChangesLeft&) const = default;
};

struct FollowedCut {
    PatchCut cut;
    ChangesLeft left{};
};

/// Changes a cut towards another as far as the limits allow. The patches that are worth most are opened
/// first; others are closed where there have to be fewer cells, those first that are worth least. A cell is
/// only replaced by those of the other cut, or by ones on the way to them. If the cuts have no root in
/// common, the result is the other one.
[[nodiscard]] FollowedCut follow(PatchTree& tree, std::span<const std::uint32_t> roots, const CutWay& way,
                                 const CutLimits& limits);

}  // namespace candela
