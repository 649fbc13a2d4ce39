#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include <candela/api.hpp>
#include <candela/ecs/comparable.hpp>
#include <candela/ecs/world.hpp>
#include <candela/ecs/world_writer.hpp>
#include <candela/graph/backend.hpp>
#include <candela/graph/compile.hpp>
#include <candela/graph/errors.hpp>
#include <candela/graph/records.hpp>
#include <candela/graph/resources.hpp>

namespace candela {

class GraphRuntime;
struct GraphDescription;

namespace detail {

struct Running;
struct Runtime;

/// A value of any type, with how to compare it: null if the type has no operator==. Values are replaced,
/// never modified.
struct Value {
    std::shared_ptr<const void> content;
    bool (*equal)(const void*, const void*) = nullptr;

    [[nodiscard]] bool equals(const Value& other) const {
        return equal && other.content && equal(content.get(), other.content.get());
    }
};

template <class T>
[[nodiscard]] Value make_value(T content) {
    Value value{std::make_shared<const T>(std::move(content))};
    if constexpr (Comparable<T>) value.equal = equal_as<T>;
    return value;
}

}  // namespace detail

/// The interface of a running pass; valid only during its function. Every access to a resource that the pass
/// has not declared throws GraphError, which names the pass and the resource.
class CANDELA_API Execution {
 public:
    /// The world given to GraphRuntime::run, of which the pass may read and change the components that it has
    /// declared (Pass::read, Pass::write, Pass::write_entities). The rest is an UndeclaredAccess.
    [[nodiscard]] WorldWriter world() const;

    /// The back end's object that holds the resource in this frame. `reserve` may replace it.
    [[nodiscard]] ObjectId object(TextureHandle texture) const { return object_of(texture); }
    template <class T>
    [[nodiscard]] ObjectId object(BufferHandle<T> buffer) const {
        return object_of(buffer);
    }

    /// The current description, including changes by `reserve`; for imports, that given to `bind`.
    [[nodiscard]] const TextureDesc& desc(TextureHandle texture) const;
    /// Number of elements that the buffer can hold now: for imports as bound, else at least as many as
    /// declared or reserved.
    template <class T>
    [[nodiscard]] std::uint64_t count(BufferHandle<T> buffer) const {
        return count_of(buffer);
    }

    /// The reference is valid until a pass or the host sets the value again. Throws GraphError if the value
    /// was never set.
    template <class T>
    [[nodiscard]] const T& value(ValueHandle<T> value) const {
        return *static_cast<const T*>(content(value));
    }

    /// The content of a value that the pass updates. Null if it was never set, and during verification, where
    /// the pass has to compute its whole result. Valid until the value is set again. GraphError if the pass
    /// has not declared the update.
    template <class T>
    [[nodiscard]] const T* previous(ValueHandle<T> value) const {
        return static_cast<const T*>(previous_content(value));
    }

    /// Whether the result of the pass's last run is there, so that parts of it can stay. False in the first
    /// run, after GraphRuntime::invalidate, if the result was overwritten, or if the pass threw. Also false
    /// during verification, which thereby compares partial updates with a full one.
    [[nodiscard]] bool has_result() const;

    /// Whether an input (a version that the pass reads or modifies in place) has changed since the pass last
    /// ran. For passes that update only parts of their previous result. Always true without one: see
    /// has_result. Throws GraphError for anything that is not an input.
    [[nodiscard]] bool changed(ResourceHandle read) const;
    /// Whether any of several inputs has.
    [[nodiscard]] bool changed(std::span<const ResourceHandle> reads) const {
        return std::ranges::any_of(reads, [this](ResourceHandle read) { return changed(read); });
    }

    /// Whether the host may give the frame up while it runs: see GraphRuntime::run. A pass that takes long
    /// then does its work in parts, and calls `end_if_unwanted` between them.
    [[nodiscard]] bool may_end() const;
    /// Asks the host whether the frame is still wanted. If not, ends the pass and the frame by an exception,
    /// which GraphRuntime::run catches. The pass then counts as not having run, and has no result that it
    /// could keep.
    void end_if_unwanted() const;

