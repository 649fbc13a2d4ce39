#include "sandbox/panels/graph_picture.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "sandbox/candela_private/files.hpp"

namespace candela::sandbox {

namespace {

using Indices = std::map<std::string, std::size_t, std::less<>>;

GraphResource::Kind kind_of(std::string_view kind) {
    if (kind == "texture") return GraphResource::Kind::texture;
    return kind == "buffer" ? GraphResource::Kind::buffer : GraphResource::Kind::value;
}

std::vector<std::size_t> indices_of(const Json& accesses, const Indices& resources) {
    std::vector<std::size_t> found;
    for (const Json& access : accesses.items()) {
        const auto resource = resources.find(access.at("resource").text());
        if (resource != resources.end()) found.push_back(resource->second);
    }
    return found;
}

/// The last pass before `position` that writes the resource.
std::optional<std::size_t> writer_before(const std::vector<GraphPass>& passes, std::size_t position,
                                         std::size_t resource) {
    while (position-- > 0) {
        if (std::ranges::count(passes[position].writes, resource) > 0) return position;
    }
    return std::nullopt;
}

void add_edges(GraphPicture& graph, std::size_t position) {
    std::vector<std::size_t> used = graph.passes[position].reads;
    used.insert(used.end(), graph.passes[position].writes.begin(), graph.passes[position].writes.end());
    for (const std::size_t resource : used) {
        const std::optional<std::size_t> writer = writer_before(graph.passes, position, resource);
        if (!writer) continue;
        const GraphEdge edge{*writer, position};
        if (std::ranges::count(graph.edges, edge) == 0) graph.edges.push_back(edge);
    }
}

}  // namespace

GraphPicture read_graph(std::string_view json) {
    const Json document = Json::parse(json);
    // Names that begin with "inspect" are those of the view of resources itself.
    GraphPicture graph;
    Indices resources;
    for (const Json& entry : document.at("resources").items()) {
        if (entry.at("name").text().starts_with("inspect")) continue;
        resources.emplace(entry.at("name").text(), graph.resources.size());
        graph.resources.push_back({.name = entry.at("name").text(),
                                   .storage = entry.at("storage").text(),
                                   .lifetime = entry.at("lifetime").text(),
                                   .kind = kind_of(entry.at("kind").text())});
    }
    for (const Json& entry : document.at("passes").items()) {
        if (entry.at("name").text().starts_with("inspect")) continue;
        GraphPass pass{.name = entry.at("name").text(),
                       .gpu = entry.at("kind").is("gpu"),
                       .reads = indices_of(entry.at("reads"), resources),
                       .writes = indices_of(entry.at("writes"), resources)};
        graph.passes.push_back(std::move(pass));
    }
    for (std::size_t position = 0; position < graph.passes.size(); ++position) add_edges(graph, position);
    return graph;
}

}  // namespace candela::sandbox
