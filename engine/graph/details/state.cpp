#include "engine/graph/details/state.hpp"

#include <algorithm>
#include <map>

namespace candela::detail {
namespace {

Step make_step(const Declaration& declared, const Plan& plan, std::uint32_t position) {
    const std::uint32_t pass = plan.order[position];
    const PassNode& node = declared.passes[pass];
    Step step{.invoke = node.invoke,
              .function = node.function,
              .name = node.name,
              .key = node.key,
              .barrier = plan.barrier[position],
              .side_effect = node.side_effect,
              .keeps_state = node.keeps_state,
              .writes_world = node.writes_entities,
              .held_by = node.held_by == none ? none : plan.object[node.held_by]};
    step.declared.writes_entities = node.writes_entities;
    for (const ComponentAccess& access : declared.components_of(pass)) {
        step.revisions.push_back({access});
        step.writes_world |= access.write;
        std::vector<bool>& types = access.write ? step.declared.writes : step.declared.reads;
        types.resize(std::max(types.size(), access.type + 1));
        types[access.type] = true;
    }
    for (const Access& access : declared.accesses_of(pass)) {
        const Resource& resource = declared.resources[access.resource];
        const ResourceKind kind = resource.storage->kind;
        const std::uint32_t slot = plan.object[access.resource];
        const bool replaces = access.write && access.version == 1;
        if (access.write) {
            step.outputs.push_back(
                {plan.version(access.resource, access.version), slot, kind == ResourceKind::value});
            step.writes_import |= resource.lifetime == Lifetime::imported;
        }
        const std::uint32_t needed = plan.needed_version(access);
        if (!replaces && plan.writer[needed] != pass) step.inputs.push_back({needed});
        const bool depth = access.usage == Usage::depth_target;
        if (kind == ResourceKind::texture && (depth || access.usage == Usage::colour_target)) {
            step.targets.push_back({slot, depth, access.write});
        }
        if (access.point != Binding::unbound || access.usage == Usage::indirect) {
            step.bound.push_back({access.resource, {access.usage, access.point}});
        }
    }
    return step;
}

Slot make_slot(const Resource& resource) {
    Slot slot;
    slot.storage = *resource.storage;
    slot.owned = slot.storage.kind != ResourceKind::value && resource.lifetime != Lifetime::imported;
    slot.declared = slot.storage;
    if (slot.owned && resource.lifetime == Lifetime::persistent) slot.key = resource.key;
    return slot;
}

/// Transfers state from an old graph to a new one (see inherit).
class StateTransfer {
 public:
    StateTransfer(const CompiledGraph& graph, State& state, const CompiledGraph& graph_before,
                  const State& before)
        : declared_(graph.declared()),
          plan_(graph.plan()),
          state_(state),
          old_declared_(graph_before.declared()),
          old_plan_(graph_before.plan()),
          old_(before),
          taken_(before.slots.size(), none),
          old_version_(plan_.writer.size(), none),
          new_version_(old_plan_.writer.size(), none) {}

    std::vector<std::uint32_t> inherit() {
        take_slots();
        take_records();
        take_transients();
        for (std::uint32_t old_slot = 0; old_slot < taken_.size(); ++old_slot) {
            const std::uint32_t old_version = old_.holds[old_slot];
            const std::uint32_t version = old_version == none ? none : new_version_[old_version];
            if (taken_[old_slot] == none || version == none) continue;
            state_.holds[taken_[old_slot]] = version;
            state_.versions[version].present = old_.versions[old_version].present;
        }
        return std::move(taken_);
    }

 private:
    [[nodiscard]] static bool alike(const Resource& resource, const Resource& old) {
        return resource.key == old.key && *resource.storage == *old.storage &&
               resource.lifetime == old.lifetime;
    }

    /// Matches persistent and imported resources by kind and key. The host must bind imported GPU objects
    /// again.
    void take_slots() {
        std::map<std::pair<ResourceKind, std::string_view>, std::uint32_t> by_key;
        for (std::uint32_t index = 0; index < old_declared_.resources.size(); ++index) {
            const Resource& old = old_declared_.resources[index];
            if (old.is_kept() && old_plan_.object[index] != none) {
                by_key.insert({{old.storage->kind, old.key}, index});
            }
        }
        for (std::uint32_t index = 0; index < declared_.resources.size(); ++index) {
            const Resource& resource = declared_.resources[index];
            if (!resource.is_kept() || plan_.object[index] == none) continue;
            const auto found = by_key.find({resource.storage->kind, resource.key});
            if (found != by_key.end() && alike(resource, old_declared_.resources[found->second])) {
                take_resource(index, found->second);
            }
        }
    }

    void take_resource(std::uint32_t index, std::uint32_t old) {
        const Resource& resource = declared_.resources[index];
        if (resource.lifetime == Lifetime::imported) {
            pair_versions(plan_.version(index, 0), old_plan_.version(old, 0));
            if (resource.storage->kind != ResourceKind::value) return;  // bound anew
        }
        take_slot(plan_.object[index], old_plan_.object[old]);
    }

    void take_slot(std::uint32_t slot, std::uint32_t old_slot) {
        state_.slots[slot] = old_.slots[old_slot];
        taken_[old_slot] = slot;
    }