    /// Sets a value that the pass writes. If T has operator== and the new content equals the old, the readers
    /// of the value do not run again because of it.
    template <class T>
    void set(ValueHandle<T> value, std::type_identity_t<T> content) {
        set_value(value, detail::make_value<T>(std::move(content)));
    }

    /// Ensures that a persistent buffer can hold `count` elements. The pass must write the buffer from
    /// version 0; GraphError otherwise. The buffer grows by at least half its size and never shrinks. Growing
    /// replaces the object, and its content is lost.
    template <class T>
    void reserve(BufferHandle<T> buffer, std::uint64_t count) {
        reserve_buffer(buffer, count);
    }
    /// Changes the description of a persistent texture. The pass must write the texture from version 0, and
    /// not as colour_target or depth_target, and a texture must be able to have it (see why_impossible);
    /// GraphError otherwise. A description that differs from the current one replaces the object, and its
    /// content is lost.
    void reserve(TextureHandle texture, const TextureDesc& desc);

 private:
    friend detail::Runtime;
    explicit Execution(const detail::Running& pass) : pass_(pass) {}

    [[nodiscard]] ObjectId object_of(ResourceHandle resource) const;
    [[nodiscard]] std::uint64_t count_of(ResourceHandle buffer) const;
    void set_value(ResourceHandle value, detail::Value content);
    [[nodiscard]] const void* content(ResourceHandle value) const;
    [[nodiscard]] const void* previous_content(ResourceHandle value) const;
    void reserve_buffer(ResourceHandle buffer, std::uint64_t count);

    const detail::Running& pass_;
};

/// Runs a compiled graph, frame by frame, and can switch to another graph. Owns what is kept between frames:
/// the GPU objects of the graph's resources (except imported ones), the values, and the change stamps that
/// decide whether a pass must run again. Not thread-safe.
///
/// In each frame only some passes run. A pass runs if
/// - it has not run yet,
/// - one of its inputs has changed since it last ran: a resource version that it reads or modifies in place,
///   a component pool or an imported resource,
/// - it has a side effect or writes an imported resource, or
/// - a pass that runs needs one of its results, and that result has been overwritten.
/// Otherwise its previous results stay in use.
class CANDELA_API GraphRuntime {
 public:
    /// Keeps a reference: the back end must outlive the runtime.
    explicit GraphRuntime(Backend& backend);
    /// For graphs whose passes only change the world and set values. `switch_to` throws GraphError for one
    /// that has textures or buffers of its own.
    GraphRuntime();
    GraphRuntime(const GraphRuntime&) = delete;
    GraphRuntime& operator=(const GraphRuntime&) = delete;
    /// Destroys every object that the runtime has created, not the imported ones.
    ~GraphRuntime();

    /// Switches to another graph and takes ownership of it. Handles of the old graph become invalid.
    ///
    /// Persistent resources and values that both graphs declare with the same kind, key and description keep
    /// their content (ScopeDesc::key_ending: keys are names unless something else is asked for). A pass
    /// that both graphs declare with the same key, accesses and parameters stays up to date: it runs again
    /// only to provide results that were not kept, such as transients that were overwritten. Imported
    /// textures and buffers must be bound again; imported values stay set.
    ///
    /// Objects that the new graph does not use go to a free pool. The next call of `switch_to` reuses what it
    /// can from there and destroys the rest. If the back end throws, the exception passes through and the
    /// runtime keeps the old graph, unchanged.
    void switch_to(CompiledGraph graph);

    /// The current graph, or null before the first `switch_to`. Valid until the next `switch_to`.
    [[nodiscard]] const CompiledGraph* graph() const;

    /// Sets an imported value, which stays until it is set again. If T has operator== and the new value
    /// equals the old, the readers do not run again because of it. Does nothing if only culled passes use the
    /// value. GraphError if there is no graph, or if the handle is of another graph or not imported.
    template <class T>
    void set(ValueHandle<T> imported, std::type_identity_t<T> value) {
        set_value(imported, detail::make_value<T>(std::move(value)));
    }

