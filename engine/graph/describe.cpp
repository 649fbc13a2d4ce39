#include <candela/graph/describe.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/runtime.hpp"
#include "engine/graph/details/schedule.hpp"

namespace candela {
namespace {

using detail::Access;
using detail::Dependency;
using detail::none;
using detail::Resource;

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
        add_edges();
        return std::move(made_);
    }

 private:
    void add_resources() {
        const std::vector<std::uint32_t> numbers = object_numbers();
        index_.assign(declared_.resources.size(), none);
        for (std::uint32_t index = 0; index < declared_.resources.size(); ++index) {
            const Resource& resource = declared_.resources[index];
            if (plan_.object[index] != none) {
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
        if (object != none) made.object = object;
        return made;
    }

    void add_pass(std::uint32_t position) {
        const std::uint32_t pass = plan_.order[position];
        const detail::PassNode& node = declared_.passes[pass];
        DescribedPass made{.name = std::string(node.name),
                           .side_effect = node.side_effect,
                           .barrier = plan_.barrier[position],
                           .writes_entities = node.writes_entities};
        for (const detail::ComponentAccess& access : declared_.components_of(pass)) {
            made.components.push_back({std::string(access.name), access.write});
        }
        for (const Access& access : declared_.accesses_of(pass)) {
            const Resource& resource = declared_.resources[access.resource];
            DescribedAccess use{.resource = index_[access.resource],
                                .version = access.version,
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

    void add_edges() {
        std::vector<std::uint32_t> kept = plan_.order;
        std::ranges::sort(kept);
        for (const Dependency& dependency : detail::find_dependencies(declared_, plan_, kept)) {
            add_edge(dependency, subject_of(dependency));
        }
        std::ranges::sort(made_.edges, {}, [](const DescribedEdge& edge) {
            return std::tuple(edge.to, edge.from, edge.kind);
        });
    }

    [[nodiscard]] std::string_view subject_of(const Dependency& dependency) const {
        switch (dependency.kind) {
            case DependencyKind::result:
            case DependencyKind::overwrite:
                return declared_.resources[dependency.subject].name;
            case DependencyKind::component_result:
            case DependencyKind::component_overwrite:
                return declared_.components[dependency.subject].name;
            default:
                return "";
        }
    }

    void add_edge(const Dependency& dependency, std::string_view subject) {
        const DescribedEdge edge{position_[dependency.from], position_[dependency.to], dependency.kind};
        const auto [known, is_new] = edge_.try_emplace({edge.from, edge.to, edge.kind}, made_.edges.size());
        if (is_new) made_.edges.push_back(edge);
        std::vector<std::string>& subjects = made_.edges[known->second].subjects;
        if (!subject.empty() && std::ranges::count(subjects, subject) == 0) subjects.emplace_back(subject);
    }

    const detail::Declaration& declared_;
    const detail::Plan& plan_;
    GraphDescription made_;
    std::vector<std::uint32_t> position_;  // per declared pass: its position, or none
    std::vector<std::uint32_t> index_;     // per declared resource: its index in the description, or none
    std::map<std::tuple<std::size_t, std::size_t, DependencyKind>, std::size_t> edge_;  // its index
};

std::string access_text(const GraphDescription& graph, const DescribedAccess& access) {
    std::string text = fmt::format("{} v{}", graph.resources[access.resource].name, access.version);
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
    for (const DescribedEdge& edge : graph.edges) {
        if (edge.to == position) line("after", edge_text(graph, edge));
    }
    if (pass.barrier != Barrier::none) line("barrier", to_string(pass.barrier));
    for (const DescribedComponent& component : pass.components) {
        line(component.write ? "change" : "world", component.name);
    }
    if (pass.writes_entities) line("change", "entities");
    for (const DescribedAccess& access : pass.accesses) {
        line(access.update ? "update" : access.write ? "write" : "read", access_text(graph, access));
    }
    return text;
}

std::string resource_text(const DescribedResource& resource) {
    std::string text = fmt::format("  {}: {}, {} [{}..{}]", resource.name, storage_text(resource),
                                   to_string(resource.lifetime), resource.first, resource.last);
    if (resource.object) text += fmt::format(", object {}", *resource.object);
    return text + "\n";
}

}  // namespace

GraphDescription describe(const CompiledGraph& graph) {
    return Describer(graph).describe();
}

GraphDescription GraphRuntime::describe() const {
    if (!graph()) throw GraphError("there is no frame graph");
    GraphDescription made = candela::describe(*graph());
    const std::vector<Resource>& resources = graph()->declared().resources;
    auto described = made.resources.begin();
    for (std::size_t index = 0; index < resources.size(); ++index) {
        const std::uint32_t object = graph()->plan().object[index];
        if (object == none) continue;
        const detail::Slot& slot = runtime_->state.slots[object];
        const bool is_import = resources[index].lifetime == Lifetime::imported;
        if (slot.bound || !is_import) {
            described->texture = slot.storage.texture;
            described->buffer = slot.storage.buffer;
        }
        ++described;
    }
    return made;
}

std::string_view to_string(DependencyKind kind) {
    static constexpr std::array<std::string_view, 6> names{
        "result", "overwrite", "component result", "component overwrite", "side effect", "after"};
    return names.at(static_cast<std::size_t>(kind));
}

std::string edge_text(const GraphDescription& graph, const DescribedEdge& edge) {
    return fmt::format("{} ({}{}{})", graph.passes[edge.from].name, to_string(edge.kind),
                       edge.subjects.empty() ? "" : ": ", fmt::join(edge.subjects, ", "));
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

}  // namespace candela
