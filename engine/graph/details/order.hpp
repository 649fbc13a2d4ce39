#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/graph/compile.hpp"
#include "engine/graph/details/declaration.hpp"

namespace candela::detail {

/// One pass runs before another, because of a resource, or because `after` says so (resource is none).
struct Edge {
    std::uint32_t before;
    std::uint32_t after;
    std::uint32_t resource;
};

/// All passes in a legal order: that of declaration as far as `afters` allow, or with a seed a random one.
/// Where passes wait for each other, they are missing, and `faults` gets the cycles.
[[nodiscard]] std::vector<std::uint32_t> order_passes(const Declaration& declared, const Plan& plan,
                                                      const std::vector<Edge>& afters,
                                                      std::optional<std::uint64_t> shuffle_seed,
                                                      std::vector<Fault>& faults);

}  // namespace candela::detail