    /// Provides the object of an imported texture or buffer. The host keeps ownership, and the object must
    /// stay alive while it is bound. The binding stays until the next `bind` or `switch_to`. Each call counts
    /// as new content, so the readers run again. If passes read the host's content and later passes overwrite
    /// it, call `bind` before each run. `object` may be 0 for the window's framebuffer. Does nothing if only
    /// culled passes use the resource. Throws GraphError like `set`.
    void bind(TextureHandle imported, ObjectId object, const TextureDesc& desc) {
        bind(imported, object, desc, {});
    }
    template <class T>
    void bind(BufferHandle<T> imported, ObjectId object, std::uint64_t count) {
        bind(imported, object, {}, {count, sizeof(T)});
    }

    /// Runs one frame and returns which passes ran. The record is valid until the next run. `timing` turns on
    /// PassRecord::cpu_ms. Throws GraphError if there is no graph, or if an imported resource that a kept
    /// pass uses was not bound or set. Exceptions from a pass pass through: that pass then counts as not
    /// having run, and the next `run` runs it again; passes that had completed keep their results.
    ///
    /// `wanted` is asked before each pass that runs, and by passes between parts of their work. If it returns
    /// false, the run ends there, and the record is not `complete`. The next run goes on with the same frame:
    /// it runs the passes that are left, and those whose inputs have changed meanwhile.
    ///
    /// Changes of the world, and another world in its place, are detected by the revisions of the component
    /// pools. With a const world, a graph whose passes change components or entities is a GraphError.
    const FrameRecord& run(World& world, Timing timing = Timing::off,
                           const std::function<bool()>& wanted = {});
    const FrameRecord& run(const World& world, Timing timing = Timing::off,
                           const std::function<bool()>& wanted = {});

    /// Turns recording for `verify` on or off; initially off. While on, the outputs of a pass are read back
    /// (as digests) each time that it runs; while off, there is no cost.
    void set_verification(bool on);
    [[nodiscard]] bool verifies() const;
    /// Checks for undeclared inputs: runs the passes of the last frame again, including those that did not
    /// run in it, and compares what they write with what they wrote before. Textures and buffers are compared
    /// by the back end's digests, values with operator== where their type has it.
    ///
    /// Throws GraphError if there is no graph or verification is off, and at the first difference. That error
    /// names the pass, the first one in execution order, and the resource: the pass depends on something that
    /// it did not declare, or is not deterministic. The pass then counts as not having run.
    ///
    /// Call `verify` after a complete `run`, with the same world, unchanged. Each pass reads what the passes
    /// before it have just written again, so the check also covers versions that later passes modify in place
    /// and transients whose object another resource uses later in the frame. Not run again are
    /// - passes with side effects and passes that write imports (they run in every frame),
    /// - passes that change the world,
    /// - passes that have declared Pass::keeps_state,
    /// - passes that would overwrite a result of one of those, and
    /// - passes with an input, components included, that has been overwritten and that only one of those
    ///   could write again.
    ///
    /// `reserve` finds the capacity that it made before. PassRecord::verified is set; the rest of the frame's
    /// record stays. Transients that share objects may hold other content afterwards than without `verify`,
    /// so the next frame may have to run other passes to restore their results.
    ///
    /// While verification is on, `run` makes the same comparison, with the same GraphError, for a pass that
    /// it runs only to restore an overwritten result.
    void verify(const World& world);

    /// Makes all passes run in the next frame.
    void invalidate();

    /// A value of the current graph; the reference is valid until the value is set again or `switch_to` is
    /// called. GraphError if it was never set.
    template <class T>
    [[nodiscard]] const T& value(ValueHandle<T> value) const {
        return *static_cast<const T*>(content(value));
    }
    /// The object that holds a resource of the current graph; 0 if only culled passes use it. A transient's
    /// content is valid only until another resource uses the same object.
    [[nodiscard]] ObjectId object(ResourceHandle resource) const;
    [[nodiscard]] MemoryUse memory() const;
    /// As candela::describe of the current graph, but with the sizes that textures and buffers have now:
    /// those of imports as bound, of others as reserved. GraphError if there is no graph.
    [[nodiscard]] GraphDescription describe() const;

 private:
    void bind(ResourceHandle imported, ObjectId object, const TextureDesc& texture, const BufferDesc& buffer);
    void set_value(ResourceHandle imported, detail::Value value);
    [[nodiscard]] const void* content(ResourceHandle value) const;

    std::unique_ptr<detail::Runtime> runtime_;
};

}  // namespace candela
