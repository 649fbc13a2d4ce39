#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/ecs/world.hpp"
#include "engine/graph/backend.hpp"
#include "engine/graph/compile.hpp"
#include "engine/graph/details/state.hpp"
#include "engine/graph/fault.hpp"
#include "engine/graph/resources.hpp"

namespace candela {

struct PassRecord {
    std::string_view name;  ///< lasts until the next graph is adopted
    bool ran = false;
    bool verified = false;  ///< ran again after the frame, with the same result
    double cpu_ms = 0.0;    ///< milliseconds on the CPU; 0 without timing
};

struct FrameRecord {
    std::uint64_t frame = 0;         ///< counts runs from 0
    std::vector<PassRecord> passes;  ///< kept passes, in the order of the graph
};

/// Bytes of storage that a runtime holds, without what a driver adds.
struct MemoryUse {
    std::uint64_t texture_bytes = 0;
    std::uint64_t buffer_bytes = 0;
    std::uint64_t shared_by_aliasing_bytes =
        0;                          ///< what transients would need in addition if they shared nothing
    std::uint64_t spare_bytes = 0;  ///< of the above, kept for a return to the previous graph
};

enum class Timing : bool { off, on };

class GraphRuntime;

/// What a running pass may do. Access to what the pass did not declare throws GraphError naming both.
class Execution {
 public:
    [[nodiscard]] const World& world() const { return world_; }

    [[nodiscard]] ObjectId object(TextureHandle texture) const { return slot(texture, false).object; }
    template <class T>
    [[nodiscard]] ObjectId object(BufferHandle<T> buffer) const {
        return slot(buffer, false).object;
    }

    /// As it is now: after `reserve`, and as bound by the host.
    [[nodiscard]] const TextureDesc& desc(TextureHandle texture) const {
        return slot(texture, false).texture;
    }
    /// Elements that the buffer has room for now; at least what was declared or reserved.
    template <class T>
    [[nodiscard]] std::uint64_t count(BufferHandle<T> buffer) const {
        return slot(buffer, false).buffer.count;
    }

    /// Lasts until a pass or the host sets the value anew. GraphError if it was never set.
    template <class T>
    [[nodiscard]] const T& value(ValueHandle<T> value) const {
        return *static_cast<const T*>(content(value));
    }

    /// What a value that the pass reads or writes holds now, null if it was never set: how a pass comes by
    /// its own last result.
    template <class T>
    [[nodiscard]] const T* find(ValueHandle<T> value) const {
        return static_cast<const T*>(slot(value, false).value.get());
    }

    /// Whether what the pass reads has changed since it ran last, for passes that keep parts of their last
    /// result. Everything has where there is no last result to keep: in the first run, after
    /// GraphRuntime::invalidate, where the result was overwritten or the pass threw, and in verification,
    /// which thus compares parts with the whole.
    [[nodiscard]] bool changed(ResourceHandle read) const;

    /// Sets a value that the pass writes. One that equals the present (where T compares) leaves its readers
    /// clean.
    template <class T>
    void set(ValueHandle<T> value, std::type_identity_t<T> content);

    /// Makes room for `count` elements in a persistent buffer that the pass writes from version 0. Grows by
    /// half at least, and never shrinks; growing loses the content.
    template <class T>
    void reserve(BufferHandle<T> buffer, std::uint64_t count) {
        reserve_buffer(buffer, count);
    }
    /// Gives a persistent texture that the pass writes from version 0 this description; another one loses the
    /// content.
    void reserve(TextureHandle texture, const TextureDesc& desc);

    /// Whether a history handle has content of the resource's present description, with no cut since.
    [[nodiscard]] bool history_valid(TextureHandle history) const { return valid(history); }
    template <class T>
    [[nodiscard]] bool history_valid(BufferHandle<T> history) const {
        return valid(history);
    }

 private:
    friend GraphRuntime;
    Execution(GraphRuntime& runtime, const World& world) : runtime_(runtime), world_(world) {}

