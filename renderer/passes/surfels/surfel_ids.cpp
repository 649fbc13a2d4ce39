#include "renderer/passes/surfels/surfel_ids.hpp"

#include <array>
#include <bit>
#include <unordered_set>

namespace candela {
namespace {

template <class T>
std::uint64_t hash_bits(std::uint64_t seed, const T& value) {
    return hash_words(seed,
                      std::bit_cast<std::array<std::uint64_t, sizeof(T) / sizeof(std::uint64_t)>>(value));
}

}  // namespace

std::uint64_t hash_words(std::uint64_t seed, std::span<const std::uint64_t> words) {
    std::uint64_t hash = seed;
    for (const std::uint64_t word : words) hash = combine_ids(hash, word);
    return hash;
}

std::vector<std::uint64_t> content_hashes(const SurfelSet& set) {
    std::vector<std::uint64_t> hashes;
    hashes.reserve(set.surfels.size());
    for (std::size_t i = 0; i < set.surfels.size(); ++i) {
        gpu::Surfel surfel = set.surfels[i];
        const std::uint32_t first = surfel.first_point;
        surfel.first_point = surfel.map = surfel.seed = 0;
        std::uint64_t hash = hash_bits(set.ids[i], surfel);
        for (std::uint32_t p = first; p < first + surfel.point_count; ++p) {
            gpu::CellPoint place{};
            place.position = set.points[p].position;
            place.middle = set.points[p].middle;
            place.normal = set.points[p].normal;
            place.area = set.points[p].area;
            hash = hash_bits(hash, place);
        }
        hashes.push_back(hash);
    }
    return hashes;
}

void make_unique(std::vector<std::uint64_t>& ids) {
    std::unordered_set<std::uint64_t> seen;
    for (std::uint64_t& id : ids) {
        while (!seen.insert(id).second) ++id;
    }
}

}  // namespace candela
