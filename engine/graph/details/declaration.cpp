#include "engine/graph/details/declaration.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace candela::detail {
namespace {

/// An identity for a graph, without a process-wide counter: a hash of address and time. Two live graphs have
/// different addresses, and two successive graphs at one address have different times; the hash has 31 bits.
/// Never 0, which marks a null handle.
std::uint32_t make_identity(const void* address) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    auto bits = static_cast<std::uint64_t>(now) ^ (reinterpret_cast<std::uintptr_t>(address) << 16U);
    bits *= 0x9e37'79b9'7f4a'7c15U;  // 2^64 / golden ratio: spreads the low bits over the high ones
    return static_cast<std::uint32_t>(bits >> 32U) | 1U;
}

/// Whether resources of this kind may be read or written with this usage.
bool allowed(ResourceKind kind, Usage usage, bool write) {
    const bool texture = kind == ResourceKind::texture;
    switch (usage) {
        case Usage::storage:
        case Usage::copy:
            return true;
        case Usage::sampled:
        case Usage::compared:
            return texture && !write;
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
    return usage == Usage::sampled || usage == Usage::compared || usage == Usage::storage ||
           usage == Usage::uniform || (usage == Usage::copy && kind == ResourceKind::buffer);
}

}  // namespace

Declaration::Declaration() : arena_(std::make_unique<Arena>()) {
    id = make_identity(arena_.get());
    passes.reserve(16);
    accesses.reserve(64);
    resources.reserve(32);
}

std::string_view Declaration::store_name(std::string_view name) {
    return ending_.empty() ? arena_->store_text(name)
                           : arena_->store_text(fmt::format("{}{}", name, ending_));
}

ResourceHandle Declaration::add_resource(std::string_view name, ResourceKind kind, Lifetime lifetime,
                                         std::size_t desc) {
    Resource resource;
    resource.name = store_name(name);
    resource.kind = kind;
    resource.lifetime = lifetime;
    resource.desc = static_cast<std::uint32_t>(desc);
    resources.push_back(resource);
    return {id, size_of(resources) - 1, 0};
}

ResourceHandle Declaration::add_texture(std::string_view name, const TextureDesc& desc, Lifetime lifetime) {
    if (textures.empty() || textures.back() != desc) textures.push_back(desc);
    return add_resource(name, ResourceKind::texture, lifetime, textures.size() - 1);
}

ResourceHandle Declaration::add_buffer(std::string_view name, const BufferDesc& desc, Lifetime lifetime) {
    if (buffers.empty() || buffers.back() != desc) buffers.push_back(desc);
    return add_resource(name, ResourceKind::buffer, lifetime, buffers.size() - 1);
}

ResourceHandle Declaration::add_value(std::string_view name, std::type_index type, Lifetime lifetime) {
    value_types.push_back(type);
    return add_resource(name, ResourceKind::value, lifetime, value_types.size() - 1);
}

ResourceHandle Declaration::add_history(ResourceHandle of) {
    if (!owns(of, ResourceKind::texture)) {
        error(ErrorCode::foreign_handle, "history of a texture of another graph");
        return {};
    }
    const Resource base = resources[of.resource];
    if (const std::string_view why = why_no_history(base); !why.empty()) {
        error(ErrorCode::wrong_usage, fmt::format("texture '{}' has no history: it {}", base.name, why));
        return {id, of.resource, of.version};
    }
    if (base.history != none) return {id, base.history, 0};

    const auto previous = size_of(resources);
    resources[of.resource].lifetime = Lifetime::persistent;
    resources[of.resource].history = previous;
    Resource history = resources[of.resource];
    history.history = history.note = none;
    history.history_of = of.resource;
    history.versions = 0;
    history.reader = history.writer = none;
    resources.push_back(history);
    return {id, previous, 0};
}

/// Empty if the resource can have a history.
std::string_view Declaration::why_no_history(const Resource& base) const {
    if (base.lifetime == Lifetime::imported) return "is imported";
    if (base.history_of != none) return "is a history itself";
    if (base.updated) return "is updated in place";
    return base.first_part != none || base.part_of != none ? "has parts or is one" : "";
}

ResourceHandle Declaration::add_part(ResourceHandle of, TexturePart part) {
    if (!owns(of, ResourceKind::texture)) {
        error(ErrorCode::foreign_handle, "part of a texture of another graph");
        return {};
    }
    const std::string_view whole = resources[of.resource].name;
    for (std::uint32_t at = resources[of.resource].first_part; at != none; at = resources[at].next_part) {
        if (resources[at].part == part) return {id, at, 0};
    }
    if (const std::string_view why = why_no_parts(resources[of.resource], part); !why.empty()) {
        error(ErrorCode::wrong_usage, fmt::format("texture '{}' has no {}: {}", whole, to_string(part), why));
        return {id, of.resource, of.version};
    }
    const TextureDesc desc = part_desc(texture(resources[of.resource]), part);
    const std::string ending = std::exchange(ending_, {});  // the name of the whole has it already
    const ResourceHandle handle =
        add_texture(fmt::format("{} {}", whole, to_string(part)), desc, Lifetime::persistent);
    ending_ = ending;
    Resource& added = resources[handle.resource];
    Resource& parent = resources[of.resource];
    added.part_of = of.resource;
    added.part = part;
    added.next_part = std::exchange(parent.first_part, handle.resource);
    parent.lifetime = Lifetime::persistent;
    return handle;
}

