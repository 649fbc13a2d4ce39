#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include <candela/api.hpp>

namespace candela {

/// Names one version of one resource of one graph. Declaring a write gives the handle of the next version;
/// passes declared later must not read the old one. A plain value that owns nothing.
struct ResourceHandle {
    std::uint32_t graph = 0;     ///< identity of the declaring FrameGraph; 0 for a null handle
    std::uint32_t resource = 0;  ///< index within the graph
    std::uint32_t version = 0;   ///< 0: not yet written in this frame
    bool operator==(const ResourceHandle&) const = default;
};

struct TextureHandle : ResourceHandle {};

/// A GPU buffer with elements of type `T`.
template <class T>
struct BufferHandle : ResourceHandle {};

/// A CPU value of type `T`.
template <class T>
struct ValueHandle : ResourceHandle {};

enum class ResourceKind : std::uint8_t { texture, buffer, value };
[[nodiscard]] CANDELA_API std::string_view to_string(ResourceKind kind);

enum class Format : std::uint8_t {
    rgba8,
    srgb8_alpha8,
    rgba16f,
    rgba32f,
    rg32f,
    r32f,
    rg16f,
    r16f,
    r32ui,
    depth32f
};
[[nodiscard]] CANDELA_API bool is_depth(Format format);
[[nodiscard]] CANDELA_API std::uint32_t bytes_per_texel(Format format);
[[nodiscard]] CANDELA_API std::string_view to_string(Format format);

enum class TextureShape : std::uint8_t { flat, array, cube_array };
[[nodiscard]] CANDELA_API std::string_view to_string(TextureShape shape);

/// Storage of a texture. `layers` counts faces for cube arrays (a multiple of 6).
struct TextureDesc {
    glm::uvec2 size{1};  ///< texels of the largest mip level
    Format format = Format::rgba8;
    TextureShape shape = TextureShape::flat;
    std::uint32_t layers = 1;
    std::uint32_t mips = 1;
    bool operator==(const TextureDesc&) const = default;
};
/// Why no texture can have this description, for example "its size is 0x4"; empty if one can.
[[nodiscard]] CANDELA_API std::string why_impossible(const TextureDesc& desc);
/// Bytes of all layers and mip levels, without driver overhead.
[[nodiscard]] CANDELA_API std::uint64_t byte_size(const TextureDesc& desc);

/// Storage of a buffer with `count` elements, `stride` bytes apart.
struct BufferDesc {
    std::uint64_t count = 0;
    std::uint32_t stride = 1;
    bool operator==(const BufferDesc&) const = default;
};
[[nodiscard]] CANDELA_API std::uint64_t byte_size(const BufferDesc& desc);

/// How a pass accesses a GPU resource. Whether it reads or writes follows from `Pass::read` or `Pass::write`.
enum class Usage : std::uint8_t {
    sampled,        ///< read: texture fetches; of a buffer: of its texels of four 32-bit words each
    storage,        ///< read or write: shader storage buffer or image; writes are incoherent (need barriers)
    uniform,        ///< read: uniform buffer
    vertex,         ///< read: vertex attributes
    index,          ///< read: element buffer
    indirect,       ///< read: draw or dispatch arguments
    colour_target,  ///< write: attachment, bound by the back end before the pass runs
    depth_target,   ///< write: attachment; read: attachment for depth tests without depth writes
    layer_target,   ///< write: the pass attaches single layers itself
    copy            ///< read or write: copies, clears and uploads by API commands, not by shaders
};
[[nodiscard]] CANDELA_API std::string_view to_string(Usage usage);

/// An access and the place where shaders find the resource. The back end binds it there before the pass runs.
struct Binding {
    static constexpr std::uint32_t unbound = 0xffff'ffffU;

    Binding() = default;
    constexpr Binding(Usage access) : usage(access) {}  // a plain usage is a binding without a place
    constexpr Binding(Usage access, std::uint32_t place) : usage(access), point(place) {}

    Usage usage{};
    /// The texture unit (sampled), the image unit (storage, of textures), or the index of the
    /// storage or uniform block. A buffer that a pass uploads (copy) and reads in its own shaders is bound as
    /// a storage block. `unbound`: the pass binds the resource itself, or no shader sees it.
    std::uint32_t point = unbound;
};

enum class Lifetime : std::uint8_t {
    /// Content is kept only from the first to the last use in a frame. Transients of the same kind and
    /// description whose lifetimes do not overlap may share one object.
    transient,
    /// Kept from frame to frame, and across graphs that declare it with the same name and description.
    persistent,
    /// Owned by the host, which provides it with GraphRuntime::bind or set.
    imported
};
[[nodiscard]] CANDELA_API std::string_view to_string(Lifetime lifetime);

}  // namespace candela
