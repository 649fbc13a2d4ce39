#pragma once

#include <any>
#include <concepts>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeindex>
#include <utility>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/comparable.hpp>
#include <candela/ecs/world.hpp>
#include <candela/graph/resources.hpp>

namespace candela {

class CompiledGraph;
class Execution;  // the interface of a running pass: execute.hpp
class FrameGraph;
struct CompileResult;

namespace detail {

struct Declaration;

/// That a pass reads or writes all components of a type.
struct ComponentAccess {
    std::size_t type;  // component_index
    std::string_view name;
    Tick (*revision)(const World&);
    bool write;
    bool operator==(const ComponentAccess&) const = default;
};

/// Compares two objects of type T.
template <class T>
[[nodiscard]] bool equal_as(const void* a, const void* b) {
    return *static_cast<const T*>(a) == *static_cast<const T*>(b);
}

/// Owns objects of any type, and text, until it is destroyed. Their addresses do not change.
class Arena {
 public:
    Arena() = default;
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;
    ~Arena() {
        for (const Owned& owned : owned_) {
            owned.destroy(owned.object);
        }
    }

    template <class T>
    T* store(T value) {
        constexpr bool is_owned = !std::is_trivially_destructible_v<T>;
        if constexpr (is_owned) make_room();
        T* const object = ::new (memory_.allocate(sizeof(T), alignof(T))) T(std::move(value));
        if constexpr (is_owned) {
            owned_.push_back({object, [](void* stored) { static_cast<T*>(stored)->~T(); }});
        }
        return object;
    }

    [[nodiscard]] std::string_view store_text(std::string_view text) {
        char* const copy = static_cast<char*>(memory_.allocate(text.size(), 1));
        return {copy, text.copy(copy, text.size())};
    }

 private:
    struct Owned {
        void* object;
        void (*destroy)(void*);
    };

    /// Makes room for the record of an object before the object is made, which would be lost if that failed.
    void make_room() {
        if (owned_.size() == owned_.capacity()) owned_.reserve(2 * owned_.size() + 16);
    }

    std::pmr::monotonic_buffer_resource memory_;
    std::vector<Owned> owned_;
};

}  // namespace detail

/// Declares one pass: what it reads, what it writes and the function that it runs. The object exists only
/// during the call of `FrameGraph::add`.
///
/// A handle names one version of a resource. Each write returns the handle of the next version, and passes
/// declared after the write must use that handle, so that handles alone order the passes. A write to version
/// 0 does not depend on earlier content: the pass must fill the resource. A write to version 1 or later
/// modifies the content in place: the pass depends on that content and does not declare a read of it. Two
/// passes may not write the same version.
///
/// Version 0 of a persistent resource is its content at the end of the previous frame. `write` discards it,
/// `update` modifies it in place.
///
/// No member throws on misuse; `compile` reports the errors.
class CANDELA_API Pass {
 public:
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;
    ~Pass();

    /// The pass reads this version of the resource, and runs again when it changes. The version must be the
    /// newest one, and it must have been written by a pass or be imported.
    /// With a place, as in `pass.read(lights, {Usage::storage, 2})`, the graph binds it there for the pass.
    void read(TextureHandle texture, Binding binding) {
        declare_read(texture, ResourceKind::texture, binding);
    }
    template <class T>
    void read(BufferHandle<T> buffer, Binding binding) {
        declare_read(buffer, ResourceKind::buffer, binding);
    }
    template <class T>
    void read(ValueHandle<T> value) {
        declare_read(value, ResourceKind::value, {});
    }

    /// The pass reads components of type C from the world (Execution::world). It runs again when anybody but
    /// itself has added, changed or removed a C.
    template <Component C>
    void read() {
        declare_component<C>(false);
    }

    /// The pass is a system: it adds, changes or removes components of type C (Execution::world). It is never
    /// culled. It runs again when anybody but itself has changed a C, so that what it writes stays; that has
    /// to follow from what the pass reads, or running it twice would differ from running it once.
    ///
    /// Of passes that read or write the same type, those declared later see the changes of those declared
    /// earlier in the same frame. If the order of two passes that write the same type matters, the later one
    /// should also read it, or say `after`: see find_ambiguities.
    template <Component C>
    void write() {
        declare_component<C>(true);
    }

    /// The pass creates or destroys entities. For the order of passes, that counts as a write of every type
    /// of component.
    void write_entities();

    /// The pass runs after another one, which has been declared before it and which it otherwise does not
    /// depend on. `pass`: its name, with the endings of scopes.
    void after(std::string_view pass);