/// Empty if the texture can have the part.
std::string_view Declaration::why_no_parts(const Resource& whole, TexturePart part) const {
    if (whole.lifetime == Lifetime::imported) return "it is imported";
    if (whole.history != none || whole.history_of != none || whole.part_of != none) {
        return "it has a history, is one, or is a part itself";
    }
    if (whole.versions > 0 || whole.reader != none) return "a pass accesses it as a whole";
    const TextureDesc& desc = texture(whole);
    const bool has_layer = part.layer == TexturePart::all_layers ||
                           (part.layer < desc.layers && desc.shape != TextureShape::flat);
    if (part.mip >= desc.mips || !has_layer) return "there are fewer";
    for (std::uint32_t at = whole.first_part; at != none; at = resources[at].next_part) {
        const TexturePart other = resources[at].part;
        const bool one_is_whole_mip =
            part.layer == TexturePart::all_layers || other.layer == TexturePart::all_layers;
        if (part.mip == other.mip && one_is_whole_mip) return "it overlaps another part";
    }
    return "";
}

void Declaration::add_note(ResourceHandle on, std::any note) {
    if (on.graph != id || on.resource >= resources.size()) {
        return error(ErrorCode::foreign_handle, "note on a resource of another graph");
    }
    resources[on.resource].note = size_of(notes);
    notes.push_back(std::move(note));
}

ResourceHandle Declaration::find(std::string_view name, ResourceKind kind) const {
    for (std::uint32_t index = size_of(resources); index-- > 0;) {
        const Resource& resource = resources[index];
        if (resource.kind == kind && resource.name == name && is_written(resource)) {
            return {id, index, resource.versions};
        }
    }
    return {};
}

/// Whether passes have written it; a texture with parts is written if all of them are. Never a history.
bool Declaration::is_written(const Resource& resource) const {
    if (resource.first_part == none) return resource.versions > 0;
    std::uint32_t part = resource.first_part;
    while (part != none && resources[part].versions > 0) {
        part = resources[part].next_part;
    }
    return part == none;
}

void Declaration::begin_pass(std::string_view name) {
    if (declaring_) {
        error(ErrorCode::nested_pass,
              fmt::format("pass '{}' is declared inside pass '{}'", name, passes.back().name));
    }
    declaring_ = true;
    PassNode pass;
    pass.name = store_name(name);
    pass.first_access = size_of(accesses);
    pass.first_component = size_of(components);
    pass.first_parameter = size_of(parameters);
    passes.push_back(pass);
}

void Declaration::end_pass() {
    declaring_ = false;
    check_attachments();
}

bool Declaration::owns(ResourceHandle handle, ResourceKind kind) const {
    return handle.graph == id && handle.resource < resources.size() &&
           resources[handle.resource].kind == kind && handle.version <= resources[handle.resource].versions;
}

std::string_view Declaration::writer_of(std::uint32_t resource, std::uint32_t version) const {
    const auto made = [=](const Access& access) {
        return access.write && access.resource == resource && access.version == version;
    };
    const auto index = std::find_if(accesses.begin(), accesses.end(), made) - accesses.begin();
    const auto starts_later = [=](const PassNode& pass) { return pass.first_access > index; };
    return std::prev(std::find_if(passes.begin(), passes.end(), starts_later))->name;
}

void Declaration::read(ResourceHandle handle, ResourceKind kind, Binding binding) {
    const std::uint32_t pass = pass_count() - 1;
    const std::string_view name = passes[pass].name;
    if (!owns(handle, kind)) {
        return error(ErrorCode::foreign_handle,
                     fmt::format("pass '{}' reads a {} of another graph", name, to_string(kind)));
    }
    Resource& resource = resources[handle.resource];
    check_binding(resource, binding, false);
    if (handle.version < resource.versions) {
        if (resource.writer == pass) {
            error(ErrorCode::feedback,
                  fmt::format("pass '{}' reads {} '{}' and overwrites it: a write from version 1 "
                              "on depends on what was there by itself",
                              name, to_string(kind), resource.name));
        } else {
            error(
                ErrorCode::stale_handle,
                fmt::format("pass '{}' reads {} '{}' as it was before pass '{}' wrote it", name,
                            to_string(kind), resource.name, writer_of(handle.resource, handle.version + 1)));
        }
        return;
    }
    for (std::uint32_t part = resource.first_part; part != none; part = resources[part].next_part) {
        read({id, part, resources[part].versions}, kind, binding.usage);
    }
    const bool given =
        resource.lifetime == Lifetime::imported || resource.history_of != none || resource.first_part != none;
    if (handle.version == 0 && !given) {
        error(ErrorCode::unwritten_read, fmt::format("pass '{}' reads {} '{}', which no pass has written",
                                                     name, to_string(kind), resource.name));
    }
    resource.reader = pass;
    accesses.push_back({handle.resource, handle.version, binding.usage, false, false, binding.point});
}

