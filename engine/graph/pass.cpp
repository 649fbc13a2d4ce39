#include <algorithm>
#include <iterator>

#include <candela/graph/frame_graph.hpp>
#include "engine/graph/details/declaration.hpp"

namespace candela {

using detail::Access;
using detail::Declaration;
using detail::Resource;

namespace {

/// Whether resources of this kind may be read or written with this usage.
bool allowed(ResourceKind kind, Usage usage, bool write) {
    const bool texture = kind == ResourceKind::texture;
    switch (usage) {
        case Usage::storage:
        case Usage::copy:
            return true;
        case Usage::sampled:
            return !write;
        case Usage::uniform:
        case Usage::vertex:
        case Usage::index:
        case Usage::indirect:
            return !texture && !write;
        case Usage::depth_target:
            return texture;
        case Usage::colour_target:
        case Usage::layer_target:
            return texture && write;
    }
    return false;
}

/// Whether shaders find resources of this usage at binding points.
bool has_point(ResourceKind kind, Usage usage) {
    return usage == Usage::sampled || usage == Usage::storage || usage == Usage::uniform ||
           (usage == Usage::copy && kind == ResourceKind::buffer);
}

void check_binding(Declaration& declared, const Resource& resource, Binding binding, bool write) {
    const ResourceKind kind = resource.storage->kind;
    if (kind == ResourceKind::value) return;
    const Usage usage = binding.usage;
    const auto wrong = [&](std::string_view why) {
        declared.error(ErrorCode::wrong_usage, "pass '{}' {} {} as {}{}", declared.passes.back().name,
                       write ? "writes" : "reads", resource.title(), to_string(usage), why);
    };
    if (!allowed(kind, usage, write)) return wrong("");
    if (binding.point != Binding::unbound && !has_point(kind, usage)) {
        wrong(", for which there are no binding points");
    }
    const Format format = resource.storage->texture.format;
    if ((usage == Usage::colour_target && is_depth(format)) ||
        (usage == Usage::depth_target && !is_depth(format))) {
        wrong(fmt::format(", but its format is {}", to_string(format)));
    }
}

void check_attachments(Declaration& declared) {
    const std::string_view name = declared.passes.back().name;
    const Resource* first = nullptr;
    const Resource* depth = nullptr;
    for (const Access& access : declared.accesses_of(declared.pass_count() - 1)) {
        const Resource& resource = declared.resources[access.resource];
        const bool is_target = access.usage == Usage::colour_target || access.usage == Usage::depth_target;
        if (resource.storage->kind != ResourceKind::texture || !is_target) continue;
        if (access.usage == Usage::depth_target) {
            if (depth && depth != &resource) {
                declared.error(ErrorCode::attachment_mismatch,
                               "pass '{}' has two depth targets, '{}' and '{}'", name, depth->name,
                               resource.name);
            }
            depth = &resource;
        }
        if (resource.storage->texture.shape != TextureShape::flat) continue;
        if (!first) first = &resource;
        const glm::uvec2 wanted = first->storage->texture.size;
        const glm::uvec2 size = resource.storage->texture.size;
        if (size != wanted) {
            declared.error(ErrorCode::attachment_mismatch,
                           "pass '{}' has attachments of different sizes: '{}' is {}x{}, '{}' is {}x{}", name,
                           first->name, wanted.x, wanted.y, resource.name, size.x, size.y);
        }
    }
}

/// What counts the binding points of a resource: each of these counts its own.
std::string_view points_of(ResourceKind kind, Usage usage) {
    if (usage == Usage::sampled) return "texture unit";
    if (usage == Usage::uniform) return "uniform block";
    return kind == ResourceKind::texture ? "image unit" : "storage block";
}

void check_points(Declaration& declared) {
    const auto accesses = declared.accesses_of(declared.pass_count() - 1);
    const auto clash = [&](const Access& a, const Access& b) {
        if (a.resource == b.resource || a.point != b.point) return;
        const Resource& one = declared.resources[a.resource];
        const Resource& other = declared.resources[b.resource];
        const std::string_view points = points_of(one.storage->kind, a.usage);
        if (points != points_of(other.storage->kind, b.usage)) return;
        declared.error(ErrorCode::shared_point, "pass '{}' has {} and {} at {} {}",
                       declared.passes.back().name, one.title(), other.title(), points, a.point);
    };
    for (std::size_t i = 0; i < accesses.size(); ++i) {
        if (accesses[i].point == Binding::unbound) continue;
        for (std::size_t j = 0; j < i; ++j) clash(accesses[j], accesses[i]);
    }
}

/// The name of the pass that writes this version.
std::string_view writer_of(const Declaration& declared, std::uint32_t resource, std::uint32_t version) {
    const auto made = [=](const Access& access) {
        return access.write && access.resource == resource && access.version == version;
    };
    const auto index = std::ranges::find_if(declared.accesses, made) - declared.accesses.begin();
    const auto starts_later = [=](const detail::PassNode& pass) { return pass.first_access > index; };
    return std::prev(std::ranges::find_if(declared.passes, starts_later))->name;
}

void report_feedback(Declaration& declared, const Resource& resource) {
    declared.error(ErrorCode::feedback,
                   "pass '{}' reads {} and overwrites it: a write from version 1 on depends on what was "
                   "there by itself",
                   declared.passes.back().name, resource.title());
}

}  // namespace

Pass::Pass(Declaration& declared, std::string_view name) : declared_(declared), arena_(declared.arena) {
    if (declared.declaring) {
        declared.error(ErrorCode::nested_pass, "pass '{}' is declared inside pass '{}'", name,
                       declared.passes.back().name);
    }
    declared.declaring = true;
    detail::PassNode& pass = declared.passes.emplace_back();
    const detail::Name stored = declared.store_name(name);
    pass.name = stored.name;
    pass.key = stored.key;
    pass.held_by = declared.held_by;
    pass.first_access = detail::size_of(declared.accesses);
    pass.first_component = detail::size_of(declared.components);
    pass.first_parameter = detail::size_of(declared.parameters);
}

Pass::~Pass() {
    declared_.declaring = false;
    check_attachments(declared_);
    check_points(declared_);
}

void Pass::declare_read(ResourceHandle handle, ResourceKind kind, Binding binding) {
    const std::string_view name = declared_.passes.back().name;
    if (!declared_.owns(handle, kind)) {
        return declared_.error(ErrorCode::foreign_handle, "pass '{}' reads a {} {}", name, to_string(kind),
                               declared_.fault_of(handle));
    }
    const std::uint32_t pass = declared_.pass_count() - 1;
    Resource& resource = declared_.resources[handle.resource];
    check_binding(declared_, resource, binding, false);
    if (handle.version < resource.versions) {
        if (resource.writer == pass) return report_feedback(declared_, resource);
        return declared_.error(ErrorCode::stale_handle,
                               "pass '{}' reads {} as it was before pass '{}' wrote it", name,
                               resource.title(), writer_of(declared_, handle.resource, handle.version + 1));
    }
    if (handle.version == 0 && resource.lifetime != Lifetime::imported) {
        declared_.error(ErrorCode::unwritten_read, "pass '{}' reads {}, which no pass has written", name,
                        resource.title());
    }
    resource.reader = pass;
    declared_.accesses.push_back(
        {handle.resource, handle.version, binding.usage, false, false, binding.point});
}

void Pass::declare_component(const detail::ComponentAccess& access) {
    declared_.components.push_back(access);
}

void Pass::write_entities() {
    declared_.passes.back().writes_entities = true;
}

void Pass::after(std::string_view pass) {
    const auto others = std::span(declared_.passes).first(declared_.passes.size() - 1);
    const auto found = std::ranges::find(others, pass, &detail::PassNode::name);
    if (found == others.end()) {
        return declared_.error(ErrorCode::unknown_pass,
                               "pass '{}' is to run after pass '{}', which was not declared before it",
                               declared_.passes.back().name, pass);
    }
    declared_.after.push_back(
        {declared_.pass_count() - 1, static_cast<std::uint32_t>(found - others.begin())});
}

ResourceHandle Pass::declare_write(ResourceHandle handle, ResourceKind kind, Binding binding) {
    const std::string_view name = declared_.passes.back().name;
    if (!declared_.owns(handle, kind)) {
        declared_.error(ErrorCode::foreign_handle, "pass '{}' writes a {} {}", name, to_string(kind),
                        declared_.fault_of(handle));
        return handle;
    }
    Resource& resource = declared_.resources[handle.resource];
    const auto refuse = [&](std::string_view what, std::string_view why) {
        declared_.error(ErrorCode::wrong_usage, "pass '{}' writes {}{}, which {}", name, what,
                        resource.title(), why);
        return handle;
    };
    if (kind == ResourceKind::value && resource.lifetime == Lifetime::imported) {
        return refuse("", "the host sets");
    }
    check_binding(declared_, resource, binding, true);
    const std::uint32_t pass = declared_.pass_count() - 1;
    if (resource.reader == pass) report_feedback(declared_, resource);
    if (handle.version < resource.versions) {
        declared_.error(ErrorCode::two_writers, "passes '{}' and '{}' both write version {} of {}",
                        writer_of(declared_, handle.resource, handle.version + 1), name, handle.version + 1,
                        resource.title());
    }
    resource.writer = pass;
    declared_.accesses.push_back(
        {handle.resource, ++resource.versions, binding.usage, true, false, binding.point});
    return {handle.graph, handle.resource, resource.versions};
}

ResourceHandle Pass::declare_update(ResourceHandle handle, ResourceKind kind, Binding binding) {
    const std::size_t count = declared_.accesses.size();
    const ResourceHandle written = declare_write(handle, kind, binding);
    if (declared_.accesses.size() == count) return written;  // the write is an error
    declared_.accesses.back().update = true;
    const Resource& resource = declared_.resources[handle.resource];
    if (resource.lifetime != Lifetime::persistent || handle.version != 0) {
        declared_.error(ErrorCode::wrong_usage,
                        "pass '{}' updates {}: only version 0 of what is persistent can be updated",
                        declared_.passes.back().name, resource.title());
    }
    return written;
}

void Pass::declare_parameter(std::type_index type, const void* value,
                             bool (*equal)(const void*, const void*)) {
    declared_.parameters.push_back({type, value, equal});
}

void Pass::side_effect() {
    declared_.passes.back().side_effect = true;
}

void Pass::keeps_state() {
    declared_.passes.back().keeps_state = true;
}

void Pass::note(std::any what) {
    declared_.passes.back().note = detail::size_of(declared_.notes);
    declared_.notes.push_back(std::move(what));
}

void Pass::set_function(void* function, void (*invoke)(void*, Execution&)) {
    declared_.passes.back().function = function;
    declared_.passes.back().invoke = invoke;
}

}  // namespace candela