    /// The pass writes the resource. Returns the handle of the version that it produces. Imported values
    /// cannot be written.
    [[nodiscard]] TextureHandle write(TextureHandle texture, Binding binding) {
        return {declare_write(texture, ResourceKind::texture, binding)};
    }
    template <class T>
    [[nodiscard]] BufferHandle<T> write(BufferHandle<T> buffer, Binding binding) {
        return {declare_write(buffer, ResourceKind::buffer, binding)};
    }
    template <class T>
    [[nodiscard]] ValueHandle<T> write(ValueHandle<T> value) {
        return {declare_write(value, ResourceKind::value, {})};
    }

    /// The pass writes version 0 of a persistent resource, but may leave parts of the previous frame's
    /// content as they are (see Execution::changed and Execution::previous). Returns the handle of version 1.
    [[nodiscard]] TextureHandle update(TextureHandle texture, Binding binding) {
        return {declare_update(texture, ResourceKind::texture, binding)};
    }
    template <class T>
    [[nodiscard]] BufferHandle<T> update(BufferHandle<T> buffer, Binding binding) {
        return {declare_update(buffer, ResourceKind::buffer, binding)};
    }
    template <class T>
    [[nodiscard]] ValueHandle<T> update(ValueHandle<T> value) {
        return {declare_update(value, ResourceKind::value, {})};
    }

    /// A constant on which the pass's result depends, for example one that the function captures.
    /// `GraphRuntime::switch_to` keeps the results of a pass only if its parameters are equal in both graphs.
    /// The graph owns the copy.
    template <Comparable T>
    void parameter(T value) {
        declare_parameter(typeid(T), arena_.store(std::move(value)), detail::equal_as<T>);
    }

    /// The pass is never culled and runs in every frame.
    void side_effect();

    /// The result depends on what the pass updates: computed again from the same inputs, it may be different.
    /// Only verification uses this: it does not run such passes again.
    void keeps_state();

    /// A value of the host's about the pass, such as the workload that its time depends on. The graph does
    /// not use it, and returns it in PassRecord::note. Replaces an earlier note.
    void note(std::any what);

    /// Sets the function that the pass executes: `void(Execution&)`. The graph owns it. A second call
    /// replaces the function; a pass without one only has its barriers issued and its attachments bound.
    template <std::invocable<Execution&> F>
    void run(F function) {
        set_function(arena_.store(std::move(function)),
                     [](void* object, Execution& execution) { (*static_cast<F*>(object))(execution); });
    }

 private:
    friend FrameGraph;
    Pass(detail::Declaration& declared, std::string_view name);

    void declare_read(ResourceHandle resource, ResourceKind kind, Binding binding);
    template <Component C>
    void declare_component(bool write) {
        declare_component({component_index<C>(), component_name<C>(),
                           [](const World& world) { return world.revision<C>(); }, write});
    }
    void declare_component(const detail::ComponentAccess& access);
    [[nodiscard]] ResourceHandle declare_write(ResourceHandle resource, ResourceKind kind, Binding binding);
    [[nodiscard]] ResourceHandle declare_update(ResourceHandle resource, ResourceKind kind, Binding binding);
    void declare_parameter(std::type_index type, const void* value, bool (*equal)(const void*, const void*));
    void set_function(void* function, void (*invoke)(void*, Execution&));

    detail::Declaration& declared_;
    detail::Arena& arena_;
};

/// What FrameGraph::find_texture returns. `desc` is as declared; a pass may reserve another one. `note` is
/// null without one, and valid until resources or notes are added.
struct FoundTexture {
    TextureHandle handle;
    TextureDesc desc;
    const std::any* note = nullptr;  ///< see FrameGraph::note
};

/// What FrameGraph::find_buffer returns.
struct FoundBuffer {
    BufferHandle<void> handle;
    std::uint32_t stride = 1;                ///< bytes from one element to the next
    std::type_index element = typeid(void);  ///< the type of its elements
    const std::any* note = nullptr;          ///< as in FoundTexture
};

/// The effect of a scope on the passes and resources that are declared in it.
struct ScopeDesc {
    /// Is put behind the names of passes and resources, and before the ending of the scope around this one.
    /// So a graph can contain the same passes several times, for example once for each view.
    std::string_view name_ending{};
    /// GraphRuntime::switch_to finds what both graphs have by keys. A key is a name as it was given, with
    /// this ending. None: with that of the scope around, or if there is none, keys are the names. With it,
    /// what was made under one name in a graph can go on under another one in the next, for example where two
    /// of a kind take turns. Keys of passes, and those of persistent and imported resources within each kind,
    /// must be unique.
    std::optional<std::string_view> key_ending{};
    /// An imported value. In frames in which it is true, the passes do not run: what they have written stays
    /// as it is, although their inputs change, and they run when it is false again. Only once all of them
    /// have run, so that what they need of each other is there. None: as the scope around says.
    std::optional<ValueHandle<bool>> held{};
};

/// See FrameGraph::scope.
class CANDELA_API Scope {
 public:
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope();

