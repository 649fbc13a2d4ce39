#include <candela/graph/describe.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/plan.hpp"
#include "engine/graph/details/state.hpp"
#include "engine/json/json.hpp"

namespace candela {
namespace {

using detail::Access;
using detail::none;
using detail::Resource;

/// `object`: of the plan.
bool is_described(const Resource& resource, std::uint32_t object) {
    return resource.history_of == none && object != none;
}

/// Makes the description of a graph.
class Describer {
 public:
    explicit Describer(const CompiledGraph& graph) : declared_(graph.declared()), plan_(graph.plan()) {}

    GraphDescription describe() {
        add_resources();
        position_.assign(declared_.pass_count(), none);
        for (std::uint32_t position = 0; position < plan_.order.size(); ++position) {
            position_[plan_.order[position]] = position;
            add_pass(position);
        }
        for (std::uint32_t pass = 0; pass < declared_.pass_count(); ++pass) {
            if (position_[pass] == none) made_.culled.emplace_back(declared_.passes[pass].name);
        }
        for (std::uint32_t position = 0; position < plan_.order.size(); ++position) {
            for (const Access& access : declared_.accesses_of(plan_.order[position])) {
                add_edge(access, position);
            }
        }
        return std::move(made_);
    }

 private:
    void add_resources() {
        const std::vector<std::uint32_t> numbers = object_numbers();
        index_.assign(declared_.resources.size(), none);
        for (std::uint32_t index = 0; index < declared_.resources.size(); ++index) {
            const Resource& resource = declared_.resources[index];
            if (is_described(resource, plan_.object[index])) {
                index_[index] = detail::size_of(made_.resources);
                made_.resources.push_back(describe(resource, index, numbers[plan_.object[index]]));
            }
        }
    }

    /// Per object: its number among the textures and buffers; none for values.
    [[nodiscard]] std::vector<std::uint32_t> object_numbers() const {
        std::vector<std::uint32_t> numbers;
        std::uint32_t next = 0;
        for (const std::uint32_t owner : plan_.owner) {
            const bool value = declared_.resources[owner].storage->kind == ResourceKind::value;
            numbers.push_back(value ? none : next++);
        }
        return numbers;
    }

    [[nodiscard]] DescribedResource describe(const Resource& resource, std::uint32_t index,
                                             std::uint32_t object) const {
        DescribedResource made{.name = std::string(resource.name),
                               .kind = resource.storage->kind,
                               .lifetime = resource.lifetime,
                               .texture = resource.storage->texture,
                               .buffer = resource.storage->buffer,
                               .first = plan_.lifetime[index].first,
                               .last = plan_.lifetime[index].last};
        if (resource.part_of != none) made.part_of = declared_.resources[resource.part_of].name;
        if (object != none) made.object = object;
        if (resource.history != none) made.history_object = object + 1;
        return made;
    }

    /// In GraphDescription::resources; of a history that of its texture.
    [[nodiscard]] std::size_t index_of(const Access& access) const {
        const std::uint32_t base = declared_.resources[access.resource].history_of;
        return index_[base == none ? access.resource : base];
    }

    void add_pass(std::uint32_t position) {
        const std::uint32_t pass = plan_.order[position];
        const detail::PassNode& node = declared_.passes[pass];
        DescribedPass made{.name = std::string(node.name),
                           .side_effect = node.side_effect,
                           .barrier = plan_.barrier[position]};
        for (const detail::ComponentRead& read : declared_.components_of(pass)) {
            made.components.emplace_back(read.name);
        }
        for (const Access& access : declared_.accesses_of(pass)) {
            const Resource& resource = declared_.resources[access.resource];
            DescribedAccess use{.resource = index_of(access),
                                .version = access.version,
                                .history = resource.history_of != none,
                                .write = access.write,
                                .update = access.update};
            if (resource.storage->kind != ResourceKind::value) {
                made.gpu = true;
                use.usage = access.usage;
            }
            made.accesses.push_back(use);
        }
        made_.passes.push_back(std::move(made));
    }

