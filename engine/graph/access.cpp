// Access to resources: of running passes, and of the host.

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/runtime.hpp"

namespace candela::detail {
namespace {

/// Whether the running pass has declared an access to the resource that suits.
template <class Suits>
bool declares(const Running& pass, ResourceHandle handle, Suits suits) {
    const CompiledGraph& graph = *pass.runtime.graph;
    const auto accesses = graph.declared().accesses_of(graph.plan().order[pass.position]);
    return std::ranges::any_of(accesses, [&](const Access& access) {
        return access.resource == handle.resource && std::invoke(suits, access);
    });
}

}  // namespace

const Resource& Runtime::resource(ResourceHandle handle) const {
    if (!graph) throw GraphError("there is no frame graph");
    if (handle.graph != graph->declared().id) throw GraphError("a handle is not of the current frame graph");
    return graph->declared().resources.at(handle.resource);
}

Slot* Runtime::import_slot(ResourceHandle handle) {
    const Resource& imported = resource(handle);
    if (imported.lifetime != Lifetime::imported) {
        throw GraphError(fmt::format("{} is not imported", imported.title()));
    }
    return slot_of(handle.resource);
}

void Runtime::touch(ResourceHandle imported) {
    state.versions[graph->plan().version(imported.resource, 0)].stamp = ++clock;
}

Slot* Runtime::slot_of(std::uint32_t index) {
    const std::uint32_t slot = graph->plan().object[index];
    return slot == none ? nullptr : &state.slots[slot];
}

const void* Runtime::content(ResourceHandle value) const {
    const Resource& held = resource(value);
    const std::uint32_t slot = graph->plan().object[value.resource];
    if (slot == none || !state.slots[slot].value.content) {
        throw GraphError(fmt::format("{} has not been set", held.title()));
    }
    return state.slots[slot].value.content.get();
}

Slot& Running::slot(ResourceHandle handle, bool write) const {
    const Resource& resource = runtime.resource(handle);
    const auto suits = [=](const Access& access) { return access.write || !write; };
    if (declares(*this, handle, suits)) return *runtime.slot_of(handle.resource);
    throw GraphError(fmt::format("pass '{}' {} {} without having declared it", step().name,
                                 write ? "writes" : "uses", resource.title()));
}

Slot& Running::reservable(ResourceHandle handle) const {
    Slot& found = slot(handle, true);
    const auto suits = [](const Access& access) {
        return access.write && access.version == 1 && access.usage != Usage::colour_target &&
               access.usage != Usage::depth_target;
    };
    const Resource& resource = runtime.resource(handle);
    if (resource.lifetime == Lifetime::persistent && declares(*this, handle, suits)) return found;
    throw GraphError(fmt::format(
        "pass '{}' reserves {}, but may only what is persistent and what it writes from version 0, "
        "not as a target",
        step().name, resource.title()));
}

/// Creates a new object for a resource of the pass, unless the present one has this storage.
void Running::replace(ResourceHandle handle, const Storage& storage) const {
    Slot& present = slot(handle, true);
    if (present.storage == storage) return;
    Slot made = present;
    made.storage = storage;
    runtime.create(made, runtime.resource(handle).name);
    runtime.destroy(present);
    present = made;
    for (const Bound& bound : step().bound) {
        if (bound.resource == handle.resource) runtime.bind(bound);
    }
}

}  // namespace candela::detail

namespace candela {

void GraphRuntime::bind(ResourceHandle imported, ObjectId object, const TextureDesc& texture,
                        const BufferDesc& buffer) {
    detail::Slot* const slot = runtime_->import_slot(imported);
    if (!slot) return;
    slot->object = object;  // may be 0: the window's framebuffer
    slot->storage.texture = texture;
    slot->storage.buffer = buffer;
    slot->bound = true;
    runtime_->touch(imported);
}

void GraphRuntime::set_value(ResourceHandle imported, detail::Value value) {
    detail::Slot* const slot = runtime_->import_slot(imported);
    if (!slot || value.equals(slot->value)) return;
    slot->value = std::move(value);
    runtime_->touch(imported);
}

const void* GraphRuntime::content(ResourceHandle value) const {
    return runtime_->content(value);
}

ObjectId GraphRuntime::object(ResourceHandle handle) const {
    (void)runtime_->resource(handle);
    const std::uint32_t slot = runtime_->graph->plan().object[handle.resource];
    return slot == detail::none ? 0 : runtime_->state.slots[slot].object;
}

WorldWriter Execution::world() const {
    return {pass_.world, pass_.writable, pass_.step().declared, pass_.step().name};
}

ObjectId Execution::object_of(ResourceHandle resource) const {
    return pass_.slot(resource, false).object;
}

const TextureDesc& Execution::desc(TextureHandle texture) const {
    return pass_.slot(texture, false).storage.texture;
}

std::uint64_t Execution::count_of(ResourceHandle buffer) const {
    return pass_.slot(buffer, false).storage.buffer.count;
}

void Execution::set_value(ResourceHandle value, detail::Value content) {
    detail::Slot& target = pass_.slot(value, true);
    if (content.equals(target.value)) return;
    target.value = std::move(content);
    target.changed = true;
}

const void* Execution::content(ResourceHandle value) const {
    (void)pass_.slot(value, false);
    return pass_.runtime.content(value);
}

const void* Execution::previous_content(ResourceHandle value) const {
    const detail::Slot& held = pass_.slot(value, true);
    if (!detail::declares(pass_, value, &detail::Access::update)) {
        throw GraphError(fmt::format("pass '{}' asks for the previous content of {}, but does not update it",
                                     pass_.step().name, pass_.runtime.resource(value).title()));
    }
    return pass_.runtime.repeating ? nullptr : held.value.content.get();
}

bool Execution::has_result() const {
    return pass_.has_result;
}

bool Execution::changed(ResourceHandle read) const {
    const detail::Resource& resource = pass_.runtime.resource(read);
    const detail::Step& step = pass_.step();
    const std::uint32_t version = pass_.runtime.graph->plan().version(read.resource, read.version);
    const auto input = std::ranges::find(step.inputs, version, &detail::Input::version);
    if (input != step.inputs.end()) {
        return !pass_.has_result || pass_.runtime.state.versions[version].stamp != input->stamp;
    }
    throw GraphError(fmt::format("pass '{}' asks whether {} has changed without having declared it",
                                 step.name, resource.title()));
}

bool Execution::may_end() const {
    return pass_.wanted != nullptr;
}

void Execution::reserve_buffer(ResourceHandle buffer, std::uint64_t count) {
    detail::Storage wanted = pass_.reservable(buffer).storage;
    const std::uint64_t present = wanted.buffer.count;
    if (count > present) wanted.buffer.count = std::max(count, present + present / 2);
    pass_.replace(buffer, wanted);
}

void Execution::reserve(TextureHandle texture, const TextureDesc& desc) {
    detail::Storage wanted = pass_.reservable(texture).storage;
    if (const std::string why = why_impossible(desc); !why.empty()) {
        throw GraphError(fmt::format("pass '{}' cannot reserve {}: {}", pass_.step().name,
                                     pass_.runtime.resource(texture).title(), why));
    }
    wanted.texture = desc;
    pass_.replace(texture, wanted);
}

}  // namespace candela
