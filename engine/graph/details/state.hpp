#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/ecs/world.hpp"
#include "engine/graph/backend.hpp"
#include "engine/graph/compile.hpp"
#include "engine/graph/resources.hpp"

namespace candela {

class Execution;

namespace detail {

/// Drawn from a counter each time that content changes: equal stamps mean equal content.
using Stamp = std::uint64_t;

/// A texture, a buffer or a value as it is now.
struct Slot {
    ResourceKind kind = ResourceKind::value;
    bool owned = false;    // by the runtime; false for what is imported, and for values
    bool changed = false;  // the running pass has set another value
    bool filled = false;   // written since it was made, or bound by the host
    ObjectId object = 0;
    TextureDesc texture;
    BufferDesc buffer;
    std::shared_ptr<void> value;
    bool (*equal)(const void*, const void*) = nullptr;  // of values of its type; null if they do not compare
    std::string
        kept_as;  // of what outlasts the frame: its name and what was declared; it may have grown since
};

template <class T>
bool holds_equal(const Slot& slot, const T& content) {
    if constexpr (std::equality_comparable<T>) {
        return slot.value && *static_cast<const T*>(slot.value.get()) == content;
    } else {
        return false;
    }
}

template <class T>
void put_value(Slot& slot, T content) {
    slot.value = std::make_shared<T>(std::move(content));
    if constexpr (std::equality_comparable<T>) {
        slot.equal = [](const void* a, const void* b) {
            return *static_cast<const T*>(a) == *static_cast<const T*>(b);
        };
    }
}

/// One version of one resource.
struct Version {
    Stamp stamp = 0;
    std::uint32_t producer = 0;  // the step that makes it; the number of steps for what comes from outside
    bool present = true;         // in its slot, and not about to be overwritten
};

/// What a version held when it was last made, for verification. The value is shared, not copied: values are
/// replaced, never changed.
struct Content {
    bool known = false;
    bool drifted = false;  // made again differently by a pass that remembers: its readers have not seen it
    std::uint64_t digest = 0;
    std::shared_ptr<void> value;
};

struct Output {
    std::uint32_t version;  // id
    std::uint32_t slot;
    bool value;       // of the CPU
    bool turns_over;  // begins a new content of a resource with a history, whose past is in the next slot
};

struct Revision {
    Tick (*of)(const World&);
    Tick tick = 0;  // at the pass's last run
};

struct Target {
    std::uint32_t slot;
    bool depth;
};

/// A pass in the order of the graph, ready to run. Its lists end where the next step's begin.
struct Step {
    void (*invoke)(void*, Execution&) = nullptr;
    void* function = nullptr;
    std::string_view name;
    std::uint32_t first_input = 0;
    std::uint32_t first_output = 0;
    std::uint32_t first_revision = 0;
    std::uint32_t first_target = 0;
    Barrier barrier = Barrier::none;
    bool side_effect = false;
    bool writes_import = false;
    bool remembers = false;
    bool has_run = false;
};

/// What a frame walks and what it remembers, for one graph. A slot is an object of the plan.
struct State {
    std::vector<Step> steps;            // and one more, which ends the lists
    std::vector<std::uint32_t> inputs;  // version ids of what passes read, or change
    std::vector<Stamp> input_stamps;    // at the pass's last run
    std::vector<Output> outputs;
    std::vector<Revision> revisions;
    std::vector<Target> targets;
    std::vector<Version> versions;  // by id
    std::vector<Slot> slots;
    std::vector<std::uint32_t> holds;    // by slot: the version that was written to it last, or none
    std::vector<std::uint8_t> turned;    // by slot: has turned over in this frame
    std::vector<std::uint32_t> imports;  // resources that the host must provide
    std::vector<std::uint8_t> need;      // by step, and one more: scratch of a frame
    std::vector<Content> contents;       // by version id; empty without verification

    [[nodiscard]] std::uint32_t step_count() const { return static_cast<std::uint32_t>(steps.size()) - 1; }
};

/// The state of a graph that has not run, whose slots have no objects yet.
[[nodiscard]] State make_state(const CompiledGraph& graph);

/// By step: whether verification may run it again after a frame. Left out are passes with side effects or
/// imports to write, passes that remember, those that lack something which only a pass left out could make
/// again, and those that would overwrite what a pass left out has made.
[[nodiscard]] std::vector<std::uint8_t> repeatable_steps(const State& state);

/// Takes over from `before` what both graphs declare alike: slots (objects and values), stamps, and the
/// records of passes. Gives for each of `before`'s slots whether it was taken.
std::vector<std::uint8_t> inherit(const CompiledGraph& graph, State& state, const CompiledGraph& graph_before,
                                  const State& before);

}  // namespace detail
}  // namespace candela
