#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <candela/api.hpp>
#include <candela/graph/backend.hpp>
#include <candela/graph/errors.hpp>
#include <candela/graph/frame_graph.hpp>

namespace candela {

namespace detail {

/// Positions of a resource's first and last access in the execution order; `first` is none if no kept pass
/// (one that was not culled) uses it.
struct Span {
    std::uint32_t first = none;
    std::uint32_t last = none;
};

/// What compiling adds to a declaration. All versions of all resources are numbered in one sequence: the id
/// of a version is the first id of its resource plus the version number. An object is one storage location: a
/// texture, a buffer or a value.
struct Plan {
    std::vector<std::uint32_t> order;          // kept passes, in execution order
    std::vector<std::uint32_t> first_version;  // per resource: its first version id; then the total number
    std::vector<std::uint32_t> writer;         // per version id: the pass that writes it, or none
    std::vector<Span> lifetime;                // per resource
    // Per resource: its object, or none if it is unused. A history has the object after its resource's.
    std::vector<std::uint32_t> object;
    std::vector<std::uint32_t> owner;  // per object: a resource that has its kind and description
    std::vector<Barrier> barrier;      // per position: what to issue before the pass

    [[nodiscard]] std::uint32_t version(std::uint32_t resource, std::uint32_t number) const {
        return first_version[resource] + number;
    }
    /// The resource of a version id.
    [[nodiscard]] std::uint32_t resource(std::uint32_t version_id) const {
        const auto next = std::ranges::upper_bound(first_version, version_id);
        return static_cast<std::uint32_t>(next - first_version.begin()) - 1;
    }
};

}  // namespace detail

/// A declaration with its plan: the execution order, the storage objects of the resources and the barriers.
/// GraphRuntime::switch_to takes it; `describe_text` and its siblings print it. Owns the passes' functions
/// and parameters. The GPU objects belong to the GraphRuntime.
class CompiledGraph {
 public:
    CompiledGraph(detail::Declaration declared, detail::Plan plan)
        : declared_(std::move(declared)), plan_(std::move(plan)) {}

    /// Number of kept passes: those that were not culled.
    [[nodiscard]] std::size_t pass_count() const { return plan_.order.size(); }
    [[nodiscard]] const detail::Declaration& declared() const { return declared_; }
    [[nodiscard]] const detail::Plan& plan() const { return plan_; }

 private:
    detail::Declaration declared_;
    detail::Plan plan_;
};

/// Either a graph, or the errors that prevented compilation.
struct CANDELA_API CompileResult {
    std::optional<CompiledGraph> graph;
    std::vector<CompileError> errors;

    explicit operator bool() const { return graph.has_value(); }
    /// Moves the graph out. Throws GraphError with all errors, one per line, if there is no graph.
    [[nodiscard]] CompiledGraph take() &&;
};

/// Validates and culls the passes, which run in the order of declaration, then plans lifetimes, shared
/// objects and barriers. Consumes the graph. Reports misuse in the result and does not throw for it; makes no
/// GPU calls. Takes time linear in passes and accesses.
///
/// A pass is kept if it has side effects, if it writes an imported resource, or if a kept pass reads its
/// result, modifies it in place or reads its history. All other passes are culled.
[[nodiscard]] CANDELA_API CompileResult compile(FrameGraph&& graph);

}  // namespace candela
