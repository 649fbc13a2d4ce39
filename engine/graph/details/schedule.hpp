#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <candela/graph/describe.hpp>
#include "engine/graph/details/plan.hpp"

namespace candela::detail {

/// That one pass must run before another.
struct Dependency {
    std::uint32_t from;  // pass
    std::uint32_t to;    // pass
    DependencyKind kind;
    std::uint32_t subject = none;  // a resource, a type of component in Declaration::components, or none
};

/// All dependencies between passes of `kept`, which are in the order of declaration: ordered by `to`. Several
/// may be between the same two passes.
///
/// A version is written before it is read or overwritten, and read before it is overwritten. Of two passes
/// that access the same type of component, or that have side effects, the one declared first runs first,
/// unless both only read.
[[nodiscard]] std::vector<Dependency> find_dependencies(const Declaration& declared, const Plan& plan,
                                                        const std::vector<std::uint32_t>& kept);

/// The passes of `kept` in an order that suits all dependencies. Of the passes that may run next, it takes
/// the first declared one that needs no barrier, among the first few; if each needs one, the first. So passes
/// between two barriers are together, and lifetimes stay near those of the declared order. With `shuffle`,
/// the order is a random one among those that are legal.
[[nodiscard]] std::vector<std::uint32_t> schedule(const Declaration& declared, const Plan& plan,
                                                  const std::vector<std::uint32_t>& kept,
                                                  std::optional<std::uint32_t> shuffle);

}  // namespace candela::detail
