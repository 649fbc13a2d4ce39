#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/graph/execute.hpp>
#include "engine/graph/details/plan.hpp"

namespace candela::detail {

/// A version gets a new stamp from a counter each time its content changes: equal stamps mean equal content.
using Stamp = std::uint64_t;

/// The current state of one object: a texture, a buffer or a value.
struct Slot {
    Storage storage;       // of an import, as bound; `reserve` may have changed the declared one
    bool owned = false;    // created by the runtime; false for imports and for values
    bool changed = false;  // a value: the running pass may have changed the content of its version
    bool bound = false;    // an import that the host has bound
    ObjectId object = 0;
    Value value;
    std::string key;  // of a persistent texture or buffer; empty for all others
    Storage declared;
};

/// One version of one resource.
struct Version {
    Stamp stamp = 0;
    std::uint32_t producer = 0;  // the step that makes it; the number of steps if no step does
    bool present = true;         // in its slot, and not about to be overwritten in this frame
};

/// The content of a version when it was last written, for verification. The value is shared, not copied.
struct Content {
    bool known = false;
    bool drifted = false;  // may have changed without a new stamp, so its readers have not seen the change
    std::uint64_t digest = 0;
    Value value;
};

struct Output {
    std::uint32_t version;  // id
    std::uint32_t slot;
    bool value;  // a CPU value, not a texture or buffer
};

/// A type of component that a pass reads or writes.
struct Revision {
    ComponentAccess access;
    Tick tick = 0;  // of the type's components, after the pass's last run
};

struct Target {
    std::uint32_t slot;
    bool depth;
    bool written;
};

/// What the back end binds for a pass.
struct Bound {
    std::uint32_t resource;
    Binding binding;
};

/// A version that a pass reads or modifies in place.
struct Input {
    std::uint32_t version;  // id
    Stamp stamp = 0;        // at the pass's last run
};

/// A kept pass.
struct Step {
    void (*invoke)(void*, Execution&) = nullptr;
    void* function = nullptr;
    std::string_view name;
    std::string_view key;
    std::vector<Input> inputs{};
    std::vector<Output> outputs{};
    std::vector<Revision> revisions{};
    DeclaredComponents declared{};
    std::vector<Target> targets{};
    std::vector<Bound> bound{};
    Barrier barrier = Barrier::none;
    bool side_effect = false;
    bool writes_import = false;
    bool keeps_state = false;
    bool writes_world = false;     // components or entities
    std::uint32_t held_by = none;  // slot of the value that holds the pass: ScopeDesc::held
    bool is_held = false;          // in this frame
    bool has_run = false;
};

/// The steps of one graph and the state kept between its frames. Slot i belongs to object i of the plan.
struct State {
    std::vector<Step> steps;        // in execution order
    std::vector<Version> versions;  // per version id
    std::vector<Slot> slots;
    std::vector<std::uint32_t> holds;    // per slot: the version that was written to it last, or none
    std::vector<std::uint32_t> imports;  // resources that the host must provide
    std::vector<std::size_t> components_to_change;  // scratch: types that steps may change in this frame
    std::vector<std::uint8_t> need;  // scratch: per step, and one more for versions that no step makes
    std::vector<Content> contents;   // per version id; empty without verification

    [[nodiscard]] std::uint32_t step_count() const { return static_cast<std::uint32_t>(steps.size()); }
};

/// Calls a function at the end of its own lifetime.
template <class F>
class OnExit {
 public:
    explicit OnExit(F function) : function_(std::move(function)) {}
    OnExit(const OnExit&) = delete;
    OnExit& operator=(const OnExit&) = delete;
    ~OnExit() { function_(); }

 private:
    F function_;
};

/// The state of a graph that has not run. The slots have no objects yet.
[[nodiscard]] State make_state(const CompiledGraph& graph);

/// Takes over from `before` what both graphs declare in the same way: slots (objects and values), stamps, and
/// the records of passes. Returns, for each slot of `before`, the slot that has taken it over, or none.
std::vector<std::uint32_t> inherit(const CompiledGraph& graph, State& state,
                                   const CompiledGraph& graph_before, const State& before);

}  // namespace candela::detail
