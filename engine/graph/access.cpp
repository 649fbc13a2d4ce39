// Access to resources: of running passes, and of the host.

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/state.hpp"

namespace candela {

using detail::none;

namespace {

/// Whether the pass at `position` has declared an access to the resource that suits.
template <class Suits>
bool declares(const CompiledGraph& graph, std::uint32_t position, ResourceHandle handle, Suits suits) {
    const auto accesses = graph.declared().accesses_of(graph.plan().order[position]);
    return std::ranges::any_of(accesses, [&](const detail::Access& access) {
        return access.resource == handle.resource && std::invoke(suits, access);
    });
}

}  // namespace

const detail::Resource& GraphRuntime::resource(ResourceHandle handle) const {
    if (!graph_) throw GraphError("there is no frame graph");
    if (handle.graph != graph_->declared().id) throw GraphError("a handle is not of the current frame graph");
    return graph_->declared().resources.at(handle.resource);
}

detail::Slot* GraphRuntime::import_slot(ResourceHandle handle) {
    const detail::Resource& imported = resource(handle);
    if (imported.lifetime != Lifetime::imported) {
        throw GraphError(fmt::format("{} is not imported", imported.title()));
    }
    return slot_of(handle.resource);
}

void GraphRuntime::bind(ResourceHandle imported, ObjectId object, const TextureDesc& texture,
                        const BufferDesc& buffer) {
    detail::Slot* const slot = import_slot(imported);
    if (!slot) return;
    slot->object = object;  // may be 0: the window's framebuffer
    slot->storage.texture = texture;
    slot->storage.buffer = buffer;
    slot->filled = true;
    touch(imported);
}

void GraphRuntime::touch(ResourceHandle imported) {
    state_->versions[graph_->plan().version(imported.resource, 0)].stamp = ++clock_;
}

void GraphRuntime::set_value(ResourceHandle imported, detail::Value value) {
    detail::Slot* const slot = import_slot(imported);
    if (!slot || value.equals(slot->value)) return;
    slot->value = std::move(value);
    touch(imported);
}

/// The slot of a resource or of a history. Until turn_over was called in a frame, a resource still holds its
/// content from the end of the previous frame, so its own slot is the history.
detail::Slot* GraphRuntime::slot_of(std::uint32_t index) {
    const std::uint32_t base = graph_->declared().resources[index].history_of;
    const std::uint32_t slot = graph_->plan().object[base == none ? index : base];
    if (slot == none) return nullptr;
    return &state_->slots[base != none && state_->turned[slot] ? slot + 1 : slot];
}

const void* GraphRuntime::content(ResourceHandle value) const {
    const detail::Resource& held = resource(value);
    const std::uint32_t slot = graph_->plan().object[value.resource];
    if (slot == none || !state_->slots[slot].value.content) {
        throw GraphError(fmt::format("{} has not been set", held.title()));
    }
    return state_->slots[slot].value.content.get();
}

ObjectId GraphRuntime::object(ResourceHandle handle) const {
    (void)resource(handle);
    const std::uint32_t slot = graph_->plan().object[handle.resource];
    return slot == none ? 0 : state_->slots[slot].object;
}

detail::Slot& Execution::slot(ResourceHandle handle, bool write) const {
    const detail::Resource& resource = runtime_.resource(handle);
    const auto suits = [=](const detail::Access& access) { return access.write || !write; };
    if (declares(*runtime_.graph_, position_, handle, suits)) return *runtime_.slot_of(handle.resource);
    throw GraphError(fmt::format("pass '{}' {} {} without having declared it",
                                 runtime_.state_->steps[position_].name, write ? "writes" : "uses",
                                 resource.title()));
}

ObjectId Execution::object_of(ResourceHandle resource) const {
    return slot(resource, false).object;
}

const TextureDesc& Execution::desc(TextureHandle texture) const {
    return slot(texture, false).storage.texture;
}

WorldWriter Execution::world() const {
    const detail::Step& step = runtime_.state_->steps[position_];
    return {world_, writable_, step.declared, step.name};
}

std::uint64_t Execution::count_of(ResourceHandle buffer) const {
    return slot(buffer, false).storage.buffer.count;
}

void Execution::set_value(ResourceHandle value, detail::Value content) {
    detail::Slot& target = slot(value, true);
    if (content.equals(target.value)) return;
    target.value = std::move(content);
    target.changed = true;
}

const void* Execution::content(ResourceHandle value) const {
    (void)slot(value, false);
    return runtime_.content(value);
}

const void* Execution::previous_content(ResourceHandle value) const {
    const detail::Slot& held = slot(value, true);
    if (!declares(*runtime_.graph_, position_, value, &detail::Access::update)) {
        throw GraphError(fmt::format("pass '{}' asks for the previous content of {}, but does not update it",
                                     runtime_.state_->steps[position_].name,
                                     runtime_.resource(value).title()));
    }
    return runtime_.repeating_ ? nullptr : held.value.content.get();
}

bool Execution::changed(ResourceHandle read) const {
    const detail::Resource& resource = runtime_.resource(read);
    const detail::State& state = *runtime_.state_;
    const detail::Plan& plan = runtime_.graph_->plan();
    const detail::Step& step = state.steps[position_];
    const std::uint32_t version = plan.version(read.resource, read.version);
    const auto input = std::ranges::find(step.inputs, version, &detail::Input::version);
    if (input != step.inputs.end()) return has_no_result_ || state.versions[version].stamp != input->stamp;
    throw GraphError(fmt::format("pass '{}' asks whether {} has changed without having declared it",
                                 step.name, resource.title()));
}

bool Execution::history_valid(TextureHandle history) const {
    const detail::Slot& previous = slot(history, false);
    const std::uint32_t present_of = runtime_.resource(history).history_of;
    if (present_of == none) {
        throw GraphError(fmt::format("{} is not a history", runtime_.resource(history).title()));
    }
    const detail::Slot& present = *runtime_.slot_of(present_of);
    return previous.filled && previous.storage == present.storage;
}

detail::Slot& Execution::reservable(ResourceHandle handle) const {
    detail::Slot& found = slot(handle, true);
    const auto suits = [](const detail::Access& access) {
        return access.write && access.version == 1 && access.usage != Usage::colour_target &&
               access.usage != Usage::depth_target;
    };
    const detail::Resource& resource = runtime_.resource(handle);
    if (resource.lifetime == Lifetime::persistent && declares(*runtime_.graph_, position_, handle, suits)) {
        return found;
    }
    throw GraphError(fmt::format(
        "pass '{}' reserves {}, but may only what is persistent and what it writes from version 0, "
        "not as a target",
        runtime_.state_->steps[position_].name, resource.title()));
}

void Execution::reserve_buffer(ResourceHandle buffer, std::uint64_t count) {
    detail::Storage wanted = reservable(buffer).storage;
    const std::uint64_t present = wanted.buffer.count;
    if (count > present) wanted.buffer.count = std::max(count, present + present / 2);
    replace(buffer, wanted);
}

void Execution::reserve(TextureHandle texture, const TextureDesc& desc) {
    detail::Storage wanted = reservable(texture).storage;
    if (const std::string why = why_impossible(desc); !why.empty()) {
        throw GraphError(fmt::format("pass '{}' cannot reserve {}: {}",
                                     runtime_.state_->steps[position_].name,
                                     runtime_.resource(texture).title(), why));
    }
    wanted.texture = desc;
    replace(texture, wanted);
}

/// Creates a new object for a resource of the running pass, unless the present one has this storage.
void Execution::replace(ResourceHandle handle, const detail::Storage& wanted) {
    detail::Slot& present = slot(handle, true);
    if (present.storage == wanted) return;
    detail::Slot made = present;
    made.storage = wanted;
    runtime_.create(made, runtime_.resource(handle).name);
    runtime_.destroy(present);
    present = made;
    for (const detail::Bound& bound : runtime_.state_->steps[position_].bound) {
        if (bound.resource == handle.resource) runtime_.bind(bound);
    }
}

}  // namespace candela
