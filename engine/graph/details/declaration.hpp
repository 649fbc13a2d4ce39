#pragma once

#include <any>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <utility>
#include <vector>

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

struct Resource {
    std::string_view name;
    ResourceKind kind = ResourceKind::texture;
    Lifetime lifetime = Lifetime::transient;
    std::uint32_t desc = 0;           // index into the textures, buffers or value types, by kind
    std::uint32_t versions = 0;       // number of writes declared so far
    std::uint32_t reader = none;      // the pass with the last declared read
    std::uint32_t writer = none;      // the pass with the last declared write
    std::uint32_t history_of = none;  // for a history: the resource whose history it is
    std::uint32_t history = none;     // the resource that is this one's history
    bool updated = false;             // see Pass::update
    std::uint32_t part_of = none;     // for a part: the texture
    TexturePart part;                 // and which part of it
    std::uint32_t first_part = none;  // the parts of a texture are a linked list
    std::uint32_t next_part = none;
    std::uint32_t note = none;  // see FrameGraph::note
};

struct Access {
    std::uint32_t resource;
    std::uint32_t version;  // the version read, or the one that the write produces
    Usage usage;            // not used for values
    bool write;
    bool update;          // a write that may leave parts of the previous frame's content
    std::uint32_t point;  // see Binding
};

struct ComponentRead {
    std::string_view name;
    Tick (*revision)(const World&);
    bool operator==(const ComponentRead&) const = default;
};

struct Parameter {
    std::type_index type;
    const void* value;
    bool (*equal)(const void*, const void*);
};

struct PassNode {
    std::string_view name;
    void* function = nullptr;
    void (*invoke)(void*, Execution&) = nullptr;
    std::uint32_t first_access = 0;  // each list ends where the next pass's begins
    std::uint32_t first_component = 0;
    std::uint32_t first_parameter = 0;
    bool side_effect = false;
    bool keeps_state = false;
    std::uint32_t tag = 0;  // see Pass::tag
};

/// The content of a FrameGraph in flat arrays. Names, functions and parameters are stored in one arena.
class Declaration {
 public:
    Declaration();

    ResourceHandle add_texture(std::string_view name, const TextureDesc& desc, Lifetime lifetime);
    ResourceHandle add_buffer(std::string_view name, const BufferDesc& desc, Lifetime lifetime);
    ResourceHandle add_value(std::string_view name, std::type_index type, Lifetime lifetime);
    ResourceHandle add_history(ResourceHandle of);
    ResourceHandle add_part(ResourceHandle of, TexturePart part);
    void add_note(ResourceHandle on, std::any note);
    /// Null without one.
    [[nodiscard]] const std::any* note(ResourceHandle on) const {
        const std::uint32_t index = resources[on.resource].note;
        return index == none ? nullptr : &notes[index];
    }
    /// See FrameGraph::find_texture. A null handle if there is none.
    [[nodiscard]] ResourceHandle find(std::string_view name, ResourceKind kind) const;

    /// See FrameGraph::append_to_names.
    void append_to_names(std::string_view ending) { ending_ = ending; }
    void begin_pass(std::string_view name);
    void end_pass();
    void read(ResourceHandle handle, ResourceKind kind, Binding binding);
    ResourceHandle write(ResourceHandle handle, ResourceKind kind, Binding binding);
    ResourceHandle update(ResourceHandle handle, ResourceKind kind, Binding binding);

    [[nodiscard]] Arena& arena() { return *arena_; }

    [[nodiscard]] std::uint32_t pass_count() const { return static_cast<std::uint32_t>(passes.size()); }
    [[nodiscard]] std::span<const Access> accesses_of(std::uint32_t pass) const {
        return part(accesses, pass, &PassNode::first_access);
    }
    [[nodiscard]] std::span<const ComponentRead> components_of(std::uint32_t pass) const {
        return part(components, pass, &PassNode::first_component);
    }
    [[nodiscard]] std::span<const Parameter> parameters_of(std::uint32_t pass) const {
        return part(parameters, pass, &PassNode::first_parameter);
    }
    [[nodiscard]] const TextureDesc& texture(const Resource& resource) const {
        return textures[resource.desc];
    }
    [[nodiscard]] const BufferDesc& buffer(const Resource& resource) const { return buffers[resource.desc]; }

    std::uint32_t id = 0;
    std::vector<PassNode> passes;
    std::vector<Access> accesses;
    std::vector<ComponentRead> components;
    std::vector<Parameter> parameters;
    std::vector<Resource> resources;
    std::vector<TextureDesc> textures;
    std::vector<BufferDesc> buffers;
    std::vector<std::type_index> value_types;
    std::vector<std::any> notes;
    std::vector<CompileError> errors;  // those found while declaring

 private:
    template <class T>
    [[nodiscard]] std::span<const T> part(const std::vector<T>& all, std::uint32_t pass,
                                          std::uint32_t PassNode::*first) const {
        const std::size_t begin = passes[pass].*first;
        const std::size_t end = pass + 1 < passes.size() ? passes[pass + 1].*first : all.size();
        return std::span(all).subspan(begin, end - begin);
    }
    [[nodiscard]] std::string_view store_name(std::string_view name);
    ResourceHandle add_resource(std::string_view name, ResourceKind kind, Lifetime lifetime,
                                std::size_t desc);
    [[nodiscard]] bool owns(ResourceHandle handle, ResourceKind kind) const;
    [[nodiscard]] bool is_written(const Resource& resource) const;
    [[nodiscard]] std::string_view writer_of(std::uint32_t resource, std::uint32_t version) const;
    void error(ErrorCode code, std::string message) {
        // GCC 12 reports overlapping copies if a CompileError is made first and then moved.
        CompileError& added = errors.emplace_back();
        added.code = code;
        added.message = std::move(message);
    }
    [[nodiscard]] std::string_view why_no_parts(const Resource& whole, TexturePart part) const;
    [[nodiscard]] std::string_view why_no_history(const Resource& base) const;
    void check_binding(const Resource& resource, Binding binding, bool write);
    void check_attachments();

    std::unique_ptr<Arena> arena_;
    std::string ending_;  // of the names of what is declared
    bool declaring_ = false;
};

}  // namespace candela::detail
