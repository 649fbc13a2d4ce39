#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <candela/api.hpp>
#include <candela/graph/backend.hpp>
#include <candela/graph/compile.hpp>

namespace candela {

/// One use of a resource by a pass.
struct DescribedAccess {
    std::size_t resource = 0;      ///< index in GraphDescription::resources
    std::uint32_t version = 0;     ///< that is read, or that the write produces
    std::optional<Usage> usage{};  ///< none for values
    bool write = false;
    bool update = false;  ///< a write by Pass::update
};

/// Access of a pass to all components of a type.
struct DescribedComponent {
    std::string name;
    bool write = false;
    bool operator==(const DescribedComponent&) const = default;
};

struct DescribedPass {
    std::string name;
    bool gpu = false;  ///< uses textures or buffers, not only values and components
    bool side_effect = false;
    Barrier barrier = Barrier::none;               ///< issued before the pass
    std::vector<DescribedComponent> components{};  ///< of the world, in the order of declaration
    bool writes_entities = false;                  ///< creates or destroys them
    std::vector<DescribedAccess> accesses{};       ///< in the order of declaration
};

struct DescribedResource {
    std::string name;
    ResourceKind kind = ResourceKind::value;
    Lifetime lifetime = Lifetime::transient;
    TextureDesc texture{};    ///< of textures, as declared; or as it is now: GraphRuntime::describe
    BufferDesc buffer{};      ///< of buffers, likewise
    std::uint32_t first = 0;  ///< positions of the first and the last pass that uses it
    std::uint32_t last = 0;
    std::optional<std::uint32_t> object{};  ///< number of its storage; none for values
};

/// Why one pass runs before another.
enum class DependencyKind : std::uint8_t {
    result,               ///< the later one reads or changes a resource that the earlier one has written
    overwrite,            ///< it overwrites a resource that the earlier one reads
    component_result,     ///< it reads components that the earlier one writes
    component_overwrite,  ///< it writes components that the earlier one reads or writes
    side_effect,          ///< both have side effects, which keep the order of declaration
    after                 ///< Pass::after
};
[[nodiscard]] CANDELA_API std::string_view to_string(DependencyKind kind);

/// All reasons of one kind why a pass runs before another.
struct DescribedEdge {
    std::size_t from = 0;  ///< indices in GraphDescription::passes
    std::size_t to = 0;
    DependencyKind kind = DependencyKind::result;
    std::vector<std::string> subjects{};  ///< names of the resources or components
    bool operator==(const DescribedEdge&) const = default;
};

/// What a compiled graph does, without the graph.
struct GraphDescription {
    std::vector<DescribedPass> passes;         ///< in the order in which they run
    std::vector<std::string> culled;           ///< names, in the order of declaration
    std::vector<DescribedResource> resources;  ///< those that the passes use
    /// At most one of each kind from one pass to another, ordered by `to`.
    std::vector<DescribedEdge> edges;
};

/// The same declaration always gives the same description.
[[nodiscard]] CANDELA_API GraphDescription describe(const CompiledGraph& graph);

/// For example "texture 64x32 rgba16f, array of 3 layers, 2 mips".
[[nodiscard]] CANDELA_API std::string storage_text(const DescribedResource& resource);

/// For example "draw (result: image)", to follow "after".
[[nodiscard]] CANDELA_API std::string edge_text(const GraphDescription& graph, const DescribedEdge& edge);

/// A listing for readers and golden tests.
[[nodiscard]] CANDELA_API std::string describe_text(const GraphDescription& graph);
}  // namespace candela
