#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "engine/graph/details/declaration.hpp"

namespace candela::detail {

/// A hash table of indices with open addressing, to find items by content. Holds up to `capacity` indices.
class IndexTable {
 public:
    explicit IndexTable(std::size_t capacity) : entries_(std::bit_ceil(2 * capacity + 1)) {}

    /// Returns the stored index under `hash` for which `same(index)` holds. If there is none, inserts `index`
    /// and returns `none`.
    template <class Same>
    std::uint32_t find_or_insert(std::size_t hash, std::uint32_t index, Same same) {
        Entry& entry = find(hash, same);
        if (entry.index == none) {
            entry = {static_cast<std::uint32_t>(hash), index};
            return none;
        }
        return entry.index;
    }

    /// The same without inserting.
    template <class Same>
    [[nodiscard]] std::uint32_t find_index(std::size_t hash, Same same) {
        return find(hash, same).index;
    }

 private:
    struct Entry {
        std::uint32_t hash = 0;
        std::uint32_t index = none;
    };

    template <class Same>
    Entry& find(std::size_t hash, Same same) {
        const std::size_t mask = entries_.size() - 1;
        for (std::size_t at = hash & mask;; at = (at + 1) & mask) {
            Entry& entry = entries_[at];
            if (entry.index == none) return entry;
            if (entry.hash == static_cast<std::uint32_t>(hash) && same(entry.index)) return entry;
        }
    }

    std::vector<Entry> entries_;
};

[[nodiscard]] inline std::size_t hash_of(std::string_view text) {
    return std::hash<std::string_view>{}(text);
}

/// Combines `value` with `hash`. The factor is 2^64 divided by the golden ratio; the shift mixes the high
/// bits into the low ones.
[[nodiscard]] inline std::size_t mix(std::size_t hash, std::size_t value) {
    hash = (hash ^ value) * 0x9e37'79b9'7f4a'7c15U;
    return hash ^ (hash >> 32U);
}

[[nodiscard]] inline std::size_t hash_of(const TextureDesc& desc) {
    const auto kind = static_cast<std::size_t>(desc.format) | static_cast<std::size_t>(desc.shape) << 8U;
    const std::size_t size = desc.size.x | std::uint64_t{desc.size.y} << 32U;
    return mix(mix(mix(kind, size), desc.layers), desc.mips);
}

[[nodiscard]] inline std::size_t hash_of(const BufferDesc& desc) {
    return mix(mix(1, desc.count), desc.stride);
}

}  // namespace candela::detail
