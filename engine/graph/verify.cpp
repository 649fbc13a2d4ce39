#include <algorithm>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/runtime.hpp"

namespace candela::detail {
namespace {

/// Per step: whether it may run again after a frame (see GraphRuntime::verify). Excludes the steps that must
/// not run again by themselves, then those that an excluded one keeps from it, until nothing changes.
std::vector<std::uint8_t> repeatable_steps(const State& state, const World& world) {
    std::vector<std::uint8_t> again(state.step_count(), 1);
    std::vector<std::uint8_t> settled(state.slots.size());         // holds an output of an excluded step
    std::vector<std::uint8_t> overwritten(state.versions.size());  // by an excluded step
    const auto exclude = [&](std::uint32_t position) {
        again[position] = 0;
        for (const Output& output : state.steps[position].outputs) {
            settled[output.slot] = 1;
            overwritten[output.version - 1] = 1;
        }
    };
    const auto can_read = [&](const Input& input) {
        const Version& version = state.versions[input.version];
        const bool made_again = version.producer < again.size() && again[version.producer];
        return !overwritten[input.version] && (made_again || version.present);
    };
    // A later pass may have changed the components that the step reads.
    const auto has_changed = [&](const Revision& revision) {
        return revision.access.revision(world) != revision.tick;
    };
    const auto can_write = [&](const Output& output) { return !settled[output.slot]; };

    for (std::uint32_t position = 0; position < again.size(); ++position) {
        const Step& step = state.steps[position];
        if (!step.has_run || step.is_held || step.side_effect || step.writes_import || step.writes_world ||
            step.keeps_state || std::ranges::any_of(step.revisions, has_changed)) {
            exclude(position);
        }
    }
    for (bool excluded = true; excluded;) {
        excluded = false;
        for (std::uint32_t position = 0; position < again.size(); ++position) {
            const Step& step = state.steps[position];
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

void Runtime::verify(const World& world) {
    if (!graph || !verifying) {
        throw GraphError("there is no frame to verify: there is no graph, or verification is off");
    }
    const std::vector<std::uint8_t> again = repeatable_steps(state, world);
    repeating = true;
    const OnExit end([this] { repeating = false; });
    Running pass{*this, world, nullptr};
    pending_barriers = all_barriers;  // the planned barriers assume whole frames, one after the other
    for (std::uint32_t position = 0; position < state.step_count(); ++position) {
        pending_barriers = pending_barriers | state.steps[position].barrier;
        if (!again[position]) continue;
        pass.position = position;
        run_step(pass, false);
        record.passes[position].verified = true;
    }
    pending_barriers = all_barriers;
}

/// Records the contents of the step's outputs. If the inputs have not changed, compares them with those of
/// its previous run and throws GraphError at a difference.
void Runtime::note_contents(const Step& step, bool changed) {
    const auto drifted = [&](const Input& input) { return state.contents[input.version].drifted; };
    const bool excused = changed || step.keeps_state || std::ranges::any_of(step.inputs, drifted);
    for (const Output& output : step.outputs) {
        const Slot& slot = state.slots[output.slot];
        const bool stamped = state.versions[output.version].stamp == clock;
        Content& known = state.contents[output.version];
        if (!output.value && !slot.owned) {
            known.drifted = !stamped;  // imported: its content cannot be compared
            continue;
        }
        Content now = content_of(slot);
        const bool comparable = known.value.content && now.value.equal;
        const bool same =
            !known.known || (known.digest == now.digest && (!comparable || now.value.equals(known.value)));
        if (!same && !excused) report_difference(step, output.version);
        now.drifted = !stamped && (known.drifted || !same);
        known = std::move(now);
    }
}

Content Runtime::content_of(const Slot& slot) const {
    Content content{.known = true, .value = slot.value};
    if (slot.storage.kind == ResourceKind::texture) {
        content.digest = backend.texture_digest(slot.object);
    } else if (slot.storage.kind == ResourceKind::buffer) {
        content.digest = backend.buffer_digest(slot.object);
    }
    return content;
}

void Runtime::report_difference(const Step& step, std::uint32_t version) const {
    const Resource& resource = graph->declared().resources[graph->plan().resource(version)];
    throw GraphError(fmt::format(
        "pass '{}' has an undeclared input: run again while nothing that it declares has changed, "
        "it gives {} another content",
        step.name, resource.title()));
}

}  // namespace candela::detail

namespace candela {

void GraphRuntime::set_verification(bool on) {
    if (on == runtime_->verifying) return;
    runtime_->verifying = on;
    runtime_->state.contents.assign(on ? runtime_->state.versions.size() : 0, {});
}

bool GraphRuntime::verifies() const {
    return runtime_->verifying;
}

void GraphRuntime::verify(const World& world) {
    runtime_->verify(world);
}

}  // namespace candela