    [[nodiscard]] detail::Slot& slot(ResourceHandle handle, bool write) const;
    [[nodiscard]] const void* content(ResourceHandle value) const;
    [[nodiscard]] bool valid(ResourceHandle history) const;
    void reserve_buffer(ResourceHandle buffer, std::uint64_t count);
    [[nodiscard]] detail::Slot& reservable(ResourceHandle handle) const;

    GraphRuntime& runtime_;
    const World& world_;
    std::uint32_t position_ = 0;
    bool anew_ = true;  // the running pass has no last result to keep
};

/// Runs compiled graphs, one at a time, and owns what must outlast a frame: the objects of the graph's
/// resources, the values, and for each pass and version the stamps that tell whether a pass must run again.
///
/// A pass runs when it has not yet run, when a stamp of its inputs (what it reads or changes, component
/// pools, imported values) is not the one of its last run, when it has a side effect or writes an imported
/// resource, and when a pass that runs needs a result of it that has been overwritten. Not synchronised.
class GraphRuntime {
 public:
    /// The back end must outlive the runtime.
    explicit GraphRuntime(Backend& backend) : backend_(backend) {}
    GraphRuntime(const GraphRuntime&) = delete;
    GraphRuntime& operator=(const GraphRuntime&) = delete;
    /// Destroys every object that it made.
    ~GraphRuntime();

    /// Replaces the graph. Persistent resources and values that both graphs declare alike stay, and so do the
    /// records of passes with the same name, parameters and inputs: what was clean stays clean. Objects that
    /// the new graph does not need are spared until the graph after it, or `trim`. If the back end throws,
    /// nothing has changed. Imported textures and buffers must be bound anew.
    void adopt(CompiledGraph graph);

    /// The adopted graph, or null.
    [[nodiscard]] const CompiledGraph* graph() const { return graph_ ? &*graph_ : nullptr; }

    /// Sets an imported value; it stays until set again, and an equal one (where T compares) leaves its
    /// readers clean.
    template <class T>
    void set(ValueHandle<T> imported, std::type_identity_t<T> value);

    /// Gives an imported texture or buffer its object, which the host keeps. Stays until bound again; each
    /// call counts as new content. Bind before each run what the host fills, passes read and later passes
    /// write.
    void bind(TextureHandle imported, ObjectId object, const TextureDesc& desc) {
        bind(imported, object, desc, {});
    }
    template <class T>
    void bind(BufferHandle<T> imported, ObjectId object, std::uint64_t count) {
        bind(imported, object, {}, {count, sizeof(T)});
    }

    /// Runs one frame and tells which passes ran. The record lasts until the next run. GraphError if nothing
    /// is adopted or an import is missing. What a pass throws passes through: that pass then counts as not
    /// having run, and the next run takes up from there.
    ///
    /// A world is known by its address and its pools' revisions. Call `invalidate` after replacing the
    /// content of the world at one address by that of another.
    const FrameRecord& run(const World& world, Timing timing = Timing::off);

    /// Whether frames are noted for `verify`, and can be: off at first. While it is on, the content of what a
    /// pass writes is read back each time that it runs; while it is off, it costs nothing.
    void set_verification(bool on);
    [[nodiscard]] bool verifies() const { return verifying_; }
    /// Runs the last frame's passes again, clean ones too, and compares what they write with what they wrote
    /// when they ran before: textures and buffers by the back end's digests of their content, values where
    /// their type compares. GraphError names the first pass, in the order of the graph, and the resource that
    /// differ: the pass depends on what it did not declare, or on chance. It then counts as not having run.
    ///
    /// Call it after `run`, with the same world, unchanged. Each pass reads what the passes before it have
    /// just made again, so that versions which later passes have changed in place, and transients whose
    /// object has another user by then, are compared like all others. Not run again are passes with side
    /// effects and those that write imports (they have run in this frame), passes that remember (a history,
    /// or their own last result), passes that would overwrite what one of those has made, and passes that
    /// lack what only those could bring back. `reserve` finds the room that it made before. A pass that a
    /// frame runs only to bring back what another lacks is compared in that frame already.
    /// The frame's record stays as it is, but for `PassRecord::verified`; of transients that share objects
    /// others may be there for the next frame than without verification.
    void verify(const World& world);