    /// From the pass whose result is accessed.
    void add_edge(const Access& access, std::uint32_t position) {
        const bool history = declared_.resources[access.resource].history_of != none;
        const std::uint32_t writer = plan_.writer[plan_.needed_version(declared_, access)];
        if (writer == none || (writer == plan_.order[position] && !history)) return;
        DescribedEdge edge{position_[writer], position, history, {index_of(access)}};
        const auto same = std::find_if(first_edge(position), made_.edges.end(), [&](const auto& other) {
            return other.from == edge.from && other.history == edge.history;
        });
        if (same == made_.edges.end()) {
            made_.edges.push_back(std::move(edge));
        } else if (std::ranges::count(same->resources, edge.resources.front()) == 0) {
            same->resources.push_back(edge.resources.front());
        }
    }

    /// The edges to the pass at `position` are the last ones.
    [[nodiscard]] std::vector<DescribedEdge>::iterator first_edge(std::size_t position) {
        return std::ranges::lower_bound(made_.edges, position, {}, &DescribedEdge::to);
    }

    const detail::Declaration& declared_;
    const detail::Plan& plan_;
    GraphDescription made_;
    std::vector<std::uint32_t> position_;  // per declared pass: its position, or none
    std::vector<std::uint32_t> index_;     // per declared resource: its index in the description, or none
};

std::string name_of(const GraphDescription& graph, std::size_t resource, bool history) {
    return (history ? "history of " : "") + graph.resources[resource].name;
}

std::string access_text(const GraphDescription& graph, const DescribedAccess& access) {
    std::string text = name_of(graph, access.resource, access.history);
    if (!access.history) text += fmt::format(" v{}", access.version);
    if (access.usage) text += fmt::format(" ({})", to_string(*access.usage));
    return text;
}

std::string pass_text(const GraphDescription& graph, std::size_t position) {
    const DescribedPass& pass = graph.passes[position];
    std::string text =
        fmt::format("  {} {}{}\n", position, pass.name, pass.side_effect ? " (side effect)" : "");
    const auto line = [&](std::string_view verb, std::string_view what) {
        text += fmt::format("      {} {}\n", verb, what);
    };
    if (pass.barrier != Barrier::none) line("barrier", to_string(pass.barrier));
    for (const std::string& component : pass.components) {
        line("world", component);
    }
    for (const DescribedAccess& access : pass.accesses) {
        line(access.update ? "update" : access.write ? "write" : "read", access_text(graph, access));
    }
    return text;
}

std::string resource_text(const DescribedResource& resource) {
    std::string text = fmt::format("  {}: {}, {} [{}..{}]", resource.name, storage_text(resource),
                                   to_string(resource.lifetime), resource.first, resource.last);
    if (resource.object) text += fmt::format(", object {}", *resource.object);
    if (resource.history_object) text += fmt::format(", history in {}", *resource.history_object);
    return text + "\n";
}

/// For the inside of quotation marks.
std::string dot_escaped(std::string_view text) {
    std::string escaped;
    for (const char character : text) {
        if (character == '"' || character == '\\') escaped += '\\';
        escaped += character;
    }
    return escaped;
}

std::string dot_edge(const GraphDescription& graph, const DescribedEdge& edge) {
    std::string label;
    for (const std::size_t resource : edge.resources) {
        label += (label.empty() ? "" : "\\n") + dot_escaped(name_of(graph, resource, edge.history));
    }
    return fmt::format("    \"{}\" -> \"{}\" [label=\"{}\"{}];\n", dot_escaped(graph.passes[edge.from].name),
                       dot_escaped(graph.passes[edge.to].name), label, edge.history ? ", style=dashed" : "");
}

Json pass_json(const GraphDescription& graph, const DescribedPass& pass) {
    Json json{{"name", pass.name},
              {"kind", pass.gpu ? "gpu" : "cpu"},
              {"side_effect", pass.side_effect},
              {"barrier", to_string(pass.barrier)},
              {"world", Json::array(std::vector<Json>(pass.components.begin(), pass.components.end()))},
              {"reads", Json::array()},
              {"writes", Json::array()}};
    for (const DescribedAccess& access : pass.accesses) {
        Json entry{{"resource", name_of(graph, access.resource, access.history)},
                   {"version", access.version}};
        if (access.usage) entry["usage"] = to_string(*access.usage);
        if (access.update) entry["update"] = true;
        json[access.write ? "writes" : "reads"].push_back(std::move(entry));
    }
    return json;
}

Json resource_json(const DescribedResource& resource) {
    Json json{{"name", resource.name},
              {"storage", storage_text(resource)},
              {"lifetime", to_string(resource.lifetime)},
              {"first", resource.first},
              {"last", resource.last}};
    if (resource.object) json["object"] = *resource.object;
    if (resource.history_object) json["history_object"] = *resource.history_object;
    json["kind"] = to_string(resource.kind);
    if (resource.kind == ResourceKind::buffer) {
        json["count"] = resource.buffer.count;
        json["stride"] = resource.buffer.stride;
    }
    if (resource.kind == ResourceKind::texture) {
        const TextureDesc& desc = resource.texture;
        json["format"] = to_string(desc.format);
        json["shape"] = to_string(desc.shape);
        json["size"] = {desc.size.x, desc.size.y};
        json["layers"] = desc.layers;
        json["mips"] = desc.mips;
    }
    return json;
}

}  // namespace

GraphDescription describe(const CompiledGraph& graph) {
    return Describer(graph).describe();
}

GraphDescription GraphRuntime::describe() const {
    if (!graph_) throw GraphError("there is no frame graph");
    GraphDescription made = candela::describe(*graph_);
    const std::vector<Resource>& resources = graph_->declared().resources;
    auto described = made.resources.begin();
    for (std::size_t index = 0; index < resources.size(); ++index) {
        const std::uint32_t object = graph_->plan().object[index];
        if (!is_described(resources[index], object)) continue;
        const detail::Slot& slot = state_->slots[object];
        const bool is_import = resources[index].lifetime == Lifetime::imported;
        if (!slot.view && (slot.filled || !is_import)) {
            described->texture = slot.storage.texture;
            described->buffer = slot.storage.buffer;
        }
        ++described;
    }
    return made;
}

std::string storage_text(const DescribedResource& resource) {
    if (resource.kind == ResourceKind::value) return "value";
    if (resource.kind == ResourceKind::buffer) {
        return fmt::format("buffer of {} x {} bytes", resource.buffer.count, resource.buffer.stride);
    }
    const TextureDesc& desc = resource.texture;
    std::string text = fmt::format("texture {}x{} {}", desc.size.x, desc.size.y, to_string(desc.format));
    if (desc.shape != TextureShape::flat) {
        text += fmt::format(", {} of {} layers", to_string(desc.shape), desc.layers);
    }
    if (desc.mips != 1) text += fmt::format(", {} mips", desc.mips);
    if (!resource.part_of.empty()) text += fmt::format(", part of {}", resource.part_of);
    return text;
}

std::string describe_text(const GraphDescription& graph) {
    std::string text = "passes\n";
    for (std::size_t position = 0; position < graph.passes.size(); ++position) {
        text += pass_text(graph, position);
    }
    if (!graph.culled.empty()) text += "culled\n";
    for (const std::string& pass : graph.culled) {
        text += fmt::format("  {}\n", pass);
    }
    text += "resources\n";
    for (const DescribedResource& resource : graph.resources) {
        text += resource_text(resource);
    }
    return text;
}

std::string describe_dot(const GraphDescription& graph) {
    std::string text =
        "digraph frame {\n    rankdir=LR;\n    label=\"boxes: on the GPU; rounded: on the CPU; dashed: last "
        "frame's\";\n    node [shape=box, style=filled, fillcolor=\"#cfe2f3\"];\n";
    for (const DescribedPass& pass : graph.passes) {
        const char* look = pass.gpu ? "" : " [style=\"rounded,filled\", fillcolor=\"#fff2cc\"]";
        text += fmt::format("    \"{}\"{};\n", dot_escaped(pass.name), look);
    }
    for (const DescribedEdge& edge : graph.edges) {
        text += dot_edge(graph, edge);
    }
    return text + "}\n";
}

std::string describe_json(const GraphDescription& graph) {
    Json json{{"passes", Json::array()},
              {"culled", Json::array(std::vector<Json>(graph.culled.begin(), graph.culled.end()))},
              {"resources", Json::array()}};
    for (const DescribedPass& pass : graph.passes) {
        json["passes"].push_back(pass_json(graph, pass));
    }
    for (const DescribedResource& resource : graph.resources) {
        json["resources"].push_back(resource_json(resource));
    }
    return json.dump(2) + "\n";
}

}  // namespace candela
