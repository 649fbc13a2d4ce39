#include <algorithm>
#include <functional>
#include <string>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/runtime.hpp"

namespace candela::detail {
namespace {

std::size_t hash_of(const Slot& slot) {
    return std::hash<std::string>{}(slot.key) ^ slot.declared.hash();
}

std::uint64_t byte_size(const Slot& slot) {
    return slot.storage.kind == ResourceKind::texture ? byte_size(slot.storage.texture)
                                                      : byte_size(slot.storage.buffer);
}

/// Unused objects that other slots can take. A slot whose object was taken has object 0.
class UnusedObjects {
 public:
    explicit UnusedObjects(std::vector<Slot>& slots) {
        for (Slot& slot : slots) {
            by_hash_.emplace(hash_of(slot), &slot);
        }
    }

    /// Gives the slot an object that was declared alike, if there is one. A persistent object keeps its
    /// current storage, which may be larger than declared.
    void provide(Slot& wanted) {
        const auto [first, last] = by_hash_.equal_range(hash_of(wanted));
        const auto found = std::find_if(first, last, [&](const auto& entry) {
            return entry.second->key == wanted.key && entry.second->declared == wanted.declared;
        });
        if (found == last) return;
        wanted.object = std::exchange(found->second->object, 0);
        wanted.storage = found->second->storage;
        by_hash_.erase(found);
    }

 private:
    std::unordered_multimap<std::size_t, Slot*> by_hash_;
};

/// The back end of graphs without GPU resources.
class NoBackend final : public Backend {
 public:
    ObjectId create_texture(std::string_view name, const TextureDesc& /*desc*/) override { refuse(name); }
    ObjectId create_buffer(std::string_view name, const BufferDesc& /*desc*/) override { refuse(name); }
    void destroy_texture(ObjectId /*texture*/) override {}
    void destroy_buffer(ObjectId /*buffer*/) override {}
    void barrier(Barrier /*bits*/) override {}
    void begin_pass(std::string_view /*name*/, std::uint32_t /*index*/,
                    const PassTargets* /*targets*/) override {}
    void end_pass() override {}
    void bind_texture(ObjectId /*texture*/, const TextureDesc& /*desc*/, Binding /*binding*/) override {}
    void bind_buffer(ObjectId /*buffer*/, Binding /*binding*/) override {}
    std::uint64_t texture_digest(ObjectId /*texture*/) override { return 0; }
    std::uint64_t buffer_digest(ObjectId /*buffer*/) override { return 0; }

 private:
    [[noreturn]] static void refuse(std::string_view name) {
        throw GraphError(fmt::format("the runtime has no back end for '{}'", name));
    }
};

NoBackend no_backend;

}  // namespace

void Runtime::destroy_objects() {
    for (const Slot& slot : state.slots) {
        destroy(slot);
    }
    for (const Slot& slot : free_pool) {
        destroy(slot);
    }
}

void Runtime::switch_to(CompiledGraph next) {
    State made = make_state(next);
    std::vector<PassRecord> passes;
    passes.reserve(made.step_count());
    for (const std::uint32_t index : next.plan().order) {
        const PassNode& pass = next.declared().passes[index];
        passes.push_back({.name = pass.name, .note = next.declared().note_of(pass.note)});
    }
    if (verifying) made.contents.resize(made.versions.size());
    std::vector<Slot> unused = free_pool;
    if (graph) {
        const std::vector<std::uint32_t> taken = inherit(next, made, *graph, state);
        for (std::size_t index = 0; index < taken.size(); ++index) {
            const Slot& slot = state.slots[index];
            if (taken[index] == none && slot.owned) unused.push_back(slot);
        }
    }
    provide_objects(next, made, unused);

    // Nothing fails from here on. Unused objects of the previous graph go to the free pool; the objects that
    // were in it before are destroyed, unless they were taken.
    const auto pooled = unused.begin() + static_cast<std::ptrdiff_t>(free_pool.size());
    std::for_each(unused.begin(), pooled, [this](const Slot& slot) { destroy(slot); });
    unused.erase(unused.begin(), pooled);
    std::erase_if(unused, [](const Slot& slot) { return slot.object == 0; });
    // The planned barriers of the new graph do not cover the writes of the previous one.
    if (graph) pending_barriers = all_barriers;
    free_pool = std::move(unused);
    state = std::move(made);
    graph = std::move(next);
    record.passes = std::move(passes);
}

/// Gives each owned slot without an object an unused one, or creates one. If the back end throws,
/// destroys what was created.
void Runtime::provide_objects(const CompiledGraph& next, State& made, std::vector<Slot>& unused) {
    UnusedObjects available(unused);
    std::vector<Slot*> created;
    created.reserve(made.slots.size());
    try {
        for (std::uint32_t object = 0; object < made.slots.size(); ++object) {
            Slot& slot = made.slots[object];
            if (!slot.owned || slot.object != 0) continue;
            available.provide(slot);
            if (slot.object != 0) continue;
            create(slot, next.declared().resources[next.plan().owner[object]].name);
            created.push_back(&slot);
        }
    } catch (...) {
        std::ranges::for_each(created, [this](const Slot* slot) { destroy(*slot); });
        throw;
    }
}

void Runtime::create(Slot& slot, std::string_view name) {
    slot.object = slot.storage.kind == ResourceKind::texture
                      ? backend.create_texture(name, slot.storage.texture)
                      : backend.create_buffer(name, slot.storage.buffer);
}

void Runtime::destroy(const Slot& slot) {
    if (!slot.owned || slot.object == 0) return;
    if (slot.storage.kind == ResourceKind::texture) {
        backend.destroy_texture(slot.object);
    } else {
        backend.destroy_buffer(slot.object);
    }
}

}  // namespace candela::detail

namespace candela {

GraphRuntime::GraphRuntime() : GraphRuntime(detail::no_backend) {}
GraphRuntime::GraphRuntime(Backend& backend) : runtime_(std::make_unique<detail::Runtime>(backend)) {}
GraphRuntime::~GraphRuntime() {
    runtime_->destroy_objects();
}

void GraphRuntime::switch_to(CompiledGraph graph) {
    runtime_->switch_to(std::move(graph));
}

const CompiledGraph* GraphRuntime::graph() const {
    return runtime_->graph ? &*runtime_->graph : nullptr;
}

MemoryUse GraphRuntime::memory() const {
    const detail::Runtime& now = *runtime_;
    MemoryUse use;
    const auto add = [&](const detail::Slot& slot) {
        const bool texture = slot.storage.kind == ResourceKind::texture;
        if (slot.owned) (texture ? use.texture_bytes : use.buffer_bytes) += detail::byte_size(slot);
    };
    for (const detail::Slot& slot : now.state.slots) {
        add(slot);
    }
    for (const detail::Slot& slot : now.free_pool) {
        add(slot);
        use.free_pool_bytes += detail::byte_size(slot);
    }
    if (!now.graph) return use;
    const detail::Plan& plan = now.graph->plan();
    const std::vector<detail::Resource>& resources = now.graph->declared().resources;
    for (std::uint32_t index = 0; index < resources.size(); ++index) {
        const std::uint32_t object = plan.object[index];
        if (resources[index].lifetime != Lifetime::transient || object == detail::none) continue;
        if (plan.owner[object] != index) {
            use.shared_by_aliasing_bytes += detail::byte_size(now.state.slots[object]);
        }
    }
    return use;
}

}  // namespace candela
