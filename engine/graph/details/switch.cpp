#include <algorithm>
#include <unordered_map>
#include <utility>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/index_table.hpp"
#include "engine/graph/details/state.hpp"

namespace candela {
namespace {

std::size_t hash_of(const detail::Slot& slot) {
    return slot.kind == ResourceKind::texture ? detail::hash_of(slot.texture) : detail::hash_of(slot.buffer);
}

bool alike(const detail::Slot& a, const detail::Slot& b) {
    return a.kind == b.kind && a.texture == b.texture && a.buffer == b.buffer;
}

/// Unused objects that slots can take. A slot whose object was taken has object 0.
class UnusedObjects {
 public:
    explicit UnusedObjects(std::vector<detail::Slot>& slots) : slots_(slots) {
        for (std::size_t index = 0; index < slots.size(); ++index) {
            if (slots[index].kept_as.empty()) {
                by_hash_.emplace(hash_of(slots[index]), index);
            } else {
                by_name_.emplace(slots[index].kept_as, index);
            }
        }
    }

    /// Gives the slot a matching object if there is one. A persistent object matches by its key (`kept_as`)
    /// and keeps its current description, which may be larger than declared.
    void provide(detail::Slot& wanted) {
        if (wanted.kept_as.empty()) {
            const auto [first, last] = by_hash_.equal_range(hash_of(wanted));
            const auto found = std::find_if(
                first, last, [&](const auto& entry) { return alike(slots_[entry.second], wanted); });
            if (found != last) {
                take(wanted, found->second);
                by_hash_.erase(found);
            }
        } else if (const auto found = by_name_.find(wanted.kept_as); found != by_name_.end()) {
            take(wanted, found->second);
            by_name_.erase(found);
        }
    }

 private:
    void take(detail::Slot& wanted, std::size_t index) {
        wanted.object = std::exchange(slots_[index].object, 0);
        wanted.texture = slots_[index].texture;
        wanted.buffer = slots_[index].buffer;
    }

    std::vector<detail::Slot>& slots_;
    std::unordered_multimap<std::size_t, std::size_t> by_hash_;
    std::unordered_multimap<std::string, std::size_t> by_name_;
};

}  // namespace

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
        passes.push_back({.name = pass.name, .tag = pass.tag});
    }
    if (verifying_) state.contents.resize(state.versions.size());
    std::vector<detail::Slot> unused = free_pool_;
    if (graph_) {
        const std::vector<std::uint8_t> taken = detail::inherit(graph, state, *graph_, *state_);
        for (std::size_t index = 0; index < taken.size(); ++index) {
            if (!taken[index] && state_->slots[index].owned) unused.push_back(state_->slots[index]);
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
            const detail::Resource& resource = graph.declared().resources[graph.plan().owner[object]];
            if (slot.view) {
                const detail::Slot& whole = state.slots[graph.plan().object[resource.part_of]];
                slot.object = backend_.create_view(resource.name, whole.object, resource.part);
            } else {
                create(slot, resource.name);
            }
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
    slot.object = slot.kind == ResourceKind::texture ? backend_.create_texture(name, slot.texture)
                                                     : backend_.create_buffer(name, slot.buffer);
}

void GraphRuntime::destroy(const detail::Slot& slot) {
    if (!slot.owned || slot.object == 0) return;
    if (slot.kind == ResourceKind::texture) {
        backend_.destroy_texture(slot.object);
    } else {
        backend_.destroy_buffer(slot.object);
    }
}

MemoryUse GraphRuntime::memory() const {
    MemoryUse use;
    const auto bytes = [](const detail::Slot& slot) {
        if (slot.view) return std::uint64_t{0};
        return slot.kind == ResourceKind::texture ? byte_size(slot.texture) : byte_size(slot.buffer);
    };
    const auto add = [&](const detail::Slot& slot) {
        if (slot.owned) {
            (slot.kind == ResourceKind::texture ? use.texture_bytes : use.buffer_bytes) += bytes(slot);
        }
    };
    for (const detail::Slot& slot : state_->slots) {
        add(slot);
    }
    for (const detail::Slot& slot : free_pool_) {
        add(slot);
        use.free_pool_bytes += bytes(slot);
    }
    if (!graph_) return use;
    for (std::uint32_t index = 0; index < graph_->declared().resources.size(); ++index) {
        const detail::Resource& resource = graph_->declared().resources[index];
        const std::uint32_t object = graph_->plan().object[index];
        if (resource.lifetime != Lifetime::transient || object == detail::none) continue;
        if (graph_->plan().owner[object] != index) {
            use.shared_by_aliasing_bytes += bytes(state_->slots[object]);
        }
    }
    return use;
}

}  // namespace candela
