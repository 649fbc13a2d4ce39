#include "engine/graph/details/state.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/graph/details/index_table.hpp"

namespace candela::detail {
namespace {

std::string describe(const TextureDesc& desc) {
    return fmt::format("{}x{}x{} {} {} {}", desc.size.x, desc.size.y, desc.layers, to_string(desc.format),
                       static_cast<int>(desc.shape), desc.mips);
}

std::string describe(const BufferDesc& desc) {
    return fmt::format("{}x{}", desc.count, desc.stride);
}

class StateMaker {
 public:
    explicit StateMaker(const CompiledGraph& graph) : declared_(graph.declared()), plan_(graph.plan()) {}

    State make() {
        const auto step_count = static_cast<std::uint32_t>(plan_.order.size());
        state_.versions.assign(plan_.writer.size(), {.producer = step_count});
        for (std::uint32_t position = 0; position < plan_.order.size(); ++position) {
            add_step(position);
        }
        add_slots();
        state_.need.resize(state_.steps.size() + 1);
        state_.turned.resize(plan_.owner.size());
        return std::move(state_);
    }

 private:
    void add_step(std::uint32_t position) {
        const std::uint32_t pass = plan_.order[position];
        const PassNode& node = declared_.passes[pass];
        Step step;
        step.invoke = node.invoke;
        step.function = node.function;
        step.name = node.name;
        step.barrier = plan_.barrier[position];
        step.side_effect = node.side_effect;
        step.keeps_state = node.keeps_state;
        for (const Access& access : declared_.accesses_of(pass)) {
            const Resource& resource = declared_.resources[access.resource];
            if (access.write) {
                add_output(step, access, position);
                step.writes_import |= resource.lifetime == Lifetime::imported;
            }
            step.keeps_state |= resource.history_of != none;
            add_input(step, access, pass);
            add_target(step, access);
            add_bound(step, access);
        }
        for (const ComponentRead& read : declared_.components_of(pass)) {
            step.revisions.push_back({read.revision});
        }
        state_.steps.push_back(std::move(step));
    }

    void add_output(Step& step, const Access& access, std::uint32_t position) {
        const Resource& resource = declared_.resources[access.resource];
        const std::uint32_t version = plan_.version(access.resource, access.version);
        const bool swaps_history = resource.history != none && access.version == 1;
        state_.versions[version].producer = position;
        state_.versions[version].present = false;
        step.outputs.push_back(
            {version, plan_.object[access.resource], resource.kind == ResourceKind::value, swaps_history});
    }

    void add_input(Step& step, const Access& access, std::uint32_t pass) const {
        const bool previous = declared_.resources[access.resource].history_of != none;
        if (previous || (access.write && access.version == 1)) return;
        const std::uint32_t version = plan_.version(access.resource, access.version - (access.write ? 1 : 0));
        if (plan_.writer[version] != pass) step.inputs.push_back({version});
    }

    void add_target(Step& step, const Access& access) const {
        if (declared_.resources[access.resource].kind != ResourceKind::texture) return;
        const bool depth = access.usage == Usage::depth_target;
        if (depth || access.usage == Usage::colour_target) {
            step.targets.push_back({plan_.object[access.resource], depth});
        }
    }

    static void add_bound(Step& step, const Access& access) {
        if (access.point != Binding::unbound || access.usage == Usage::indirect) {
            step.bound.push_back({access.resource, {access.usage, access.point}});
        }
    }

    void add_slots() {
        state_.holds.assign(plan_.owner.size(), none);
        state_.slots.resize(plan_.owner.size());
        for (std::uint32_t object = 0; object < plan_.owner.size(); ++object) {
            const Resource& resource = declared_.resources[plan_.owner[object]];
            Slot& slot = state_.slots[object];
            slot.kind = resource.kind;
            slot.owned = slot.kind != ResourceKind::value && resource.lifetime != Lifetime::imported;
            if (slot.kind == ResourceKind::texture) slot.texture = declared_.texture(resource);
            if (slot.kind == ResourceKind::buffer) slot.buffer = declared_.buffer(resource);
            slot.view = resource.part_of != none;
            if (slot.owned && resource.lifetime == Lifetime::persistent) {
                const TextureDesc& whole =
                    slot.view ? declared_.texture(declared_.resources[resource.part_of]) : slot.texture;
                slot.kept_as = fmt::format("{} {} {}", resource.name, describe(whole), describe(slot.buffer));
            }
        }
        for (std::uint32_t index = 0; index < declared_.resources.size(); ++index) {
            const bool imported = declared_.resources[index].lifetime == Lifetime::imported;
            if (imported && plan_.object[index] != none) state_.imports.push_back(index);
        }
    }

    const Declaration& declared_;
    const Plan& plan_;
    State state_;
};

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
          taken_(before.slots.size(), 0),
          old_version_(plan_.writer.size(), none),
          new_version_(old_plan_.writer.size(), none) {}

    std::vector<std::uint8_t> inherit() {
        take_slots();
        take_records();
        take_transients();
        for (const auto& [slot, old_slot] : slot_pairs_) {
            const std::uint32_t old_version = old_.holds[old_slot];
            const std::uint32_t version = old_version == none ? none : new_version_[old_version];
            if (version == none) continue;
            state_.holds[slot] = version;
            state_.versions[version].present = old_.versions[old_version].present;
        }
        return std::move(taken_);
    }

