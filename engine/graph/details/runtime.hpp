#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <candela/graph/execute.hpp>
#include "engine/graph/details/state.hpp"

namespace candela::detail {

/// The inside of a GraphRuntime: the current graph, what is kept between its frames, and the steps of one.
struct Running;

struct Runtime {
    explicit Runtime(Backend& of) : backend(of) {}

    void switch_to(CompiledGraph next);
    void create(Slot& slot, std::string_view name);
    void destroy(const Slot& slot);
    void destroy_objects();

    /// `writable`: the same world, or null if passes must not change it.
    const FrameRecord& run(const World& world, World* writable, Timing timing,
                           const std::function<bool()>& wanted);
    void verify(const World& world);
    void bind(const Bound& bound);

    /// Throws GraphError if there is no graph, or if the handle is of another one.
    [[nodiscard]] const Resource& resource(ResourceHandle handle) const;
    /// Null if only culled passes use the resource. Of an import it throws GraphError for another resource.
    [[nodiscard]] Slot* slot_of(std::uint32_t resource);
    [[nodiscard]] Slot* import_slot(ResourceHandle handle);
    void touch(ResourceHandle imported);
    [[nodiscard]] const void* content(ResourceHandle value) const;

    Backend& backend;
    std::optional<CompiledGraph> graph;
    State state;
    std::vector<Slot> free_pool;  // objects of the previous graph
    FrameRecord record;
    std::uint64_t frame = 0;
    std::vector<ObjectId> colours;  // scratch: the colour attachments of the running pass
    Stamp clock = 0;
    Barrier pending_barriers = Barrier::none;  // planned for passes that were skipped
    bool verifying = false;
    bool repeating = false;  // during verify

 private:
    void require_imports() const;
    void require_no_systems() const;
    [[nodiscard]] bool follows_system(const Step& step) const;
    void note_system(const Step& step);
    void mark(const World& world, std::uint32_t from);
    void mark_dirty(const World& world, std::uint32_t from);
    [[nodiscard]] bool mark_missing(std::uint32_t from);
    [[nodiscard]] bool is_held(const Step& step) const;
    [[nodiscard]] bool dirty(const Step& step, const World& world) const;
    void run_step(Running& pass, bool changed);
    void begin_outputs(const Step& step);
    void begin_pass(std::uint32_t position);
    void keep_record(Step& step, const World& world, bool changed);
    [[nodiscard]] bool has_results(const Step& step) const;
    [[nodiscard]] bool renewed_results(const Step& step) const;
    void note_contents(const Step& step, bool changed);
    [[nodiscard]] Content content_of(const Slot& slot) const;
    [[noreturn]] void report_difference(const Step& step, std::uint32_t version) const;
    void release(std::uint32_t slot);
    void provide_objects(const CompiledGraph& next, State& made, std::vector<Slot>& unused);
};

/// The pass that runs, behind its Execution.
struct Running {
    Runtime& runtime;
    const World& world;
    World* writable;                                // the same; null if passes must not change it
    const std::function<bool()>* wanted = nullptr;  // null: the host does not end frames
    std::uint32_t position = 0;
    bool has_result = false;  // of its last run, which it could keep

    [[nodiscard]] const Step& step() const { return runtime.state.steps[position]; }
    /// The slot of a resource that the pass has declared, as one that it writes if `write`. GraphError else.
    [[nodiscard]] Slot& slot(ResourceHandle handle, bool write) const;
    [[nodiscard]] Slot& reservable(ResourceHandle handle) const;
    void replace(ResourceHandle handle, const Storage& wanted_storage) const;
};

}  // namespace candela::detail