 private:
    friend FrameGraph;
    Scope(detail::Declaration& declared, const ScopeDesc& desc);

    detail::Declaration& declared_;
    std::string ending_;  // of the scope around this one, as are the next two
    std::optional<std::string> key_ending_;
    std::uint32_t held_by_;
};

/// The declaration of a frame: its resources and its passes. Misuse does not throw while declaring; `compile`
/// reports every error. `compile` consumes the graph: afterwards it may only be assigned to or destroyed.
class CANDELA_API FrameGraph {
 public:
    FrameGraph();
    FrameGraph(FrameGraph&& other) noexcept;
    FrameGraph& operator=(FrameGraph&& other) noexcept;
    ~FrameGraph();

    // Names appear in messages and reports. They also identify persistent and imported resources across
    // graphs (GraphRuntime::switch_to; see ScopeDesc::key_ending), so the names of persistent and imported
    // resources must be unique within each kind (texture, buffer, value). The graph copies the names.

    /// As long as the returned object lives, which must be gone before the graph is compiled, passes and
    /// resources are declared as `desc` says. Scopes may be inside of others.
    [[nodiscard]] Scope scope(const ScopeDesc& desc);

    /// A texture with the given description. For an imported one, `compile` checks the usages against `desc`,
    /// and GraphRuntime::bind gives the actual description.
    [[nodiscard]] TextureHandle texture(std::string_view name, const TextureDesc& desc,
                                        Lifetime lifetime = Lifetime::transient);

    /// A buffer of `count` elements of type `T`, sizeof(T) bytes apart.
    template <class T>
    [[nodiscard]] BufferHandle<T> buffer(std::string_view name, std::uint64_t count,
                                         Lifetime lifetime = Lifetime::transient) {
        return {add_buffer(name, {count, sizeof(T)}, typeid(T), lifetime)};
    }

    /// A CPU value that a pass sets (Execution::set). It is kept from frame to frame.
    template <class T>
    [[nodiscard]] ValueHandle<T> value(std::string_view name) {
        return {add_value(name, typeid(T), Lifetime::persistent)};
    }

    /// A CPU value that the host sets (GraphRuntime::set): before the first run, and again whenever it
    /// changes.
    template <class T>
    [[nodiscard]] ValueHandle<T> import_value(std::string_view name) {
        return {add_value(name, typeid(T), Lifetime::imported)};
    }

    /// The newest version of the texture with this name, for a pass declared next to read. Only what passes
    /// have written so far is found, not what they are yet to write, nor what only the host writes; of
    /// several transients with the name, that declared last. `name` is as in messages and in descriptions,
    /// with the endings of scopes. O(resources).
    [[nodiscard]] std::optional<FoundTexture> find_texture(std::string_view name) const;
    /// The same for a buffer.
    [[nodiscard]] std::optional<FoundBuffer> find_buffer(std::string_view name) const;

    /// Names of the passes so far, in the order of their declaration. Valid as long as the graph, also when
    /// it has been compiled.
    [[nodiscard]] std::vector<std::string_view> pass_names() const;

    /// The description of a texture of this graph, as declared; none for another handle. A pass may reserve
    /// another one.
    [[nodiscard]] std::optional<TextureDesc> desc(TextureHandle texture) const;

    /// Says what the content of a texture or buffer means, for passes that find it by name: any value that
    /// the host chooses, such as a struct with handles of other resources. Replaces an earlier note.
    void note(ResourceHandle on, std::any what);

    /// Adds a pass. Calls `declare(Pass&)` immediately and returns its result, usually the handles that the
    /// pass writes. Pass names must be unique in the graph. `declare` may add resources, but no other pass.
    template <std::invocable<Pass&> Declare>
    std::invoke_result_t<Declare, Pass&> add(std::string_view name, Declare&& declare) {
        Pass pass(*declared_, name);
        return std::forward<Declare>(declare)(pass);
    }

 private:
    friend CompileResult compile(FrameGraph&& graph, std::optional<std::uint32_t> shuffle);

    ResourceHandle add_buffer(std::string_view name, const BufferDesc& desc, std::type_index element,
                              Lifetime lifetime);
    ResourceHandle add_value(std::string_view name, std::type_index type, Lifetime lifetime);

    std::unique_ptr<detail::Declaration> declared_;
};

}  // namespace candela
