#include <candela/graph/execute.hpp>

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "engine/graph/details/state.hpp"

namespace candela {

using detail::none;

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

// The frame

void Execution::end_if_unwanted() const {
    if (wanted_ != nullptr && !(*wanted_)()) throw Unwanted();
}

const FrameRecord& GraphRuntime::run(World& world, Timing timing, const std::function<bool()>& wanted) {
    return run(world, &world, timing, wanted);
}

const FrameRecord& GraphRuntime::run(const World& world, Timing timing, const std::function<bool()>& wanted) {
    return run(world, nullptr, timing, wanted);
}

const FrameRecord& GraphRuntime::run(const World& world, World* writable, Timing timing,
                                     const std::function<bool()>& wanted) {
    if (!graph_) throw GraphError("there is no frame graph");
    require_imports();
    if (writable == nullptr) require_no_systems();
    // The barriers that are planned for the end of a frame serve the next one, too.
    if (!record_.complete) pending_barriers_ = all_barriers;
    mark(world, 0);
    // Set when a pass that might have changed its results did not: its readers may be marked without need.
    bool marked_too_many = false;

    const bool may_hold = std::ranges::all_of(
        state_->steps, [](const detail::Step& step) { return step.held_by == none || step.has_run; });

    record_.frame = frame_;
    for (PassRecord& record : record_.passes) {
        record.ran = record.verified = false;
        record.cpu_ms = 0;
    }
    if (record_.complete) std::fill(state_->turned.begin(), state_->turned.end(), std::uint8_t{0});
    record_.complete = false;
    Execution execution(*this, world, writable);
    if (wanted) execution.wanted_ = &wanted;
    Clock::time_point last = timing == Timing::on ? Clock::now() : Clock::time_point{};
    for (std::uint32_t position = 0; position < state_->step_count(); ++position) {
        detail::Step& step = state_->steps[position];
        pending_barriers_ = pending_barriers_ | step.barrier;
        step.is_held = may_hold && is_held(step);
        if (step.is_held) {
            marked_too_many = true;
            continue;
        }
        if (state_->need[position] == nothing) continue;
        const bool changed = dirty(step, world);
        if (!changed && marked_too_many) {
            mark(world, position);
            marked_too_many = false;
        }
        if (!changed && (state_->need[position] & certain) == 0) {
            marked_too_many = true;
            continue;
        }

        if (wanted && !wanted()) return record_;
        execution.position_ = position;
        try {
            run_step(execution, changed);
        } catch (const Unwanted&) {
            return record_;
        }
        marked_too_many |= step.writes_world || !renewed_results(step);
        PassRecord& record = record_.passes[position];
        record.ran = true;
        if (timing == Timing::on) {
            const Clock::time_point now = Clock::now();
            record.cpu_ms = milliseconds(now - last);
            last = now;
        }
    }
    ++frame_;
    record_.complete = true;
    return record_;
}

void GraphRuntime::require_imports() const {
    for (const std::uint32_t index : state_->imports) {
        const detail::Slot& slot = state_->slots[graph_->plan().object[index]];
        if (slot.filled || slot.value.content) continue;
        const detail::Resource& resource = graph_->declared().resources[index];
        const std::string_view lack =
            resource.storage->kind == ResourceKind::value ? "has not been set" : "has not been bound";
        throw GraphError(fmt::format("imported {} {}", resource.title(), lack));
    }
}

void GraphRuntime::require_no_systems() const {
    const auto system = std::ranges::find_if(state_->steps, &detail::Step::writes_world);
    if (system == state_->steps.end()) return;
    throw GraphError(
        fmt::format("pass '{}' changes the world, which is run with one that is const", system->name));
}

bool GraphRuntime::is_held(const detail::Step& step) const {
    if (step.held_by == none) return false;
    const void* const held = state_->slots[step.held_by].value.content.get();
    return held != nullptr && *static_cast<const bool*>(held);
}

bool GraphRuntime::dirty(const detail::Step& step, const World& world) const {
    if (!step.has_run || step.side_effect) return true;
    return std::ranges::any_of(step.inputs,
                               [this](const detail::Input& input) {
                                   return state_->versions[input.version].stamp != input.stamp;
                               }) ||
           std::ranges::any_of(step.revisions, [&](const detail::Revision& revision) {
               return revision.access.revision(world) != revision.tick;
           });
}

/// Marks which passes may have to run, from position `from` on. The passes before it are finished: those that
/// have not changed their results do not make others run.
void GraphRuntime::mark(const World& world, std::uint32_t from) {
    for (const std::uint32_t held : state_->holds) {
        if (held != none) state_->versions[held].present = true;
    }
    std::fill_n(state_->need.begin(), from, std::uint8_t{nothing});
    mark_dirty(world, from);
    while (mark_missing(from)) {
    }
}

/// Whether an earlier step may change components in this frame that the step reads or writes.
bool GraphRuntime::follows_system(const detail::Step& step) const {
    const std::vector<std::size_t>& changing = state_->components_to_change;
    return !changing.empty() && std::ranges::any_of(step.revisions, [&](const detail::Revision& revision) {
        return std::ranges::any_of(
            changing, [&](std::size_t type) { return type == revision.access.type || type == all_types; });
    });
}

void GraphRuntime::note_system(const detail::Step& step) {
    std::vector<std::size_t>& changing = state_->components_to_change;
    if (step.declared.writes_entities) changing.push_back(all_types);
    for (const detail::Revision& revision : step.revisions) {
        if (revision.access.write) changing.push_back(revision.access.type);
    }
}

/// Forward sweep: a pass may change if it is dirty now, or if it has an input from a pass that may change.
void GraphRuntime::mark_dirty(const World& world, std::uint32_t from) {
    state_->components_to_change.clear();
    for (std::uint32_t position = from; position < state_->step_count(); ++position) {
        const detail::Step& step = state_->steps[position];
        std::uint8_t need = step.writes_import ? certain : nothing;
        if (dirty(step, world)) {
            need = may_change | certain;
        } else {
            for (const detail::Input& input : step.inputs) {
                if ((state_->need[state_->versions[input.version].producer] & may_change) != 0) {
                    need |= may_change;
                }
            }
            if (follows_system(step)) need |= may_change;
        }
        if (step.writes_world && need != nothing) note_system(step);
        state_->need[position] = need;
    }
}

/// Backward sweep: if an input of a running pass is missing, the pass that produces it must run as well. A
/// run also overwrites what a later pass has put into the same object: a later version or another resource.
/// Returns true if that removes a version whose readers the sweep has already visited, so that another sweep
/// is needed.
bool GraphRuntime::mark_missing(std::uint32_t from) {
    bool again = false;
    for (std::uint32_t position = state_->step_count(); position-- > from;) {
        if (state_->need[position] == nothing) continue;
        const detail::Step& step = state_->steps[position];
        for (const detail::Input& input : step.inputs) {
            const detail::Version& version = state_->versions[input.version];
            state_->need[version.producer] |= version.present ? nothing : certain;
        }
        for (const detail::Output& output : step.outputs) {
            const std::uint32_t held = state_->holds[output.slot];
            if (held == none) continue;
            detail::Version& version = state_->versions[held];
            const bool lost = version.present & (version.producer > position);
            again |= lost & ((state_->need[version.producer] & certain) == 0);
            version.present &= !lost;
        }
    }
    return again;
}

void GraphRuntime::run_step(Execution& execution, bool changed) {
    detail::Step& step = state_->steps[execution.position_];
    execution.has_no_result_ = repeating_ || !step.has_run || !has_results(step);
    step.has_run = false;
    begin_outputs(step);
    if (pending_barriers_ != Barrier::none) backend_.barrier(pending_barriers_);
    pending_barriers_ = Barrier::none;
    begin_pass(execution.position_);
    {
        const detail::OnExit end([this] { backend_.end_pass(); });
        for (const detail::Bound& bound : step.bound) {
            bind(bound);
        }
        if (step.invoke) step.invoke(step.function, execution);
    }
    keep_record(step, execution.world_, changed);
}

bool GraphRuntime::has_results(const detail::Step& step) const {
    return std::ranges::all_of(
        step.outputs, [&](const detail::Output& output) { return state_->versions[output.version].present; });
}

/// Whether all outputs of the step, which has just run, count as changed for their readers.
bool GraphRuntime::renewed_results(const detail::Step& step) const {
    return std::ranges::all_of(step.outputs, [&](const detail::Output& output) {
        return state_->versions[output.version].stamp == clock_;
    });
}

/// Marks the outputs as not present while the pass runs, so that an exception cannot leave an incomplete
/// result that counts as valid.
void GraphRuntime::begin_outputs(const detail::Step& step) {
    for (const detail::Output& output : step.outputs) {
        if (output.swaps_history && !repeating_) turn_over(output.slot);
        if (output.value) state_->slots[output.slot].changed = state_->holds[output.slot] != output.version;
        release(output.slot);
    }
}

void GraphRuntime::release(std::uint32_t slot) {
    std::uint32_t& held = state_->holds[slot];
    if (held != none) state_->versions[held].present = false;
    held = none;
}

/// Swaps the two objects of a resource with a history: the current content becomes the history, and the
/// object of the old history will be written. Not a second time in a frame that several runs complete.
void GraphRuntime::turn_over(std::uint32_t slot) {
    if (state_->turned[slot] == 0) std::swap(state_->slots[slot], state_->slots[slot + 1]);
    state_->slots[slot].filled = false;
    state_->turned[slot] = 1;
}

void GraphRuntime::begin_pass(std::uint32_t position) {
    const detail::Step& step = state_->steps[position];
    if (step.targets.empty()) return backend_.begin_pass(step.name, position, nullptr);

    PassTargets targets;
    colours_.clear();
    for (const detail::Target& target : step.targets) {
        const detail::Slot& slot = state_->slots[target.slot];
        targets.size = slot.storage.texture.size;
        if (target.depth) {
            targets.depth = slot.object;
            targets.writes_depth = target.written;
        } else {
            colours_.push_back(slot.object);
        }
    }
    targets.colour = colours_;
    backend_.begin_pass(step.name, position, &targets);
}

void GraphRuntime::bind(const detail::Bound& bound) {
    const detail::Slot& slot = *slot_of(bound.resource);
    if (slot.storage.kind == ResourceKind::texture) {
        backend_.bind_texture(slot.object, slot.storage.texture, bound.binding);
    } else {
        backend_.bind_buffer(slot.object, bound.binding);
    }
}

/// Records a completed run. The outputs keep their stamps if the pass ran only to restore a result, with
/// unchanged inputs; a value keeps its stamp also if it was set to an equal value.
void GraphRuntime::keep_record(detail::Step& step, const World& world, bool changed) {
    for (detail::Input& input : step.inputs) {
        input.stamp = state_->versions[input.version].stamp;
    }
    for (detail::Revision& revision : step.revisions) {
        revision.tick = revision.access.revision(world);
    }
    ++clock_;
    for (const detail::Output& output : step.outputs) {
        detail::Version& version = state_->versions[output.version];
        release(output.slot);
        state_->holds[output.slot] = output.version;
        version.present = true;
        if (output.swaps_history) state_->slots[output.slot].filled = true;
        if (changed && (!output.value || state_->slots[output.slot].changed)) version.stamp = clock_;
    }
    if (verifying_) note_contents(step, changed);
    step.has_run = true;
}

void GraphRuntime::invalidate() {
    for (detail::Step& step : state_->steps) {
        step.has_run = false;
    }
}

}  // namespace candela
