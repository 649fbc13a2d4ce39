#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace candela::sandbox {

/// A resource of a frame graph, as Renderer::describe tells.
struct GraphResource {
    std::string name;
    std::string storage;   ///< in words: size, format, ...
    std::string lifetime;  ///< transient, persistent, ...
    enum class Kind { value, buffer, texture } kind = Kind::value;
};

/// A pass, with the indices of the resources that it reads and writes in GraphPicture::resources.
struct GraphPass {
    std::string name;
    bool gpu = false;  ///< reads or writes a buffer or a texture
    std::vector<std::size_t> reads;
    std::vector<std::size_t> writes;
};

/// One pass needs a result of another.
struct GraphEdge {
    std::size_t from = 0;  ///< index in GraphPicture::passes
    std::size_t to = 0;
    bool operator==(const GraphEdge&) const = default;
};

/// A frame graph to be drawn. Passes are in the order in which they run.
struct GraphPicture {
    std::vector<GraphPass> passes;
    std::vector<GraphResource> resources;
    std::vector<GraphEdge> edges;  ///< no two are equal
};

/// From the JSON of Renderer::describe.
[[nodiscard]] GraphPicture read_graph(std::string_view json);

}  // namespace candela::sandbox
