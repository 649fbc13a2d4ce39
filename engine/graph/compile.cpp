#include <candela/graph/compile.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <string_view>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "engine/graph/details/schedule.hpp"

namespace candela {
namespace detail {
namespace {

/// Checks that the names, or the keys, of passes are unique. A hash table with open addressing: a set would
/// allocate memory for every pass, which can be seen in the time that compiling takes. `fault`: what is said
/// of two passes that have the same one.
void check_passes(Declaration& declared, std::string_view PassNode::*text, std::string_view fault) {
    std::vector<std::string_view> table(std::bit_ceil(2 * declared.passes.size() + 1));
    for (const PassNode& pass : declared.passes) {
        const std::string_view here = pass.*text;
        std::size_t at = std::hash<std::string_view>{}(here) & (table.size() - 1);
        while (table[at].data() && table[at] != here) {
            at = (at + 1) & (table.size() - 1);
        }
        if (table[at].data()) declared.error(ErrorCode::duplicate_pass, "two passes {} '{}'", fault, here);
        table[at] = here;
    }
}

void check_texture(Declaration& declared, const Resource& resource) {
    if (const std::string why = why_impossible(resource.storage->texture); !why.empty()) {
        declared.error(ErrorCode::impossible_texture, "{} is not possible: {}", resource.title(), why);
    }
}

/// Checks that textures are possible, that the names and the keys of persistent and imported resources are
/// unique within a kind.
void check_resources(Declaration& declared) {
    using Texts = std::array<std::unordered_set<std::string_view>, 3>;  // by kind
    Texts names;
    Texts keys;
    for (const Resource& resource : declared.resources) {
        if (resource.storage->kind == ResourceKind::texture) check_texture(declared, resource);
        const ResourceKind kind = resource.storage->kind;
        if (!resource.is_kept()) continue;
        const bool new_name = names.at(static_cast<std::size_t>(kind)).insert(resource.name).second;
        const bool new_key = keys.at(static_cast<std::size_t>(kind)).insert(resource.key).second;
        if (!new_name) {
            declared.error(ErrorCode::duplicate_resource, "two {}s that are kept or imported are called '{}'",
                           to_string(kind), resource.name);
        } else if (!new_key) {
            declared.error(ErrorCode::duplicate_resource,
                           "two {}s that are kept or imported have the key '{}'", to_string(kind),
                           resource.key);
        }
    }
}

void number_versions(const Declaration& declared, Plan& plan) {
    plan.first_version.resize(declared.resources.size() + 1);
    std::uint32_t versions = 0;
    for (std::size_t resource = 0; resource < declared.resources.size(); ++resource) {
        plan.first_version[resource] = versions;
        versions += declared.resources[resource].versions + 1;
    }
    plan.first_version.back() = versions;

    plan.writer.assign(versions, none);
    for (std::uint32_t pass = 0; pass < declared.pass_count(); ++pass) {
        for (const Access& access : declared.accesses_of(pass)) {
            if (access.write) plan.writer[plan.version(access.resource, access.version)] = pass;
        }
    }
}

bool is_root(const Declaration& declared, std::uint32_t pass) {
    const PassNode& node = declared.passes[pass];
    return node.side_effect || node.writes_entities ||
           std::ranges::any_of(declared.components_of(pass), &ComponentAccess::write) ||
           std::ranges::any_of(declared.accesses_of(pass), [&](const Access& access) {
               return access.write && declared.resources[access.resource].lifetime == Lifetime::imported;
           });
}

/// The passes that are kept, because they are roots (see is_root) or a kept pass uses their results, in the
/// order of declaration.
std::vector<std::uint32_t> needed_passes(const Declaration& declared, const Plan& plan) {
    std::vector<std::uint8_t> needed(declared.pass_count(), 0);
    std::vector<std::uint32_t> open;
    open.reserve(declared.pass_count());
    const auto need = [&](std::uint32_t pass) {
        if (pass == none || needed[pass]) return;
        needed[pass] = 1;
        open.push_back(pass);
    };
    for (std::uint32_t pass = 0; pass < declared.pass_count(); ++pass) {
        if (is_root(declared, pass)) need(pass);
    }
    while (!open.empty()) {
        const std::uint32_t pass = open.back();
        open.pop_back();
        for (const Access& access : declared.accesses_of(pass)) {
            need(plan.writer[plan.needed_version(access)]);
        }
    }
    std::vector<std::uint32_t> kept;
    for (std::uint32_t pass = 0; pass < declared.pass_count(); ++pass) {
        if (needed[pass]) kept.push_back(pass);
    }
    return kept;
}

}  // namespace
}  // namespace detail

std::string to_string(Barrier bits) {
    static constexpr std::array<std::string_view, 10> names{
        "vertex attrib", "element",        "uniform",       "texture fetch", "image access",
        "command",       "texture update", "buffer update", "framebuffer",   "storage"};
    std::string text;
    for (std::size_t bit = 0; bit < names.size(); ++bit) {
        if ((bits & static_cast<Barrier>(1U << bit)) == Barrier::none) continue;
        text += text.empty() ? "" : " + ";
        text += names.at(bit);
    }
    return text.empty() ? "none" : text;
}

CompiledGraph::CompiledGraph(std::unique_ptr<const detail::Declaration> declared,
                             std::unique_ptr<const detail::Plan> plan)
    : declared_(std::move(declared)), plan_(std::move(plan)) {}
CompiledGraph::CompiledGraph(CompiledGraph&& other) noexcept = default;
CompiledGraph& CompiledGraph::operator=(CompiledGraph&& other) noexcept = default;
CompiledGraph::~CompiledGraph() = default;

std::size_t CompiledGraph::pass_count() const {
    return plan_->order.size();
}

CompiledGraph CompileResult::take() && {
    if (graph) return std::move(*graph);
    std::string message = "the frame graph does not compile:";
    for (const CompileError& error : errors) {
        message += "\n  " + error.message;
    }
    throw GraphError(message);
}

CompileResult compile(FrameGraph&& graph, std::optional<std::uint32_t> shuffle) {
    std::unique_ptr<detail::Declaration> declared = std::move(graph.declared_);
    auto plan = std::make_unique<detail::Plan>();

    detail::check_passes(*declared, &detail::PassNode::name, "are called");
    if (declared->errors.empty()) {
        detail::check_passes(*declared, &detail::PassNode::key, "have the key");
    }
    detail::check_resources(*declared);
    if (!declared->errors.empty()) return {std::nullopt, std::move(declared->errors)};
    detail::number_versions(*declared, *plan);
    plan->order = detail::schedule(*declared, *plan, detail::needed_passes(*declared, *plan), shuffle);
    detail::plan_objects(*declared, *plan);
    detail::plan_barriers(*declared, *plan);
    return {CompiledGraph(std::move(declared), std::move(plan)), {}};
}

}  // namespace candela
