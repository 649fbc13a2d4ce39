#include <candela/graph/describe.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

nlohmann::ordered_json pass_json(const CompiledGraph& graph, std::uint32_t position) {
    const std::uint32_t pass = graph.plan().order[position];
    const detail::PassNode& node = graph.declared().passes[pass];
    nlohmann::ordered_json json{{"name", node.name},
                                {"side_effect", node.side_effect},
                                {"barrier", to_string(graph.plan().barrier[position])},
                                {"world", nlohmann::ordered_json::array()},
                                {"reads", nlohmann::ordered_json::array()},
                                {"writes", nlohmann::ordered_json::array()}};
    for (const detail::ComponentRead& read : graph.declared().components_of(pass)) {
        json["world"].push_back(read.name);
    }
    for (const Access& access : graph.declared().accesses_of(pass)) {
        nlohmann::ordered_json entry{{"resource", name_of(graph, access.resource)},
                                     {"version", access.version}};
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
    const detail::Plan& plan = graph.plan();
    std::string text = "digraph frame {\n    rankdir=LR;\n    node [shape=box];\n";
    for (const std::uint32_t pass : plan.order) {
        text += fmt::format("    {};\n", dot_name(declared.passes[pass].name));
    }
    for (const std::uint32_t pass : plan.order) {
        const std::string to = dot_name(declared.passes[pass].name);
        for (const Access& access : declared.accesses_of(pass)) {
            const std::uint32_t base = declared.resources[access.resource].history_of;
            const std::uint32_t version =
                base == none ? plan.version(access.resource, access.version - (access.write ? 1 : 0))
                             : plan.version(base, declared.resources[base].versions);
            const std::uint32_t writer = plan.writer[version];
            if (writer == none || (writer == pass && base == none)) {
                continue;
            }
            text +=
                fmt::format("    {} -> {} [label={}{}];\n", dot_name(declared.passes[writer].name), to,
                            dot_name(name_of(graph, access.resource)), base == none ? "" : ", style=dashed");
        }
    }
    return text + "}\n";
}

std::string describe_json(const CompiledGraph& graph) {
    nlohmann::ordered_json json{{"passes", nlohmann::ordered_json::array()},
                                {"culled", nlohmann::ordered_json::array()},
                                {"resources", nlohmann::ordered_json::array()}};
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
        nlohmann::ordered_json entry{{"name", resource.name},
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
        json["resources"].push_back(std::move(entry));
    }
    return json.dump(2) + "\n";
}

}  // namespace candela
