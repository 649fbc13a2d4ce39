#include <candela/graph/frame_graph.hpp>

#include <chrono>
#include <utility>

#include "engine/graph/details/declaration.hpp"

namespace candela {

using detail::Declaration;
using detail::none;
using detail::Resource;

namespace {

/// 2^64 / golden ratio: a product with it has the low bits spread over the high ones.
constexpr std::uint64_t golden = 0x9e37'79b9'7f4a'7c15U;

/// An identity for a graph, without a process-wide counter: a hash of address and time. Two live graphs have
/// different addresses, and two successive graphs at one address have different times; the hash has 31 bits.
/// Never 0, which marks a null handle.
std::uint32_t make_identity(const void* address) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    auto bits = static_cast<std::uint64_t>(now) ^ (reinterpret_cast<std::uintptr_t>(address) << 16U);
    bits *= golden;
    return static_cast<std::uint32_t>(bits >> 32U) | 1U;
}

/// `name` is stored in the arena.
ResourceHandle add_resource(Declaration& declared, const detail::Name& name, const detail::Storage& storage,
                            Lifetime lifetime) {
    const detail::Storage* const last =
        declared.resources.empty() ? nullptr : declared.resources.back().storage;
    Resource& added = declared.resources.emplace_back();
    added.name = name.name;
    added.key = name.key;
    added.storage = last && *last == storage ? last : declared.arena.store(storage);
    added.lifetime = lifetime;
    return {declared.id, detail::size_of(declared.resources) - 1, 0};
}

/// See FrameGraph::find_texture. A null handle if there is none.
ResourceHandle find(const Declaration& declared, std::string_view name, ResourceKind kind) {
    for (std::uint32_t index = detail::size_of(declared.resources); index-- > 0;) {
        const Resource& resource = declared.resources[index];
        if (resource.storage->kind == kind && resource.name == name && resource.versions > 0) {
            return {declared.id, index, resource.versions};
        }
    }
    return {};
}

}  // namespace

std::size_t detail::Storage::hash() const {
    std::size_t hash = 0;
    for (const std::uint64_t part :
         {std::uint64_t{texture.size.x}, std::uint64_t{texture.size.y}, std::uint64_t{texture.layers},
          std::uint64_t{texture.mips}, static_cast<std::uint64_t>(texture.format), buffer.count,
          std::uint64_t{buffer.stride}}) {
        hash = (hash ^ part) * golden;
        hash ^= hash >> 32U;  // mixes the high bits into the low ones
    }
    return hash;
}

detail::Declaration::Declaration() : id(make_identity(this)) {
    passes.reserve(16);
    accesses.reserve(64);
    resources.reserve(32);
}

bool detail::Declaration::owns(ResourceHandle handle, ResourceKind kind) const {
    return handle.graph == id && handle.resource < resources.size() &&
           resources[handle.resource].storage->kind == kind &&
           handle.version <= resources[handle.resource].versions;
}

std::string_view detail::Declaration::fault_of(ResourceHandle handle) const {
    if (handle.graph == 0) return "by a null handle";
    return handle.graph == id ? "by a handle that is not of one" : "of another graph";
}

detail::Name detail::Declaration::store_name(std::string_view name) {
    const auto with = [&](std::string_view end) {
        return end.empty() ? arena.store_text(name) : arena.store_text(fmt::format("{}{}", name, end));
    };
    const std::string_view stored = with(ending);
    return {stored, key_ending ? with(*key_ending) : stored};
}

FrameGraph::FrameGraph() : declared_(std::make_unique<Declaration>()) {}
FrameGraph::FrameGraph(FrameGraph&& other) noexcept = default;
FrameGraph& FrameGraph::operator=(FrameGraph&& other) noexcept = default;
FrameGraph::~FrameGraph() = default;

Scope FrameGraph::scope(const ScopeDesc& desc) {
    return {*declared_, desc};
}

Scope::Scope(Declaration& declared, const ScopeDesc& desc)
    : declared_(declared),
      ending_(declared.ending),
      key_ending_(declared.key_ending),
      held_by_(declared.held_by) {
    declared.ending.insert(0, desc.name_ending);
    if (desc.key_ending) declared.key_ending = *desc.key_ending;
    if (!desc.held) return;
    if (!declared.owns(*desc.held, ResourceKind::value)) {
        declared.error(ErrorCode::foreign_handle, "passes are held by a value {}",
                       declared.fault_of(*desc.held));
        return;
    }
    declared.held_by = desc.held->resource;
    const Resource& by = declared.resources[declared.held_by];
    if (by.lifetime == Lifetime::imported) return;
    declared.error(ErrorCode::wrong_usage, "passes are held by {}, which is not imported", by.title());
}

Scope::~Scope() {
    declared_.ending = std::move(ending_);
    declared_.key_ending = std::move(key_ending_);
    declared_.held_by = held_by_;
}

TextureHandle FrameGraph::texture(std::string_view name, const TextureDesc& desc, Lifetime lifetime) {
    return {add_resource(*declared_, declared_->store_name(name),
                         {.kind = ResourceKind::texture, .texture = desc}, lifetime)};
}

ResourceHandle FrameGraph::add_buffer(std::string_view name, const BufferDesc& desc, std::type_index element,
                                      Lifetime lifetime) {
    const ResourceHandle added = add_resource(*declared_, declared_->store_name(name),
                                              {.kind = ResourceKind::buffer, .buffer = desc}, lifetime);
    declared_->resources.back().element = element;
    return added;
}

ResourceHandle FrameGraph::add_value(std::string_view name, std::type_index type, Lifetime lifetime) {
    return add_resource(*declared_, declared_->store_name(name), {.type = type}, lifetime);
}

std::optional<FoundTexture> FrameGraph::find_texture(std::string_view name) const {
    const ResourceHandle found = find(*declared_, name, ResourceKind::texture);
    if (found == ResourceHandle{}) return std::nullopt;
    const Resource& resource = declared_->resources[found.resource];
    return FoundTexture{{found}, resource.storage->texture, declared_->note_of(resource.note)};
}

std::optional<FoundBuffer> FrameGraph::find_buffer(std::string_view name) const {
    const ResourceHandle found = find(*declared_, name, ResourceKind::buffer);
    if (found == ResourceHandle{}) return std::nullopt;
    const Resource& resource = declared_->resources[found.resource];
    return FoundBuffer{
        {found}, resource.storage->buffer.stride, resource.element, declared_->note_of(resource.note)};
}

std::vector<std::string_view> FrameGraph::pass_names() const {
    std::vector<std::string_view> names;
    names.reserve(declared_->passes.size());
    for (const detail::PassNode& pass : declared_->passes) {
        names.push_back(pass.name);
    }
    return names;
}

std::optional<TextureDesc> FrameGraph::desc(TextureHandle texture) const {
    if (!declared_->owns(texture, ResourceKind::texture)) return std::nullopt;
    return declared_->resources[texture.resource].storage->texture;
}

void FrameGraph::note(ResourceHandle on, std::any what) {
    if (on.graph != declared_->id || on.resource >= declared_->resources.size()) {
        return declared_->error(ErrorCode::foreign_handle, "note on a resource {}", declared_->fault_of(on));
    }
    declared_->resources[on.resource].note = detail::size_of(declared_->notes);
    declared_->notes.push_back(std::move(what));
}

}  // namespace candela
