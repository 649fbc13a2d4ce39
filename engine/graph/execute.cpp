#include <candela/graph/execute.hpp>

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "engine/graph/details/runtime.hpp"

namespace candela::detail {
namespace {

/// Whether a pass runs in the current frame, as bits.
enum Need : std::uint8_t {
    nothing = 0,
    may_change = 1,  // its inputs have changed, or may still change in this frame
    certain = 2      // it runs even if its inputs do not change
};

/// Stands for all types of components.
constexpr std::size_t all_types = std::numeric_limits<std::size_t>::max();

/// Ends a pass whose frame is not wanted any more.
struct Unwanted : std::exception {};

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace

const FrameRecord& Runtime::run(const World& world, World* writable, Timing timing,
                                const std::function<bool()>& wanted) {
    if (!graph) throw GraphError("there is no frame graph");
    require_imports();
    if (writable == nullptr) require_no_systems();
    // The barriers that are planned for the end of a frame serve the next one, too.
    if (!record.complete) pending_barriers = all_barriers;
    mark(world, 0);
    // Set when a pass that might have changed its results did not: its readers may be marked without need.
    bool marked_too_many = false;

    const bool may_hold = std::ranges::all_of(
        state.steps, [](const Step& step) { return step.held_by == none || step.has_run; });

    record.frame = frame;
    for (PassRecord& each : record.passes) {
        each.ran = each.verified = false;
        each.cpu_ms = 0;
    }
    record.complete = false;
    Running pass{*this, world, writable, wanted ? &wanted : nullptr};
    Clock::time_point last = timing == Timing::on ? Clock::now() : Clock::time_point{};
    for (std::uint32_t position = 0; position < state.step_count(); ++position) {
        Step& step = state.steps[position];
        pending_barriers = pending_barriers | step.barrier;
        step.is_held = may_hold && is_held(step);
        if (step.is_held) {
            marked_too_many = true;
            continue;
        }
        if (state.need[position] == nothing) continue;
        const bool changed = dirty(step, world);
        if (!changed && marked_too_many) {
            mark(world, position);
            marked_too_many = false;
        }
        if (!changed && (state.need[position] & certain) == 0) {
            marked_too_many = true;
            continue;
        }

        if (wanted && !wanted()) return record;
        pass.position = position;
        try {
            run_step(pass, changed);
        } catch (const Unwanted&) {
            return record;
        }
        marked_too_many |= step.writes_world || !renewed_results(step);
        PassRecord& ran = record.passes[position];
        ran.ran = true;
        if (timing == Timing::on) {
            const Clock::time_point now = Clock::now();
            ran.cpu_ms = milliseconds(now - last);
            last = now;
        }
    }
    ++frame;
    record.complete = true;
    return record;
}

void Runtime::require_imports() const {
    for (const std::uint32_t index : state.imports) {
        const Slot& slot = state.slots[graph->plan().object[index]];
        if (slot.bound || slot.value.content) continue;
        const Resource& resource = graph->declared().resources[index];
        const std::string_view lack =
            resource.storage->kind == ResourceKind::value ? "has not been set" : "has not been bound";
        throw GraphError(fmt::format("imported {} {}", resource.title(), lack));
    }
}

void Runtime::require_no_systems() const {
    const auto system = std::ranges::find_if(state.steps, &Step::writes_world);
    if (system == state.steps.end()) return;
    throw GraphError(
        fmt::format("pass '{}' changes the world, which is run with one that is const", system->name));
}

bool Runtime::is_held(const Step& step) const {
    if (step.held_by == none) return false;
    const void* const held = state.slots[step.held_by].value.content.get();
    return held != nullptr && *static_cast<const bool*>(held);
}

bool Runtime::dirty(const Step& step, const World& world) const {
    if (!step.has_run || step.side_effect) return true;
    return std::ranges::any_of(
               step.inputs,
               [this](const Input& input) { return state.versions[input.version].stamp != input.stamp; }) ||
           std::ranges::any_of(step.revisions, [&](const Revision& revision) {
               return revision.access.revision(world) != revision.tick;
           });
}

/// Marks which passes may have to run, from position `from` on. The passes before it are finished: those that
/// have not changed their results do not make others run.
void Runtime::mark(const World& world, std::uint32_t from) {
    for (const std::uint32_t held : state.holds) {
        if (held != none) state.versions[held].present = true;
    }
    std::fill_n(state.need.begin(), from, std::uint8_t{nothing});
    mark_dirty(world, from);
    while (mark_missing(from)) {
    }
}

/// Whether an earlier step may change components in this frame that the step reads or writes.
bool Runtime::follows_system(const Step& step) const {
    const std::vector<std::size_t>& changing = state.components_to_change;
    return !changing.empty() && std::ranges::any_of(step.revisions, [&](const Revision& revision) {
        return std::ranges::any_of(
            changing, [&](std::size_t type) { return type == revision.access.type || type == all_types; });
    });
}

void Runtime::note_system(const Step& step) {
    std::vector<std::size_t>& changing = state.components_to_change;
    if (step.declared.writes_entities) changing.push_back(all_types);
    for (const Revision& revision : step.revisions) {
        if (revision.access.write) changing.push_back(revision.access.type);
    }
}

/// Forward sweep: a pass may change if it is dirty now, or if it has an input from a pass that may change.
void Runtime::mark_dirty(const World& world, std::uint32_t from) {
    state.components_to_change.clear();
    for (std::uint32_t position = from; position < state.step_count(); ++position) {
        const Step& step = state.steps[position];
        std::uint8_t need = step.writes_import ? certain : nothing;
        if (dirty(step, world)) {
            need = may_change | certain;
        } else {
            for (const Input& input : step.inputs) {
                if ((state.need[state.versions[input.version].producer] & may_change) != 0) {
                    need |= may_change;
                }
            }
            if (follows_system(step)) need |= may_change;
        }
        if (step.writes_world && need != nothing) note_system(step);
        state.need[position] = need;
    }
}

/// Backward sweep: if an input of a running pass is missing, the pass that produces it must run as well. A
/// run also overwrites what a later pass has put into the same object: a later version or another resource.
/// Returns true if that removes a version whose readers the sweep has already visited, so that another sweep
/// is needed.
bool Runtime::mark_missing(std::uint32_t from) {
    bool again = false;
    for (std::uint32_t position = state.step_count(); position-- > from;) {
        if (state.need[position] == nothing) continue;
        const Step& step = state.steps[position];
        for (const Input& input : step.inputs) {
            const Version& version = state.versions[input.version];
            state.need[version.producer] |= version.present ? nothing : certain;
        }
        for (const Output& output : step.outputs) {
            const std::uint32_t held = state.holds[output.slot];
            if (held == none) continue;
            Version& version = state.versions[held];
            const bool lost = version.present & (version.producer > position);
            again |= lost & ((state.need[version.producer] & certain) == 0);
            version.present &= !lost;
        }
    }
    return again;
}

void Runtime::run_step(Running& pass, bool changed) {
    Step& step = state.steps[pass.position];
    pass.has_result = !repeating && step.has_run && has_results(step);
    step.has_run = false;
    begin_outputs(step);
    if (pending_barriers != Barrier::none) backend.barrier(pending_barriers);
    pending_barriers = Barrier::none;
    begin_pass(pass.position);
    {
        const OnExit end([this] { backend.end_pass(); });
        for (const Bound& bound : step.bound) {
            bind(bound);
        }
        Execution execution(pass);
        if (step.invoke) step.invoke(step.function, execution);
    }
    keep_record(step, pass.world, changed);
}

bool Runtime::has_results(const Step& step) const {
    return std::ranges::all_of(step.outputs,
                               [&](const Output& output) { return state.versions[output.version].present; });
}

/// Whether all outputs of the step, which has just run, count as changed for their readers.
bool Runtime::renewed_results(const Step& step) const {
    return std::ranges::all_of(
        step.outputs, [&](const Output& output) { return state.versions[output.version].stamp == clock; });
}

/// Marks the outputs as not present while the pass runs, so that an exception cannot leave an incomplete
/// result that counts as valid.
void Runtime::begin_outputs(const Step& step) {
    for (const Output& output : step.outputs) {
        if (output.value) state.slots[output.slot].changed = state.holds[output.slot] != output.version;
        release(output.slot);
    }
}

void Runtime::release(std::uint32_t slot) {
    std::uint32_t& held = state.holds[slot];
    if (held != none) state.versions[held].present = false;
    held = none;
}

void Runtime::begin_pass(std::uint32_t position) {
    const Step& step = state.steps[position];
    if (step.targets.empty()) return backend.begin_pass(step.name, position, nullptr);

    PassTargets targets;
    colours.clear();
    for (const Target& target : step.targets) {
        const Slot& slot = state.slots[target.slot];
        targets.size = slot.storage.texture.size;
        if (target.depth) {
            targets.depth = slot.object;
            targets.writes_depth = target.written;
        } else {
            colours.push_back(slot.object);
        }
    }
    targets.colour = colours;
    backend.begin_pass(step.name, position, &targets);
}

void Runtime::bind(const Bound& bound) {
    const Slot& slot = *slot_of(bound.resource);
    if (slot.storage.kind == ResourceKind::texture) {
        backend.bind_texture(slot.object, slot.storage.texture, bound.binding);
    } else {
        backend.bind_buffer(slot.object, bound.binding);
    }
}

/// Records a completed run. The outputs keep their stamps if the pass ran only to restore a result, with
/// unchanged inputs; a value keeps its stamp also if it was set to an equal value.
void Runtime::keep_record(Step& step, const World& world, bool changed) {
    for (Input& input : step.inputs) {
        input.stamp = state.versions[input.version].stamp;
    }
    for (Revision& revision : step.revisions) {
        revision.tick = revision.access.revision(world);
    }
    ++clock;
    for (const Output& output : step.outputs) {
        Version& version = state.versions[output.version];
        release(output.slot);
        state.holds[output.slot] = output.version;
        version.present = true;
        if (changed && (!output.value || state.slots[output.slot].changed)) version.stamp = clock;
    }
    if (verifying) note_contents(step, changed);
    step.has_run = true;
}

}  // namespace candela::detail

namespace candela {

void Execution::end_if_unwanted() const {
    if (pass_.wanted != nullptr && !(*pass_.wanted)()) throw detail::Unwanted();
}

const FrameRecord& GraphRuntime::run(World& world, Timing timing, const std::function<bool()>& wanted) {
    return runtime_->run(world, &world, timing, wanted);
}

const FrameRecord& GraphRuntime::run(const World& world, Timing timing, const std::function<bool()>& wanted) {
    return runtime_->run(world, nullptr, timing, wanted);
}

void GraphRuntime::invalidate() {
    for (detail::Step& step : runtime_->state.steps) {
        step.has_run = false;
    }
}

}  // namespace candela