    /// All passes run in the next frame.
    void invalidate();
    /// The next frame finds no valid history: for camera cuts.
    void invalidate_history() { cut_ = true; }
    /// Destroys the objects spared for a return to the previous graph.
    void trim();

    /// A value of the adopted graph. GraphError if it was never set.
    template <class T>
    [[nodiscard]] const T& value(ValueHandle<T> value) const {
        return *static_cast<const T*>(content(value));
    }
    /// The object that holds a resource of the adopted graph; 0 if no kept pass uses it. A transient's
    /// content lasts only until its object's next user.
    [[nodiscard]] ObjectId object(ResourceHandle resource) const;
    [[nodiscard]] MemoryUse memory() const;

 private:
    friend Execution;
    void require_imports() const;
    void notice_world(const World& world);
    void mark(const World& world, std::uint32_t from);
    void mark_dirty(const World& world, std::uint32_t from);
    [[nodiscard]] bool mark_missing(std::uint32_t from);
    [[nodiscard]] bool dirty(const detail::Step& step, const World& world) const;
    void run_step(Execution& execution, bool changed);
    void begin_outputs(const detail::Step& step);
    void begin_pass(std::uint32_t position);
    void keep_record(detail::Step& step, const World& world, bool changed);
    [[nodiscard]] bool has_results(const detail::Step& step) const;
    [[nodiscard]] bool renewed_results(const detail::Step& step) const;
    void note_contents(const detail::Step& step, bool changed);
    [[nodiscard]] detail::Content content_of(const detail::Slot& slot) const;
    [[noreturn]] void report_difference(const detail::Step& step, std::uint32_t version) const;
    void release(std::uint32_t slot);
    void turn_over(std::uint32_t slot);

    void provide_objects(const CompiledGraph& graph, detail::State& state, std::vector<detail::Slot>& stock);
    void create(detail::Slot& slot, std::string_view name);
    void destroy(const detail::Slot& slot);

    [[nodiscard]] const detail::Resource& resource(ResourceHandle handle) const;
    [[nodiscard]] detail::Slot* slot_of(std::uint32_t resource);
    [[nodiscard]] detail::Slot* import_slot(ResourceHandle handle);
    void bind(ResourceHandle imported, ObjectId object, const TextureDesc& texture, const BufferDesc& buffer);
    void touch(ResourceHandle imported);
    [[nodiscard]] const void* content(ResourceHandle value) const;

    Backend& backend_;
    std::optional<CompiledGraph> graph_;
    detail::State state_;
    std::vector<detail::Slot> spare_;  // objects of the graph before
    FrameRecord record_;
    std::uint64_t frame_ = 0;
    std::vector<ObjectId> colours_;  // scratch: the attachments of the running pass
    const World* world_ = nullptr;   // of the last run
    detail::Stamp clock_ = 0;
    Barrier carried_ = Barrier::none;  // owed by passes that were skipped
    bool cut_ = false;
    bool verifying_ = false;
    bool repeating_ = false;  // within verify
};

template <class T>
void Execution::set(ValueHandle<T> value, std::type_identity_t<T> content) {
    detail::Slot& target = slot(value, true);
    if (detail::holds_equal<T>(target, content)) {
        return;
    }
    detail::put_value<T>(target, std::move(content));
    target.changed = true;
}

template <class T>
void GraphRuntime::set(ValueHandle<T> imported, std::type_identity_t<T> value) {
    detail::Slot* const target = import_slot(imported);
    if (!target || detail::holds_equal<T>(*target, value)) {
        return;
    }
    detail::put_value<T>(*target, std::move(value));
    touch(imported);
}

}  // namespace candela
