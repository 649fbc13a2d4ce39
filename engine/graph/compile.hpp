#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/graph/backend.hpp"
#include "engine/graph/fault.hpp"
#include "engine/graph/frame_graph.hpp"

namespace candela {

namespace detail {

/// Positions of a resource's first and last access in the order of passes; `first` is none if no kept pass
/// uses it.
struct Span {
    std::uint32_t first = none;
    std::uint32_t last = none;
};

/// What compiling adds to a declaration. A version's id is its resource's first id plus its number.
struct Plan {
    std::vector<std::uint32_t> order;          // kept passes, in the order in which they run
    std::vector<std::uint32_t> first_version;  // by resource, then the number of all versions
    std::vector<std::uint32_t> writer;         // by version id: the pass that writes it, or none
    std::vector<Span> lifetime;                // by resource
    std::vector<std::uint32_t>
        object;                        // by resource: its object, or none; the past lives in the one after it
    std::vector<std::uint32_t> owner;  // by object: a resource that tells its kind and description
    std::vector<Barrier> barrier;      // by position: what to issue before the pass

    [[nodiscard]] std::uint32_t version(std::uint32_t resource, std::uint32_t number) const {
        return first_version[resource] + number;
    }
};

}  // namespace detail

/// A declaration whose passes are ordered, whose resources have objects and whose barriers are planned: what
/// a GraphRuntime runs and `describe` tells. Owns the passes' functions.
class CompiledGraph {
 public:
    CompiledGraph(detail::Declaration declared, detail::Plan plan)
        : declared_(std::move(declared)), plan_(std::move(plan)) {}

    /// Passes that are kept.
    [[nodiscard]] std::size_t pass_count() const { return plan_.order.size(); }
    [[nodiscard]] const detail::Declaration& declared() const { return declared_; }
    [[nodiscard]] const detail::Plan& plan() const { return plan_; }

 private:
    detail::Declaration declared_;
    detail::Plan plan_;
};

struct CompileOptions {
    /// Draws one of the legal orders at random. Without it the order is that of declaration, as far as it is
    /// legal.
    std::optional<std::uint64_t> shuffle_seed = std::nullopt;
};

/// Either a graph or the faults for which there is none.
struct CompileResult {
    std::optional<CompiledGraph> graph;
    std::vector<Fault> faults;

    explicit operator bool() const { return graph.has_value(); }
    /// Gives up the graph. GraphError with all faults, a line each, if there is none.
    [[nodiscard]] CompiledGraph take() &&;
};

/// Validates, orders and culls the passes, then plans lifetimes, shared objects and barriers. Pure, and
/// linear in passes and accesses (orders that `after` turns against the declaration's cost a logarithm more).
///
/// Kept are the passes with side effects, those that write imported resources, and those whose results a kept
/// pass reads, changes or remembers as history.
[[nodiscard]] CompileResult compile(FrameGraph&& graph, CompileOptions options = {});

}  // namespace candela
