#include <candela/graph/frame_graph.hpp>

#include "engine/graph/details/declaration.hpp"

namespace candela {

Pass::Pass(detail::Declaration& declared, std::string_view name)
    : declared_(declared), arena_(declared.arena()) {
    declared_.begin_pass(name);
}

Pass::~Pass() {
    declared_.end_pass();
}

void Pass::declare_read(ResourceHandle resource, ResourceKind kind, Binding binding) {
    declared_.read(resource, kind, binding);
}

void Pass::declare_read(std::string_view component, Tick (*revision)(const World&)) {
    declared_.components.push_back({component, revision});
}

ResourceHandle Pass::declare_write(ResourceHandle resource, ResourceKind kind, Binding binding) {
    return declared_.write(resource, kind, binding);
}

ResourceHandle Pass::declare_update(ResourceHandle resource, ResourceKind kind, Binding binding) {
    return declared_.update(resource, kind, binding);
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

void Pass::set_tag(std::uint32_t tag) {
    declared_.passes.back().tag = tag;
}

void Pass::set_function(void* function, void (*invoke)(void*, Execution&)) {
    declared_.passes.back().function = function;
    declared_.passes.back().invoke = invoke;
}

FrameGraph::FrameGraph() : declared_(std::make_unique<detail::Declaration>()) {}
FrameGraph::FrameGraph(FrameGraph&& other) noexcept = default;
FrameGraph& FrameGraph::operator=(FrameGraph&& other) noexcept = default;
FrameGraph::~FrameGraph() = default;

void FrameGraph::append_to_names(std::string_view ending) {
    declared_->append_to_names(ending);
}

TextureHandle FrameGraph::texture(std::string_view name, const TextureDesc& desc, Lifetime lifetime) {
    return {declared_->add_texture(name, desc, lifetime)};
}

TextureHandle FrameGraph::mip(TextureHandle texture, std::uint32_t level) {
    return {declared_->add_part(texture, {level, TexturePart::all_layers})};
}

TextureHandle FrameGraph::layer(TextureHandle texture, std::uint32_t layer, std::uint32_t mip) {
    return {declared_->add_part(texture, {mip, layer})};
}

ResourceHandle FrameGraph::add_buffer(std::string_view name, const BufferDesc& desc, Lifetime lifetime) {
    return declared_->add_buffer(name, desc, lifetime);
}

ResourceHandle FrameGraph::add_value(std::string_view name, std::type_index type, Lifetime lifetime) {
    return declared_->add_value(name, type, lifetime);
}

TextureHandle FrameGraph::history(TextureHandle texture) {
    return {declared_->add_history(texture)};
}

std::optional<FoundTexture> FrameGraph::find_texture(std::string_view name) const {
    const ResourceHandle found = declared_->find(name, ResourceKind::texture);
    if (found == ResourceHandle{}) return std::nullopt;
    const TextureDesc& desc = declared_->texture(declared_->resources[found.resource]);
    return FoundTexture{{found}, desc, declared_->note(found)};
}

std::optional<FoundBuffer> FrameGraph::find_buffer(std::string_view name) const {
    const ResourceHandle found = declared_->find(name, ResourceKind::buffer);
    if (found == ResourceHandle{}) return std::nullopt;
    const BufferDesc& desc = declared_->buffer(declared_->resources[found.resource]);
    return FoundBuffer{{found}, desc.stride, declared_->note(found)};
}

void FrameGraph::note(ResourceHandle on, std::any what) {
    declared_->add_note(on, std::move(what));
}

}  // namespace candela
