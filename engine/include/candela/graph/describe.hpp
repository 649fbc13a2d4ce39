#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <candela/api.hpp>
#include <candela/graph/backend.hpp>
#include <candela/graph/compile.hpp>

namespace candela {

/// One use of a resource by a pass.
struct DescribedAccess {
    std::size_t resource = 0;      ///< index in GraphDescription::resources
    std::uint32_t version = 0;     ///< that is read, or that the write produces; 0 of a history
    std::optional<Usage> usage{};  ///< none for values
    bool history = false;          ///< reads the content of the last frame
    bool write = false;
    bool update = false;  ///< a write by Pass::update
};

struct DescribedPass {
    std::string name;
    bool gpu = false;  ///< uses textures or buffers, not only values and components
    bool side_effect = false;
    Barrier barrier = Barrier::none;          ///< issued before the pass
    std::vector<std::string> components{};    ///< names of those that it reads from the world
    std::vector<DescribedAccess> accesses{};  ///< in the order of declaration
};

struct DescribedResource {
    std::string name;
    ResourceKind kind = ResourceKind::value;
    Lifetime lifetime = Lifetime::transient;
    TextureDesc texture{};    ///< of textures, as declared; or as it is now: GraphRuntime::describe
    BufferDesc buffer{};      ///< of buffers, likewise
    std::string part_of{};    ///< of a part: the name of the texture; else empty
    std::uint32_t first = 0;  ///< positions of the first and the last pass that uses it
    std::uint32_t last = 0;
    std::optional<std::uint32_t> object{};          ///< number of its storage; none for values
    std::optional<std::uint32_t> history_object{};  ///< number of the storage of its history, if it has one
};

/// All that one pass needs of another: of this frame, or of the last one.
struct DescribedEdge {
    std::size_t from = 0;  ///< indices in GraphDescription::passes
    std::size_t to = 0;
    bool history = false;
    std::vector<std::size_t> resources;  ///< indices in GraphDescription::resources
    bool operator==(const DescribedEdge&) const = default;
};

/// What a compiled graph does, without the graph.
struct GraphDescription {
    std::vector<DescribedPass> passes;         ///< in the order in which they run
    std::vector<std::string> culled;           ///< names, in the order of declaration
    std::vector<DescribedResource> resources;  ///< those that the passes use, without histories
    std::vector<DescribedEdge> edges;          ///< at most one of each kind from one pass to another
};

/// The same declaration always gives the same description.
[[nodiscard]] CANDELA_API GraphDescription describe(const CompiledGraph& graph);

/// For example "texture 64x32 rgba16f, array of 3 layers, 2 mips".
[[nodiscard]] CANDELA_API std::string storage_text(const DescribedResource& resource);

/// A listing for readers and golden tests: all but the edges.
[[nodiscard]] CANDELA_API std::string describe_text(const GraphDescription& graph);
/// Graphviz source. Passes are boxes, rounded if they use neither textures nor buffers; edges to histories
/// are dashed.
[[nodiscard]] CANDELA_API std::string describe_dot(const GraphDescription& graph);
/// The content of describe_text as a JSON document. The storage of a resource is also given by fields: its
/// kind; of a texture format, shape, size, layers and mips; of a buffer count and stride in bytes.
[[nodiscard]] CANDELA_API std::string describe_json(const GraphDescription& graph);

}  // namespace candela
