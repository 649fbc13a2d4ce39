#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <candela/graph/compile.hpp>
#include <candela/graph/details/declaration.hpp>

namespace candela::detail {

/// One pass must run before another, because of a resource or because of `Pass::after` (`resource` is none).
struct Edge {
    std::uint32_t before;
    std::uint32_t after;
    std::uint32_t resource;
};

/// All passes in a valid order: the order of declaration as far as `afters` allow, or a random order if there
/// is a seed. Passes of a cycle, and passes that depend on them, are missing; the cycles found are added to
/// `faults`.
[[nodiscard]] std::vector<std::uint32_t> order_passes(const Declaration& declared, const Plan& plan,
                                                      const std::vector<Edge>& afters,
                                                      std::optional<std::uint64_t> shuffle_seed,
                                                      std::vector<Fault>& faults);

}  // namespace candela::detail