 private:
    [[nodiscard]] bool alike(const Resource& resource, const Resource& old) const {
        if (resource.kind != old.kind || resource.lifetime != old.lifetime || resource.name != old.name ||
            (resource.history == none) != (old.history == none) ||
            (resource.history_of == none) != (old.history_of == none) ||
            (resource.part_of == none) != (old.part_of == none)) {
            return false;
        }
        if (resource.part_of != none &&
            (resource.part != old.part ||
             !alike(declared_.resources[resource.part_of], old_declared_.resources[old.part_of]))) {
            return false;
        }
        switch (resource.kind) {
            case ResourceKind::texture:
                return declared_.texture(resource) == old_declared_.texture(old);
            case ResourceKind::buffer:
                return declared_.buffer(resource) == old_declared_.buffer(old);
            case ResourceKind::value:
                return declared_.value_types[resource.desc] == old_declared_.value_types[old.desc];
        }
        return false;
    }

    /// Matches persistent and imported resources by kind and name. The host must bind imported GPU objects
    /// again.
    void take_slots() {
        const auto known = [](const Resource& resource) {
            return resource.lifetime != Lifetime::transient && resource.history_of == none;
        };
        const auto hash = [](const Resource& resource) {
            return hash_of(resource.name) + static_cast<std::size_t>(resource.kind);
        };
        IndexTable table(old_declared_.resources.size());
        for (std::uint32_t index = 0; index < old_declared_.resources.size(); ++index) {
            const Resource& old = old_declared_.resources[index];
            if (known(old) && old_plan_.object[index] != none) {
                (void)table.find_or_insert(hash(old), index, [](std::uint32_t) { return false; });
            }
        }
        for (std::uint32_t index = 0; index < declared_.resources.size(); ++index) {
            const Resource& resource = declared_.resources[index];
            if (!known(resource) || plan_.object[index] == none) continue;
            const std::uint32_t old = table.find_index(hash(resource), [&](std::uint32_t other) {
                return alike(resource, old_declared_.resources[other]);
            });
            if (old != none) take_resource(index, old);
        }
    }

    void take_resource(std::uint32_t index, std::uint32_t old) {
        const Resource& resource = declared_.resources[index];
        const std::uint32_t version = plan_.version(index, 0);
        const std::uint32_t old_version = old_plan_.version(old, 0);
        const bool bound_anew =
            resource.lifetime == Lifetime::imported && resource.kind != ResourceKind::value;
        if (resource.lifetime == Lifetime::imported) pair_versions(version, old_version);
        if (bound_anew) return;
        take_slot(plan_.object[index], old_plan_.object[old]);
        if (resource.history != none) take_slot(plan_.object[index] + 1, old_plan_.object[old] + 1);
    }

    void take_slot(std::uint32_t slot, std::uint32_t old_slot) {
        state_.slots[slot] = old_.slots[old_slot];
        taken_[old_slot] = 1;
        slot_pairs_.push_back({slot, old_slot});
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
        IndexTable table(old_.step_count());
        for (std::uint32_t index = 0; index < old_.step_count(); ++index) {
            (void)table.find_or_insert(hash_of(old_.steps[index].name), index,
                                       [](std::uint32_t) { return false; });
        }
        for (std::uint32_t index = 0; index < state_.step_count(); ++index) {
            const std::string_view name = state_.steps[index].name;
            const std::uint32_t old = table.find_index(
                hash_of(name), [&](std::uint32_t other) { return old_.steps[other].name == name; });
            if (old != none && same_pass(plan_.order[index], old_plan_.order[old])) take_record(index, old);
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
        const auto is_transient = [](const Slot& of) { return of.owned && of.kept_as.empty(); };
        if (old_.holds[old_slot] == old_version && taken_[old_slot] == 0 &&
            is_transient(old_.slots[old_slot]) && is_transient(state_.slots[slot]) &&
            state_.slots[slot].object == 0) {
            take_slot(slot, old_slot);
        }
    }

    [[nodiscard]] bool same_pass(std::uint32_t pass, std::uint32_t old) const {
        const auto accesses = declared_.accesses_of(pass);
        const auto components = declared_.components_of(pass);
        const auto parameters = declared_.parameters_of(pass);
        const auto old_components = old_declared_.components_of(old);
        return std::ranges::equal(components, old_components) &&
               std::ranges::equal(parameters, old_declared_.parameters_of(old),
                                  [](const Parameter& a, const Parameter& b) {
                                      return a.type == b.type && a.equal(a.value, b.value);
                                  }) &&
               std::ranges::equal(
                   accesses, old_declared_.accesses_of(old),
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
        if (resource.history_of != none) return true;
        if (a.write && (a.version == 1 || b.version == 1)) return a.version == b.version;
        const std::uint32_t step_back = a.write ? 1 : 0;
        const std::uint32_t version = plan_.version(a.resource, a.version - step_back);
        const std::uint32_t old_version = old_plan_.version(b.resource, b.version - step_back);
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
    std::vector<std::uint8_t> taken_;
    std::vector<std::uint32_t> old_version_;  // per new version id: the old one of the same content, or none
    std::vector<std::uint32_t> new_version_;  // the inverse: per old version id
    std::vector<std::pair<std::uint32_t, std::uint32_t>> slot_pairs_;
};

}  // namespace

State make_state(const CompiledGraph& graph) {
    return StateMaker(graph).make();
}

std::vector<std::uint8_t> inherit(const CompiledGraph& graph, State& state, const CompiledGraph& graph_before,
                                  const State& before) {
    return StateTransfer(graph, state, graph_before, before).inherit();
}

}  // namespace candela::detail
