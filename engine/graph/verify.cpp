#include <algorithm>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/state.hpp"

namespace candela {
namespace {

/// Per step: whether it may run again after a frame (see GraphRuntime::verify). Excludes the steps that must
/// not run again by themselves, then those that an excluded one keeps from it, until nothing changes.
std::vector<std::uint8_t> repeatable_steps(const detail::State& state, const World& world) {
    std::vector<std::uint8_t> again(state.step_count(), 1);
    std::vector<std::uint8_t> settled(state.slots.size());         // holds an output of an excluded step
    std::vector<std::uint8_t> overwritten(state.versions.size());  // by an excluded step
    const auto exclude = [&](std::uint32_t position) {
        again[position] = 0;
        for (const detail::Output& output : state.steps[position].outputs) {
            settled[output.slot] = 1;
            overwritten[output.version - 1] = 1;
        }
    };
    const auto can_read = [&](const detail::Input& input) {
        const detail::Version& version = state.versions[input.version];
        const bool made_again = version.producer < again.size() && again[version.producer];
        return !overwritten[input.version] && (made_again || version.present);
    };
    // A later pass may have changed the components that the step reads.
    const auto has_changed = [&](const detail::Revision& revision) {
        return revision.access.revision(world) != revision.tick;
    };
    const auto can_write = [&](const detail::Output& output) { return !settled[output.slot]; };

    for (std::uint32_t position = 0; position < again.size(); ++position) {
        const detail::Step& step = state.steps[position];
        if (!step.has_run || step.is_held || step.side_effect || step.writes_import || step.writes_world ||
            step.keeps_state || std::ranges::any_of(step.revisions, has_changed)) {
            exclude(position);
        }
    }
    for (bool excluded = true; excluded;) {
        excluded = false;
        for (std::uint32_t position = 0; position < again.size(); ++position) {
            const detail::Step& step = state.steps[position];
            if (!again[position] || (std::ranges::all_of(step.inputs, can_read) &&
                                     std::ranges::all_of(step.outputs, can_write))) {
                continue;
            }
            exclude(position);
            excluded = true;
        }
    }
    return again;
}

}  // namespace

void GraphRuntime::set_verification(bool on) {
    if (on == verifying_) return;
    verifying_ = on;
    state_->contents.clear();
    state_->contents.resize(on ? state_->versions.size() : 0);
}

void GraphRuntime::verify(const World& world) {
    if (!graph_ || !verifying_) {
        throw GraphError("there is no frame to verify: there is no graph, or verification is off");
    }
    const std::vector<std::uint8_t> again = repeatable_steps(*state_, world);
    repeating_ = true;
    const detail::OnExit end([this] { repeating_ = false; });
    Execution execution(*this, world, nullptr);
    pending_barriers_ = all_barriers;  // the planned barriers assume whole frames, one after the other
    for (std::uint32_t position = 0; position < state_->step_count(); ++position) {
        pending_barriers_ = pending_barriers_ | state_->steps[position].barrier;
        if (!again[position]) continue;
        execution.position_ = position;
        run_step(execution, false);
        record_.passes[position].verified = true;
    }
    pending_barriers_ = all_barriers;
}

/// Records the contents of the step's outputs. If the inputs have not changed, compares them with those of
/// its previous run and throws GraphError at a difference.
void GraphRuntime::note_contents(const detail::Step& step, bool changed) {
    const auto drifted = [&](const detail::Input& input) { return state_->contents[input.version].drifted; };
    const bool excused = changed || step.keeps_state || std::ranges::any_of(step.inputs, drifted);
    for (const detail::Output& output : step.outputs) {
        const detail::Slot& slot = state_->slots[output.slot];
        const bool stamped = state_->versions[output.version].stamp == clock_;
        detail::Content& known = state_->contents[output.version];
        if (!output.value && !slot.owned) {
            known.drifted = !stamped;  // imported: its content cannot be compared
            continue;
        }
        detail::Content now = content_of(slot);
        const bool comparable = known.value.content && now.value.equal;
        const bool same =
            !known.known || (known.digest == now.digest && (!comparable || now.value.equals(known.value)));
        if (!same && !excused) report_difference(step, output.version);
        now.drifted = !stamped && (known.drifted || !same);
        known = std::move(now);
    }
}

detail::Content GraphRuntime::content_of(const detail::Slot& slot) const {
    detail::Content content{.known = true, .value = slot.value};
    if (slot.storage.kind == ResourceKind::texture) {
        content.digest = backend_.texture_digest(slot.object);
    } else if (slot.storage.kind == ResourceKind::buffer) {
        content.digest = backend_.buffer_digest(slot.object);
    }
    return content;
}

void GraphRuntime::report_difference(const detail::Step& step, std::uint32_t version) const {
    const detail::Resource& resource = graph_->declared().resources[graph_->plan().resource(version)];
    throw GraphError(fmt::format(
        "pass '{}' has an undeclared input: run again while nothing that it declares has changed, "
        "it gives {} another content",
        step.name, resource.title()));
}

}  // namespace candela
