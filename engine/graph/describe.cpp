#include <candela/graph/describe.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/json/json.hpp"

namespace candela {
namespace {

using detail::Access;
using detail::none;
using detail::Resource;

std::string storage_text(const CompiledGraph& graph, const Resource& resource) {
    if (resource.kind == ResourceKind::value) {
        return "value";
    }
    if (resource.kind == ResourceKind::buffer) {
        const BufferDesc& desc = graph.declared().buffer(resource);
        return fmt::format("buffer of {} x {} bytes", desc.count, desc.stride);
    }
    const TextureDesc& desc = graph.declared().texture(resource);
    std::string text = fmt::format("texture {}x{} {}", desc.size.x, desc.size.y, to_string(desc.format));
    if (desc.shape != TextureShape::flat) {
        text += fmt::format(", {} of {} layers", to_string(desc.shape), desc.layers);
    }
    if (desc.mips != 1) {
        text += fmt::format(", {} mips", desc.mips);
    }
    if (resource.part_of != none) {
        text += fmt::format(", part of {}", graph.declared().resources[resource.part_of].name);
    }
    return text;
}

std::string name_of(const CompiledGraph& graph, std::uint32_t resource) {
    const Resource& named = graph.declared().resources[resource];
    return fmt::format("{}{}", named.history_of == none ? "" : "history of ", named.name);
}

std::string access_text(const CompiledGraph& graph, const Access& access) {
    const Resource& resource = graph.declared().resources[access.resource];
    std::string text = name_of(graph, access.resource);
    if (resource.history_of == none) {
        text += fmt::format(" v{}", access.version);
    }
    if (resource.kind != ResourceKind::value) {
        text += fmt::format(" ({})", to_string(access.usage));
    }
    return text;
}

/// Culled passes, in the order of declaration.
std::vector<std::uint32_t> culled_passes(const CompiledGraph& graph) {
    std::vector<bool> kept(graph.declared().pass_count(), false);
    for (const std::uint32_t pass : graph.plan().order) {
        kept[pass] = true;
    }
    std::vector<std::uint32_t> culled;
    for (std::uint32_t pass = 0; pass < kept.size(); ++pass) {
        if (!kept[pass]) {
            culled.push_back(pass);
        }
    }
    return culled;
}

/// Resources that kept passes use, without histories.
std::vector<std::uint32_t> used_resources(const CompiledGraph& graph) {
    std::vector<std::uint32_t> used;
    for (std::uint32_t index = 0; index < graph.declared().resources.size(); ++index) {
        const bool previous = graph.declared().resources[index].history_of != none;
        if (!previous && graph.plan().object[index] != none) {
            used.push_back(index);
        }
    }
    return used;
}

/// Per object: its number among the textures and buffers; none for values.
std::vector<std::uint32_t> object_numbers(const CompiledGraph& graph) {
    std::vector<std::uint32_t> numbers;
    std::uint32_t next = 0;
    for (const std::uint32_t owner : graph.plan().owner) {
        const bool value = graph.declared().resources[owner].kind == ResourceKind::value;
        numbers.push_back(value ? none : next++);
    }
    return numbers;
}

std::string pass_text(const CompiledGraph& graph, std::uint32_t position) {
    const std::uint32_t pass = graph.plan().order[position];
    const detail::PassNode& node = graph.declared().passes[pass];
    std::string text =
        fmt::format("  {} {}{}\n", position, node.name, node.side_effect ? " (side effect)" : "");
    const auto line = [&](std::string_view verb, std::string_view what) {
        text += fmt::format("      {} {}\n", verb, what);
    };
    const Barrier barrier = graph.plan().barrier[position];
    if (barrier != Barrier::none) {
        line("barrier", to_string(barrier));
    }
    for (const detail::ComponentRead& read : graph.declared().components_of(pass)) {
        line("world", read.name);
    }
    for (const Access& access : graph.declared().accesses_of(pass)) {
        line(access.update ? "update" : access.write ? "write" : "read", access_text(graph, access));
    }
    return text;
}

std::string resource_text(const CompiledGraph& graph, std::uint32_t index,
                          const std::vector<std::uint32_t>& numbers) {
    const Resource& resource = graph.declared().resources[index];
    const detail::Span span = graph.plan().lifetime[index];
    const std::uint32_t object = numbers[graph.plan().object[index]];
    std::string text = fmt::format("  {}: {}, {} [{}..{}]", resource.name, storage_text(graph, resource),
                                   to_string(resource.lifetime), span.first, span.last);
    if (object != none) {
        text += fmt::format(", object {}", object);
    }
    if (resource.history != none) {
        text += fmt::format(", history in {}", object + 1);
    }
    return text + "\n";
}

std::string dot_name(std::string_view text) {
    std::string escaped = "\"";
    for (const char character : text) {
        if (character == '"' || character == '\\') {
            escaped += '\\';
        }
        escaped += character;
    }
    return escaped + "\"";
}

/// The names, one per line.
std::string dot_label(const std::vector<std::string>& names) {
    std::string label;
    for (const std::string& name : names) {
        const std::string quoted = dot_name(name);
        label += (label.empty() ? "" : "\\n") + quoted.substr(1, quoted.size() - 2);
    }
    return '"' + label + '"';
}

/// All that one pass needs of another, of this frame or of the last one.
struct DotEdge {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool of_history = false;
    std::vector<std::string> resources;
};

void add_dot_edge(std::vector<DotEdge>& edges, DotEdge edge) {
    const auto same = std::ranges::find_if(edges, [&](const DotEdge& other) {
        return other.from == edge.from && other.to == edge.to && other.of_history == edge.of_history;
    });
    if (same == edges.end()) {
        edges.push_back(std::move(edge));
    } else if (std::ranges::count(same->resources, edge.resources.front()) == 0) {
        same->resources.push_back(std::move(edge.resources.front()));
    }
}

std::vector<DotEdge> dot_edges(const CompiledGraph& graph) {
    const detail::Declaration& declared = graph.declared();
    const detail::Plan& plan = graph.plan();
    std::vector<DotEdge> edges;
    for (const std::uint32_t pass : plan.order) {
        for (const Access& access : declared.accesses_of(pass)) {
            const std::uint32_t base = declared.resources[access.resource].history_of;
            const std::uint32_t version =
                base == none ? plan.version(access.resource, access.version - (access.write ? 1 : 0))
                             : plan.version(base, declared.resources[base].versions);
            const std::uint32_t writer = plan.writer[version];
            if (writer == none || (writer == pass && base == none)) {
                continue;
            }
            add_dot_edge(edges, {writer, pass, base != none, {name_of(graph, access.resource)}});
        }
    }
    return edges;
}

/// Whether the pass reads or writes textures or buffers; others only use values and components.
bool uses_gpu(const CompiledGraph& graph, std::uint32_t pass) {
    return std::ranges::any_of(graph.declared().accesses_of(pass), [&](const Access& access) {
        return graph.declared().resources[access.resource].kind != ResourceKind::value;
    });
}

Json pass_json(const CompiledGraph& graph, std::uint32_t position) {
    const std::uint32_t pass = graph.plan().order[position];
    const detail::PassNode& node = graph.declared().passes[pass];
    Json json{{"name", node.name},
              {"kind", uses_gpu(graph, pass) ? "gpu" : "cpu"},
              {"side_effect", node.side_effect},
              {"barrier", to_string(graph.plan().barrier[position])},
              {"world", Json::array()},
              {"reads", Json::array()},
              {"writes", Json::array()}};
    for (const detail::ComponentRead& read : graph.declared().components_of(pass)) {
        json["world"].push_back(read.name);
    }
    for (const Access& access : graph.declared().accesses_of(pass)) {
        Json entry{{"resource", name_of(graph, access.resource)}, {"version", access.version}};
        const bool value = graph.declared().resources[access.resource].kind == ResourceKind::value;
        if (!value) {
            entry["usage"] = to_string(access.usage);
        }
        if (access.update) {
            entry["update"] = true;
        }
        json[access.write ? "writes" : "reads"].push_back(std::move(entry));
    }
    return json;
}

/// The parts of storage_text on their own, as declared.
void add_storage(const CompiledGraph& graph, const Resource& resource, Json& json) {
    json["kind"] = to_string(resource.kind);
    if (resource.kind == ResourceKind::buffer) {
        const BufferDesc& desc = graph.declared().buffer(resource);
        json["count"] = desc.count;
        json["stride"] = desc.stride;
    }
    if (resource.kind == ResourceKind::texture) {
        const TextureDesc& desc = graph.declared().texture(resource);
        json["format"] = to_string(desc.format);
        json["shape"] = to_string(desc.shape);
        json["size"] = {desc.size.x, desc.size.y};
        json["layers"] = desc.layers;
        json["mips"] = desc.mips;
    }
}

}  // namespace

std::string describe_text(const CompiledGraph& graph) {
    std::string text = "passes\n";
    for (std::uint32_t position = 0; position < graph.pass_count(); ++position) {
        text += pass_text(graph, position);
    }
    const std::vector<std::uint32_t> culled = culled_passes(graph);
    if (!culled.empty()) {
        text += "culled\n";
    }
    for (const std::uint32_t pass : culled) {
        text += fmt::format("  {}\n", graph.declared().passes[pass].name);
    }
    text += "resources\n";
    const std::vector<std::uint32_t> numbers = object_numbers(graph);
    for (const std::uint32_t index : used_resources(graph)) {
        text += resource_text(graph, index, numbers);
    }
    return text;
}

std::string describe_dot(const CompiledGraph& graph) {
    const detail::Declaration& declared = graph.declared();
    std::string text =
        "digraph frame {\n    rankdir=LR;\n    label=\"boxes: on the GPU; rounded: on the CPU; dashed: last "
        "frame's\";\n    node [shape=box, style=filled, fillcolor=\"#cfe2f3\"];\n";
    for (const std::uint32_t pass : graph.plan().order) {
        const char* look = uses_gpu(graph, pass) ? "" : " [style=\"rounded,filled\", fillcolor=\"#fff2cc\"]";
        text += fmt::format("    {}{};\n", dot_name(declared.passes[pass].name), look);
    }
    for (const DotEdge& edge : dot_edges(graph)) {
        text += fmt::format("    {} -> {} [label={}{}];\n", dot_name(declared.passes[edge.from].name),
                            dot_name(declared.passes[edge.to].name), dot_label(edge.resources),
                            edge.of_history ? ", style=dashed" : "");
    }
    return text + "}\n";
}

std::string describe_json(const CompiledGraph& graph) {
    Json json{{"passes", Json::array()}, {"culled", Json::array()}, {"resources", Json::array()}};
    for (std::uint32_t position = 0; position < graph.pass_count(); ++position) {
        json["passes"].push_back(pass_json(graph, position));
    }
    for (const std::uint32_t pass : culled_passes(graph)) {
        json["culled"].push_back(graph.declared().passes[pass].name);
    }
    const std::vector<std::uint32_t> numbers = object_numbers(graph);
    for (const std::uint32_t index : used_resources(graph)) {
        const Resource& resource = graph.declared().resources[index];
        const detail::Span span = graph.plan().lifetime[index];
        Json entry{{"name", resource.name},
                   {"storage", storage_text(graph, resource)},
                   {"lifetime", to_string(resource.lifetime)},
                   {"first", span.first},
                   {"last", span.last}};
        const std::uint32_t object = numbers[graph.plan().object[index]];
        if (object != none) {
            entry["object"] = object;
        }
        if (resource.history != none) {
            entry["history_object"] = object + 1;
        }
        add_storage(graph, resource, entry);
        json["resources"].push_back(std::move(entry));
    }
    return json.dump(2) + "\n";
}

}  // namespace candela
