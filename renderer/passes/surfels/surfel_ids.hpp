#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/passes/surfels/surfel_placement.hpp"

namespace candela {

/// A hash of 64-bit words.
[[nodiscard]] std::uint64_t hash_words(std::uint64_t seed, std::span<const std::uint64_t> words);

/// By surfel: a hash of where it and the points of its cell are, and of their areas; not of materials and
/// colours. SurfelSet::ids are hashed as well.
[[nodiscard]] std::vector<std::uint64_t> content_hashes(const SurfelSet& set);

/// Makes ids unique: of equal ones, the later get others.
void make_unique(std::vector<std::uint64_t>& ids);

}  // namespace candela