ResourceHandle Declaration::write(ResourceHandle handle, ResourceKind kind, Binding binding) {
    const std::uint32_t pass = pass_count() - 1;
    const std::string_view name = passes[pass].name;
    if (!owns(handle, kind)) {
        error(ErrorCode::foreign_handle,
              fmt::format("pass '{}' writes a {} of another graph", name, to_string(kind)));
        return handle;
    }
    Resource& resource = resources[handle.resource];
    if (resource.history_of != none) {
        error(ErrorCode::wrong_usage,
              fmt::format("pass '{}' writes the history of texture '{}', which is read only", name,
                          resource.name));
        return handle;
    }
    if (kind == ResourceKind::value && resource.lifetime == Lifetime::imported) {
        error(ErrorCode::wrong_usage,
              fmt::format("pass '{}' writes value '{}', which the host sets", name, resource.name));
        return handle;
    }
    if (resource.first_part != none) {
        error(ErrorCode::wrong_usage,
              fmt::format("pass '{}' writes texture '{}', which has parts: only they can be written", name,
                          resource.name));
        return handle;
    }
    check_binding(resource, binding, true);
    if (resource.reader == pass) {
        error(ErrorCode::feedback,
              fmt::format(
                  "pass '{}' reads {} '{}' and overwrites it: a write from version 1 on depends on what was "
                  "there by itself",
                  name, to_string(kind), resource.name));
    }
    if (handle.version < resource.versions) {
        error(ErrorCode::two_writers, fmt::format("passes '{}' and '{}' both write version {} of {} '{}'",
                                                  writer_of(handle.resource, handle.version + 1), name,
                                                  handle.version + 1, to_string(kind), resource.name));
    }
    resource.writer = pass;
    accesses.push_back({handle.resource, ++resource.versions, binding.usage, true, false, binding.point});
    return {id, handle.resource, resource.versions};
}

ResourceHandle Declaration::update(ResourceHandle handle, ResourceKind kind, Binding binding) {
    const std::size_t count = accesses.size();
    const ResourceHandle written = write(handle, kind, binding);
    if (accesses.size() == count) {
        return written;  // the write is an error
    }
    accesses.back().update = true;
    Resource& resource = resources[handle.resource];
    resource.updated = true;
    if (resource.lifetime != Lifetime::persistent || resource.history != none || handle.version != 0) {
        error(
            ErrorCode::wrong_usage,
            fmt::format("pass '{}' updates {} '{}': only version 0 of what is persistent and has no history "
                        "can be updated",
                        passes.back().name, to_string(kind), resource.name));
    }
    return written;
}

void Declaration::check_binding(const Resource& resource, Binding binding, bool write) {
    if (resource.kind == ResourceKind::value) return;
    const Usage usage = binding.usage;
    const std::string_view verb = write ? "writes" : "reads";
    if (!allowed(resource.kind, usage, write)) {
        return error(ErrorCode::wrong_usage,
                     fmt::format("pass '{}' {} {} '{}' as {}", passes.back().name, verb,
                                 to_string(resource.kind), resource.name, to_string(usage)));
    }
    if (binding.point != Binding::unbound && !has_point(resource.kind, usage)) {
        error(
            ErrorCode::wrong_usage,
            fmt::format("pass '{}' {} {} '{}' as {}, for which there are no binding points",
                        passes.back().name, verb, to_string(resource.kind), resource.name, to_string(usage)));
    }
    if (resource.kind != ResourceKind::texture) return;
    const Format format = texture(resource).format;
    if ((usage == Usage::colour_target && is_depth(format)) ||
        (usage == Usage::depth_target && !is_depth(format))) {
        error(ErrorCode::wrong_usage,
              fmt::format("pass '{}' {} texture '{}' as {}, but its format is {}", passes.back().name, verb,
                          resource.name, to_string(usage), to_string(format)));
    }
}

void Declaration::check_attachments() {
    const Resource* first = nullptr;
    const Resource* depth = nullptr;
    for (const Access& access : accesses_of(pass_count() - 1)) {
        const Resource& resource = resources[access.resource];
        const bool is_target = access.usage == Usage::colour_target || access.usage == Usage::depth_target;
        if (resource.kind != ResourceKind::texture || !is_target) continue;
        if (access.usage == Usage::depth_target) {
            if (depth && depth != &resource) {
                error(ErrorCode::attachment_mismatch,
                      fmt::format("pass '{}' has two depth targets, '{}' and '{}'", passes.back().name,
                                  depth->name, resource.name));
            }
            depth = &resource;
        }
        const TextureDesc& desc = texture(resource);
        if (desc.shape != TextureShape::flat) continue;
        if (!first) first = &resource;
        const glm::uvec2 size = texture(*first).size;
        if (size != desc.size) {
            error(ErrorCode::attachment_mismatch,
                  fmt::format("pass '{}' has attachments of different sizes: '{}' is {}x{}, '{}' is {}x{}",
                              passes.back().name, first->name, size.x, size.y, resource.name, desc.size.x,
                              desc.size.y));
        }
    }
}

}  // namespace candela::detail
