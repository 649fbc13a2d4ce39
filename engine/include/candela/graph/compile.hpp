#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <candela/api.hpp>
#include <candela/graph/errors.hpp>
#include <candela/graph/frame_graph.hpp>

namespace candela {

namespace detail {

struct Declaration;
struct Plan;

}  // namespace detail

/// A declaration with its plan: the execution order, the storage objects of the resources and the barriers.
/// GraphRuntime::switch_to takes it; `describe_text` and its siblings print it. Owns the passes' functions
/// and parameters. The GPU objects belong to the GraphRuntime.
class CANDELA_API CompiledGraph {
 public:
    CompiledGraph(std::unique_ptr<const detail::Declaration> declared,
                  std::unique_ptr<const detail::Plan> plan);
    CompiledGraph(CompiledGraph&& other) noexcept;
    CompiledGraph& operator=(CompiledGraph&& other) noexcept;
    ~CompiledGraph();

    /// Number of kept passes: those that were not culled.
    [[nodiscard]] std::size_t pass_count() const;
    [[nodiscard]] const detail::Declaration& declared() const { return *declared_; }
    [[nodiscard]] const detail::Plan& plan() const { return *plan_; }

 private:
    std::unique_ptr<const detail::Declaration> declared_;
    std::unique_ptr<const detail::Plan> plan_;
};

/// Either a graph, or the errors that prevented compilation.
struct CANDELA_API CompileResult {
    std::optional<CompiledGraph> graph;
    std::vector<CompileError> errors;

    explicit operator bool() const { return graph.has_value(); }
    /// Moves the graph out. Throws GraphError with all errors, one per line, if there is no graph.
    [[nodiscard]] CompiledGraph take() &&;
};

/// Validates and culls the passes, puts them in order, and plans lifetimes, shared objects and barriers.
/// Consumes the graph. Reports misuse in the result and does not throw for it; makes no GPU calls. Takes time
/// nearly linear in passes and accesses.
///
/// A pass is kept if it has side effects, if it writes components or an imported resource, or if a kept pass
/// reads its result, or modifies it in place. All other passes are culled.
///
/// The order follows from what passes declare (DependencyKind lists why one runs before another). Where it
/// is free, it is chosen for few barriers and short lifetimes. With `shuffle`, a seed, it is any other legal
/// order: for tests, since a frame that depends on it has a pass with an undeclared input.
[[nodiscard]] CANDELA_API CompileResult compile(FrameGraph&& graph,
                                                std::optional<std::uint32_t> shuffle = {});

/// Two passes that write the same type of component, of which nobody has said which comes first: the later
/// declared one neither reads the type nor depends on the other, directly or through other passes.
struct Ambiguity {
    std::string component;
    std::string first;   ///< name of the pass that was declared first, and runs first
    std::string second;  ///< name of the other pass
    bool operator==(const Ambiguity&) const = default;
};
/// For tests of a host's systems. Takes quadratic time.
[[nodiscard]] CANDELA_API std::vector<Ambiguity> find_ambiguities(const CompiledGraph& graph);

}  // namespace candela
