#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <candela/graph/compile.hpp>
#include <candela/graph/details/declaration.hpp>

namespace candela::detail {

/// One pass must run before another, because of a resource.
struct Edge {
    std::uint32_t before;
    std::uint32_t after;
};

/// All passes in the order of declaration, in which handles lead only from earlier to later passes; with a
/// seed in a random valid order.
[[nodiscard]] std::vector<std::uint32_t> order_passes(const Declaration& declared, const Plan& plan,
                                                      std::optional<std::uint64_t> shuffle_seed);

}  // namespace candela::detail
