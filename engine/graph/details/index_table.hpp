#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "engine/graph/details/declaration.hpp"

namespace candela::detail {

/// Finds things by content: an open-addressing table of indices, with room for as many as were announced.
class IndexTable {
 public:
    explicit IndexTable(std::size_t capacity) : entries_(std::bit_ceil(2 * capacity + 1)) {}

    /// The index filed under `hash` for which `same(index)` holds; if there is none, files `index` and gives
    /// `none`.
    template <class Same>
    std::uint32_t find_or_insert(std::size_t hash, std::uint32_t index, Same same) {
        Entry& entry = find(hash, same);
        if (entry.index == none) {
            entry = {static_cast<std::uint32_t>(hash), index};
            return none;
        }
        return entry.index;
    }

    /// The same without filing.
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
            if (entry.index == none) {
                return entry;
            }
            if (entry.hash == static_cast<std::uint32_t>(hash) && same(entry.index)) {
                return entry;
            }
        }
    }

    std::vector<Entry> entries_;
};

[[nodiscard]] inline std::size_t hash_of(std::string_view text) {
    return std::hash<std::string_view>{}(text);
}

/// Folds `value` into `hash`, high bits and low. The factor is 2^64 divided by the golden ratio.
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
