#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <typeindex>
#include <utility>

#include "engine/ecs/world.hpp"
#include "engine/graph/details/declaration.hpp"
#include "engine/graph/resources.hpp"

namespace candela {

class CompiledGraph;
class Execution;  // what a pass sees while it runs: execute.hpp
class FrameGraph;
struct CompileOptions;
struct CompileResult;

/// Declares one pass: what it reads, what it writes, what it runs. Lives only inside `FrameGraph::add`.
///
/// Writing gives the next version of a resource. Version 0 has no content in this frame, and the pass must
/// fill it; from version 1 on the pass changes what is there and depends on it, without having to read it as
/// well. Each version is written once: who writes a version that another pass has overwritten must say
/// `after` that pass, and then writes its result. Passes declared after a write must read the handle that it
/// gave.
class Pass {
 public:
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

    void read(TextureHandle texture, Usage usage) { declared_.read(texture, ResourceKind::texture, usage); }
    template <class T>
    void read(BufferHandle<T> buffer, Usage usage) {
        declared_.read(buffer, ResourceKind::buffer, usage);
    }
    template <class T>
    void read(ValueHandle<T> value) {
        declared_.read(value, ResourceKind::value, {});
    }

    /// Reads a component pool of the world: the pass is dirty when the pool's revision has moved.
    template <Component C>
    void read() {
        declared_.components.push_back(
            {component_name<C>(), [](const World& world) { return world.revision<C>(); }});
    }

    [[nodiscard]] TextureHandle write(TextureHandle texture, Usage usage) {
        return {declared_.write(texture, ResourceKind::texture, usage)};
    }
    template <class T>
    [[nodiscard]] BufferHandle<T> write(BufferHandle<T> buffer, Usage usage) {
        return {declared_.write(buffer, ResourceKind::buffer, usage)};
    }
    template <class T>
    [[nodiscard]] ValueHandle<T> write(ValueHandle<T> value) {
        return {declared_.write(value, ResourceKind::value, {})};
    }

    /// A constant of the declaration that the pass's result depends on. When a new graph is adopted, a pass
    /// whose parameters compare equal keeps its results.
    template <std::equality_comparable T>
    void parameter(T value) {
        const auto equal = [](const void* a, const void* b) {
            return *static_cast<const T*>(a) == *static_cast<const T*>(b);
        };
        declared_.parameters.push_back({typeid(T), declared_.store(std::move(value)), equal});
    }

    /// Never culled, and runs in every frame.
    void side_effect() { declared_.passes.back().side_effect = true; }

    /// The result depends on the pass's own last one (`Execution::find`), so that running twice is not
    /// running once. A pass that reads a history does without saying. Verification leaves such passes alone;
    /// nothing else about them differs.
    void remembers() { declared_.passes.back().remembers = true; }

    /// An order that no data states: this pass runs after the named one, which may be declared later. It
    /// keeps nobody alive. Unknown names are faults.
    void after(std::string_view pass) { declared_.after(pass); }

    /// What the pass does: `void(Execution&)`. The last call counts.
    template <std::invocable<Execution&> F>
    void run(F function) {
        detail::PassNode& pass = declared_.passes.back();
        pass.function = declared_.store(std::move(function));
        pass.invoke = [](void* object, Execution& execution) { (*static_cast<F*>(object))(execution); };
    }

 private:
    friend FrameGraph;
    explicit Pass(detail::Declaration& declared) : declared_(declared) {}

    detail::Declaration& declared_;
};

/// The declaration of a frame. Declaring never throws on misuse; `compile` reports every fault by name, and
/// leaves nothing to declare into.
class FrameGraph {
 public:
    // Names are for people, and the key under which persistent and imported resources and values are known
    // from one graph to the next: among those, each kind's names must be unique.
    [[nodiscard]] TextureHandle texture(std::string_view name, const TextureDesc& desc,
                                        Lifetime lifetime = Lifetime::transient) {
        return {declared_.add_texture(name, desc, lifetime)};
    }

    /// A buffer of `count` `T`s.
    template <class T>
    [[nodiscard]] BufferHandle<T> buffer(std::string_view name, std::uint64_t count,
                                         Lifetime lifetime = Lifetime::transient) {
        return {declared_.add_buffer(name, {count, sizeof(T)}, lifetime)};
    }

    /// A CPU value that a pass sets, kept from frame to frame.
    template <class T>
    [[nodiscard]] ValueHandle<T> value(std::string_view name) {
        return {declared_.add_value(name, typeid(T), Lifetime::persistent)};
    }

    /// A CPU value that the host sets before the first run, and whenever it likes.
    template <class T>
    [[nodiscard]] ValueHandle<T> import_value(std::string_view name) {
        return {declared_.add_value(name, typeid(T), Lifetime::imported)};
    }

    /// What the resource held at the end of the last frame, which makes the resource persistent; read only.
    /// Invalid in the first frame, after a cut and after a resize: ask `Execution::history_valid`. A memory,
    /// not an input: reading it never makes a pass dirty.
    [[nodiscard]] TextureHandle history(TextureHandle texture) {
        return {declared_.add_history(texture, ResourceKind::texture)};
    }
    template <class T>
    [[nodiscard]] BufferHandle<T> history(BufferHandle<T> buffer) {
        return {declared_.add_history(buffer, ResourceKind::buffer)};
    }

    /// Adds a pass; `declare(Pass&)` is called at once and its result (the handles that the pass gives) is
    /// returned.
    template <std::invocable<Pass&> Declare>
    std::invoke_result_t<Declare, Pass&> add(std::string_view name, Declare&& declare) {
        declared_.begin_pass(name);
        const struct Close {
            detail::Declaration& declared;
            ~Close() { declared.end_pass(); }
        } close{declared_};
        Pass pass(declared_);
        return std::forward<Declare>(declare)(pass);
    }

 private:
    friend CompileResult compile(FrameGraph&& graph, CompileOptions options);

    detail::Declaration declared_;
};

}  // namespace candela
