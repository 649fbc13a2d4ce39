#include <algorithm>
#include <functional>
#include <string>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/state.hpp"

namespace candela {
namespace {

std::size_t hash_of(const detail::Slot& slot) {
    return std::hash<std::string>{}(slot.key) ^ slot.declared.hash();
}

std::uint64_t byte_size(const detail::Slot& slot) {
    return slot.storage.kind == ResourceKind::texture ? byte_size(slot.storage.texture)
                                                      : byte_size(slot.storage.buffer);
}

/// Unused objects that other slots can take. A slot whose object was taken has object 0.
class UnusedObjects {
 public:
    explicit UnusedObjects(std::vector<detail::Slot>& slots) {
        for (detail::Slot& slot : slots) {
            by_hash_.emplace(hash_of(slot), &slot);
        }
    }

    /// Gives the slot an object that was declared alike, if there is one. A persistent object keeps its
    /// current storage, which may be larger than declared.
    void provide(detail::Slot& wanted) {
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
    std::unordered_multimap<std::size_t, detail::Slot*> by_hash_;
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

GraphRuntime::GraphRuntime() : GraphRuntime(no_backend) {}
GraphRuntime::GraphRuntime(Backend& backend) : backend_(backend), state_(std::make_unique<detail::State>()) {}

GraphRuntime::~GraphRuntime() {
    for (const detail::Slot& slot : state_->slots) {
        destroy(slot);
    }
    for (const detail::Slot& slot : free_pool_) {
        destroy(slot);
    }
}

void GraphRuntime::switch_to(CompiledGraph graph) {
    detail::State state = detail::make_state(graph);
    std::vector<PassRecord> passes;
    passes.reserve(state.step_count());
    for (std::uint32_t position = 0; position < state.step_count(); ++position) {
        const detail::PassNode& pass = graph.declared().passes[graph.plan().order[position]];
        passes.push_back({.name = pass.name, .note = graph.declared().note_of(pass.note)});
    }
    if (verifying_) state.contents.resize(state.versions.size());
    std::vector<detail::Slot> unused = free_pool_;
    if (graph_) {
        const std::vector<std::uint32_t> taken = detail::inherit(graph, state, *graph_, *state_);
        for (std::size_t index = 0; index < taken.size(); ++index) {
            const detail::Slot& slot = state_->slots[index];
            if (taken[index] == detail::none && slot.owned) unused.push_back(slot);
        }
    }
    provide_objects(graph, state, unused);

    // Nothing fails from here on. Unused objects of the previous graph go to the free pool; the objects that
    // were in it before are destroyed, unless they were taken.
    const auto pooled = unused.begin() + static_cast<std::ptrdiff_t>(free_pool_.size());
    std::for_each(unused.begin(), pooled, [this](const detail::Slot& slot) { destroy(slot); });
    unused.erase(unused.begin(), pooled);
    std::erase_if(unused, [](const detail::Slot& slot) { return slot.object == 0; });
    // The planned barriers of the new graph do not cover the writes of the previous one.
    if (graph_) pending_barriers_ = all_barriers;
    free_pool_ = std::move(unused);
    *state_ = std::move(state);
    graph_ = std::move(graph);
    record_.passes = std::move(passes);
}

/// Gives each owned slot without an object an unused one, or creates one. If the back end throws,
/// destroys what was created.
void GraphRuntime::provide_objects(const CompiledGraph& graph, detail::State& state,
                                   std::vector<detail::Slot>& unused) {
    UnusedObjects available(unused);
    std::vector<std::uint32_t> made;
    made.reserve(state.slots.size());
    try {
        for (std::uint32_t object = 0; object < state.slots.size(); ++object) {
            detail::Slot& slot = state.slots[object];
            if (!slot.owned || slot.object != 0) continue;
            available.provide(slot);
            if (slot.object != 0) continue;
            create(slot, graph.declared().resources[graph.plan().owner[object]].name);
            made.push_back(object);
        }
    } catch (...) {
        for (const std::uint32_t object : made) {
            destroy(state.slots[object]);
        }
        throw;
    }
}

void GraphRuntime::create(detail::Slot& slot, std::string_view name) {
    slot.object = slot.storage.kind == ResourceKind::texture
                      ? backend_.create_texture(name, slot.storage.texture)
                      : backend_.create_buffer(name, slot.storage.buffer);
}

void GraphRuntime::destroy(const detail::Slot& slot) {
    if (!slot.owned || slot.object == 0) return;
    if (slot.storage.kind == ResourceKind::texture) {
        backend_.destroy_texture(slot.object);
    } else {
        backend_.destroy_buffer(slot.object);
    }
}

MemoryUse GraphRuntime::memory() const {
    MemoryUse use;
    const auto add = [&](const detail::Slot& slot) {
        const bool texture = slot.storage.kind == ResourceKind::texture;
        if (slot.owned) (texture ? use.texture_bytes : use.buffer_bytes) += byte_size(slot);
    };
    for (const detail::Slot& slot : state_->slots) {
        add(slot);
    }
    for (const detail::Slot& slot : free_pool_) {
        add(slot);
        use.free_pool_bytes += byte_size(slot);
    }
    if (!graph_) return use;
    for (std::uint32_t index = 0; index < graph_->declared().resources.size(); ++index) {
        const detail::Resource& resource = graph_->declared().resources[index];
        const std::uint32_t object = graph_->plan().object[index];
        if (resource.lifetime != Lifetime::transient || object == detail::none) continue;
        if (graph_->plan().owner[object] != index) {
            use.shared_by_aliasing_bytes += byte_size(state_->slots[object]);
        }
    }
    return use;
}

}  // namespace candela