    void pair_versions(std::uint32_t version, std::uint32_t old_version) {
        old_version_[version] = old_version;
        new_version_[old_version] = version;
        state_.versions[version].stamp = old_.versions[old_version].stamp;
        if (!state_.contents.empty() && !old_.contents.empty()) {
            state_.contents[version] = old_.contents[old_version];
        }
    }

    void take_records() {
        std::map<std::string_view, std::uint32_t> by_key;
        for (std::uint32_t index = 0; index < old_.step_count(); ++index) {
            by_key.insert({old_.steps[index].key, index});
        }
        for (std::uint32_t index = 0; index < state_.step_count(); ++index) {
            const auto found = by_key.find(state_.steps[index].key);
            if (found != by_key.end() && same_pass(plan_.order[index], old_plan_.order[found->second])) {
                take_record(index, found->second);
            }
        }
    }

    /// Objects of transients that hold what the new graph puts into one of its own. If there are several for
    /// one, that which the new graph would put there last.
    void take_transients() {
        for (std::uint32_t position = state_.step_count(); position-- > 0;) {
            for (const Output& output : state_.steps[position].outputs) {
                if (old_version_[output.version] != none) {
                    take_transient(output.slot, old_version_[output.version]);
                }
            }
        }
    }

    void take_transient(std::uint32_t slot, std::uint32_t old_version) {
        const std::uint32_t old_slot = old_plan_.object[old_plan_.resource(old_version)];
        const auto is_transient = [](const Slot& of) { return of.owned && of.key.empty(); };
        if (old_.holds[old_slot] == old_version && taken_[old_slot] == none &&
            is_transient(old_.slots[old_slot]) && is_transient(state_.slots[slot]) &&
            state_.slots[slot].object == 0) {
            take_slot(slot, old_slot);
        }
    }

    [[nodiscard]] bool same_pass(std::uint32_t pass, std::uint32_t old) const {
        return declared_.passes[pass].writes_entities == old_declared_.passes[old].writes_entities &&
               std::ranges::equal(declared_.components_of(pass), old_declared_.components_of(old)) &&
               std::ranges::equal(declared_.parameters_of(pass), old_declared_.parameters_of(old)) &&
               std::ranges::equal(
                   declared_.accesses_of(pass), old_declared_.accesses_of(old),
                   [&](const Access& a, const Access& b) { return same_access(a, pass, b, old); });
    }

    /// Whether both access matching resources in the same way, and for inputs also the same content.
    [[nodiscard]] bool same_access(const Access& a, std::uint32_t pass, const Access& b,
                                   std::uint32_t old) const {
        const Resource& resource = declared_.resources[a.resource];
        if (a.usage != b.usage || a.point != b.point || a.write != b.write || a.update != b.update ||
            !alike(resource, old_declared_.resources[b.resource])) {
            return false;
        }
        if (a.write && (a.version == 1 || b.version == 1)) return a.version == b.version;
        const std::uint32_t version = plan_.needed_version(a);
        const std::uint32_t old_version = old_plan_.needed_version(b);
        const bool own = plan_.writer[version] == pass;
        const bool old_own = old_plan_.writer[old_version] == old;
        return own == old_own && (own || old_version_[version] == old_version);
    }

    void take_record(std::uint32_t index, std::uint32_t old) {
        Step& step = state_.steps[index];
        const Step& old_step = old_.steps[old];
        step.has_run = old_step.has_run;
        for (std::size_t at = 0; at < step.inputs.size(); ++at) {
            step.inputs[at].stamp = old_step.inputs[at].stamp;
        }
        step.revisions = old_step.revisions;
        for (std::size_t at = 0; at < step.outputs.size(); ++at) {
            pair_versions(step.outputs[at].version, old_step.outputs[at].version);
        }
    }

    const Declaration& declared_;
    const Plan& plan_;
    State& state_;
    const Declaration& old_declared_;
    const Plan& old_plan_;
    const State& old_;
    std::vector<std::uint32_t> taken_;        // per old slot: the new one that took it over, or none
    std::vector<std::uint32_t> old_version_;  // per new version id: the old one of the same content, or none
    std::vector<std::uint32_t> new_version_;  // the inverse: per old version id
};

}  // namespace

State make_state(const CompiledGraph& graph) {
    const Declaration& declared = graph.declared();
    const Plan& plan = graph.plan();
    const std::uint32_t step_count = size_of(plan.order);
    State state;
    state.versions.assign(plan.writer.size(), {.producer = step_count});
    for (std::uint32_t position = 0; position < step_count; ++position) {
        state.steps.push_back(make_step(declared, plan, position));
        for (const Output& output : state.steps.back().outputs) {
            state.versions[output.version].producer = position;
            state.versions[output.version].present = false;
        }
    }
    for (const std::uint32_t owner : plan.owner) {
        state.slots.push_back(make_slot(declared.resources[owner]));
    }
    for (std::uint32_t index = 0; index < declared.resources.size(); ++index) {
        const bool imported = declared.resources[index].lifetime == Lifetime::imported;
        if (imported && plan.object[index] != none) state.imports.push_back(index);
    }
    state.holds.assign(plan.owner.size(), none);
    state.need.resize(step_count + 1);
    return state;
}

std::vector<std::uint32_t> inherit(const CompiledGraph& graph, State& state,
                                   const CompiledGraph& graph_before, const State& before) {
    return StateTransfer(graph, state, graph_before, before).inherit();
}

}  // namespace candela::detail
