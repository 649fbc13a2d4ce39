#include <candela/graph/compile.hpp>

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "engine/graph/details/barriers.hpp"
#include "engine/graph/details/index_table.hpp"
#include "engine/graph/details/objects.hpp"

namespace candela {
namespace detail {
namespace {

/// Checks that pass names are unique.
void check_passes(const Declaration& declared, std::vector<CompileError>& errors) {
    IndexTable table(declared.pass_count());
    for (std::uint32_t pass = 0; pass < declared.pass_count(); ++pass) {
        const std::string_view name = declared.passes[pass].name;
        const auto same = [&](std::uint32_t other) { return declared.passes[other].name == name; };
        if (table.find_or_insert(hash_of(name), pass, same) != none) {
            errors.push_back({ErrorCode::duplicate_pass, fmt::format("two passes are called '{}'", name)});
        }
    }
}

/// Checks that the names of persistent and imported resources are unique, and that every resource with a
/// history is written.
void check_resources(const Declaration& declared, std::vector<CompileError>& errors) {
    const auto known = [](const Resource& resource) {
        return resource.lifetime != Lifetime::transient && resource.history_of == none;
    };
    const auto& resources = declared.resources;
    IndexTable table(static_cast<std::size_t>(std::count_if(resources.begin(), resources.end(), known)));
    for (std::uint32_t index = 0; index < resources.size(); ++index) {
        const Resource& resource = resources[index];
        if (resource.history != none && resource.versions == 0) {
            errors.push_back(
                {ErrorCode::unwritten_read, fmt::format("{} '{}' has a history, but no pass writes it",
                                                        to_string(resource.kind), resource.name)});
        }
        if (!known(resource)) continue;
        const auto same = [&](std::uint32_t other) {
            return resources[other].kind == resource.kind && resources[other].name == resource.name;
        };
        const std::size_t hash = hash_of(resource.name) + static_cast<std::size_t>(resource.kind);
        if (table.find_or_insert(hash, index, same) != none) {
            errors.push_back({ErrorCode::duplicate_resource,
                              fmt::format("two {}s that are kept or imported are called '{}'",
                                          to_string(resource.kind), resource.name)});
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
    if (declared.passes[pass].side_effect) return true;
    const auto accesses = declared.accesses_of(pass);
    return std::any_of(accesses.begin(), accesses.end(), [&](const Access& access) {
        return access.write && declared.resources[access.resource].lifetime == Lifetime::imported;
    });
}

/// The passes that are kept, because they are roots (see is_root) or a kept pass uses their results. In the
/// order of declaration, in which handles lead only from earlier to later passes.
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
            const std::uint32_t base = declared.resources[access.resource].history_of;
            const std::uint32_t version =
                base == none ? plan.version(access.resource, access.version - (access.write ? 1 : 0))
                             : plan.version(base, declared.resources[base].versions);
            need(plan.writer[version]);
        }
    }
    std::vector<std::uint32_t> order;
    for (std::uint32_t pass = 0; pass < declared.pass_count(); ++pass) {
        if (needed[pass]) order.push_back(pass);
    }
    return order;
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

CompileResult compile(FrameGraph&& graph) {
    std::unique_ptr<detail::Declaration> declared = std::move(graph.declared_);
    std::vector<CompileError> errors = std::move(declared->errors);
    auto plan = std::make_unique<detail::Plan>();

    detail::check_passes(*declared, errors);
    detail::check_resources(*declared, errors);
    detail::number_versions(*declared, *plan);
    if (!errors.empty()) return {std::nullopt, std::move(errors)};
    plan->order = detail::needed_passes(*declared, *plan);
    detail::plan_lifetimes(*declared, *plan);
    detail::plan_objects(*declared, *plan);
    plan->barrier = detail::plan_barriers(*declared, *plan);
    return {CompiledGraph(std::move(declared), std::move(plan)), {}};
}

}  // namespace candela
