#pragma once

#include <any>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <candela/ecs/world.hpp>
#include <candela/graph/errors.hpp>
#include <candela/graph/frame_graph.hpp>
#include <candela/graph/resources.hpp>

namespace candela::detail {

/// The size as a 32-bit index.
template <class T>
[[nodiscard]] std::uint32_t size_of(const std::vector<T>& list) {
    return static_cast<std::uint32_t>(list.size());
}

inline constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// The kind of a resource with its description.
struct Storage {
    ResourceKind kind = ResourceKind::value;
    TextureDesc texture{};
    BufferDesc buffer{};
    std::type_index type = typeid(void);  // of a value
    bool operator==(const Storage&) const = default;
    [[nodiscard]] std::size_t hash() const;
};

/// What something is called in a graph, and by what it is found again in another: ScopeDesc::key_ending.
struct Name {
    std::string_view name;
    std::string_view key;
};

struct Resource {
    std::string_view name;
    std::string_view key;
    const Storage* storage = nullptr;  // as declared; in the arena
    Lifetime lifetime = Lifetime::transient;
    std::uint32_t versions = 0;   // number of writes declared so far
    std::uint32_t reader = none;  // the pass with the last declared read
    std::uint32_t writer = none;  // the pass with the last declared write
    std::uint32_t note = none;    // see FrameGraph::note
    // Of a buffer; not a part of its storage, which buffers of several types may share.
    std::type_index element = typeid(void);

    /// Whether it is found again by its key in another graph.
    [[nodiscard]] bool is_kept() const { return lifetime != Lifetime::transient; }
    /// For messages, for example "texture 'depth'".
    [[nodiscard]] std::string title() const { return fmt::format("{} '{}'", to_string(storage->kind), name); }
};

struct Access {
    std::uint32_t resource;
    std::uint32_t version;  // the version read, or the one that the write produces
    Usage usage;            // not used for values
    bool write;
    bool update;          // a write that may leave parts of the previous frame's content
    std::uint32_t point;  // see Binding

    /// Whether only a barrier lets others see what is written.
    [[nodiscard]] bool is_incoherent() const { return write && usage == Usage::storage; }
};

/// See Pass::after.
struct After {
    std::uint32_t pass;
    std::uint32_t before;  // the pass that runs first
};

struct Parameter {
    std::type_index type;
    const void* value;
    bool (*equal)(const void*, const void*);

    bool operator==(const Parameter& other) const { return type == other.type && equal(value, other.value); }
};

struct PassNode {
    std::string_view name;
    std::string_view key;
    void* function = nullptr;
    void (*invoke)(void*, Execution&) = nullptr;
    std::uint32_t first_access = 0;  // each list ends where the next pass's begins
    std::uint32_t first_component = 0;
    std::uint32_t first_parameter = 0;
    bool side_effect = false;
    bool keeps_state = false;
    bool writes_entities = false;
    std::uint32_t held_by = none;  // resource: ScopeDesc::held
    std::uint32_t note = none;     // see Pass::note
};

/// The content of a FrameGraph in flat arrays. Names, functions and parameters are stored in the arena.
struct Declaration {
    Declaration();

    [[nodiscard]] std::uint32_t pass_count() const { return size_of(passes); }
    [[nodiscard]] std::span<const Access> accesses_of(std::uint32_t pass) const {
        return part(accesses, pass, &PassNode::first_access);
    }
    [[nodiscard]] std::span<const ComponentAccess> components_of(std::uint32_t pass) const {
        return part(components, pass, &PassNode::first_component);
    }
    [[nodiscard]] std::span<const Parameter> parameters_of(std::uint32_t pass) const {
        return part(parameters, pass, &PassNode::first_parameter);
    }
    /// Of a pass or a resource; null without one.
    [[nodiscard]] const std::any* note_of(std::uint32_t note) const {
        return note == none ? nullptr : &notes[note];
    }
    /// Whether the handle is of this graph and names a resource of this kind.
    [[nodiscard]] bool owns(ResourceHandle handle, ResourceKind kind) const;
    /// What is wrong with a handle that is not one of these, to follow "a texture".
    [[nodiscard]] std::string_view fault_of(ResourceHandle handle) const;
    /// Copies the name, with the endings of ScopeDesc.
    [[nodiscard]] Name store_name(std::string_view name);
    template <class... Args>
    void error(ErrorCode code, fmt::format_string<Args...> format, Args&&... args) {
        // GCC 12 reports overlapping copies if a CompileError is made first and then moved.
        CompileError& added = errors.emplace_back();
        added.code = code;
        added.message = fmt::format(format, std::forward<Args>(args)...);
    }

    std::uint32_t id = 0;
    Arena arena;
    std::string ending;                     // of the names of what is declared
    std::optional<std::string> key_ending;  // of their keys; none: they are the names
    std::uint32_t held_by = none;           // PassNode::held_by of what is declared
    bool declaring = false;                 // a pass
    std::vector<PassNode> passes;
    std::vector<Access> accesses;
    std::vector<ComponentAccess> components;
    std::vector<After> after;  // in the order of `pass`
    std::vector<Parameter> parameters;
    std::vector<Resource> resources;
    std::vector<std::any> notes;
    std::vector<CompileError> errors;

 private:
    template <class T>
    [[nodiscard]] std::span<const T> part(const std::vector<T>& all, std::uint32_t pass,
                                          std::uint32_t PassNode::*first) const {
        const std::size_t begin = passes[pass].*first;
        const std::size_t end = pass + 1 < passes.size() ? passes[pass + 1].*first : all.size();
        return std::span(all).subspan(begin, end - begin);
    }
};

}  // namespace candela::detail
