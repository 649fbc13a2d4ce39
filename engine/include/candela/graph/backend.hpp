#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <candela/api.hpp>
#include <candela/graph/resources.hpp>

namespace candela {

using ObjectId = std::uint32_t;  ///< identifies a texture or buffer of a back end; 0 means none

/// Memory barriers that order incoherent writes before later accesses. Named after the bits of
/// glMemoryBarrier; the bit tells how the later access is made.
enum class Barrier : std::uint32_t {
    none = 0,
    vertex_attrib = 1U << 0U,
    element = 1U << 1U,
    uniform = 1U << 2U,
    texture_fetch = 1U << 3U,
    image_access = 1U << 4U,
    command = 1U << 5U,
    texture_update = 1U << 6U,
    buffer_update = 1U << 7U,
    framebuffer = 1U << 8U,
    storage = 1U << 9U,
};
[[nodiscard]] constexpr Barrier operator|(Barrier a, Barrier b) {
    return static_cast<Barrier>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
[[nodiscard]] constexpr Barrier operator&(Barrier a, Barrier b) {
    return static_cast<Barrier>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
inline constexpr auto all_barriers = static_cast<Barrier>((1U << 10U) - 1);
/// For example "texture fetch + storage"; "none" if no bit is set.
[[nodiscard]] CANDELA_API std::string to_string(Barrier bits);

/// Attachments of a pass. All have the same size.
struct PassTargets {
    std::span<const ObjectId> colour;  ///< in the order of declaration
    ObjectId depth = 0;                ///< 0: none
    bool writes_depth = false;         ///< else the pass has declared that it only tests against it
    glm::uvec2 size{0};                ///< texels
};

/// The graphics API as the frame graph sees it; the host implements it. A GraphRuntime destroys every object
/// that it has created. The create functions may throw; destroy_* and end_pass must not.
class CANDELA_API Backend {
 public:
    virtual ~Backend() = default;
    /// Creates storage, whose content may be undefined. Must not return 0. `name` is for debugging.
    [[nodiscard]] virtual ObjectId create_texture(std::string_view name, const TextureDesc& desc) = 0;
    [[nodiscard]] virtual ObjectId create_buffer(std::string_view name, const BufferDesc& desc) = 0;
    virtual void destroy_texture(ObjectId texture) = 0;
    virtual void destroy_buffer(ObjectId buffer) = 0;
    /// Issued before begin_pass of the pass that needs it; never with Barrier::none.
    virtual void barrier(Barrier bits) = 0;
    /// Called before each pass that runs; end_pass is called after it, also if the pass throws. `index` is
    /// the position of the pass in the execution order. `targets` is null for a pass without attachments and
    /// valid until end_pass. Depth writes should be off at first where the pass only reads depth.
    virtual void begin_pass(std::string_view name, std::uint32_t index, const PassTargets* targets) = 0;
    virtual void end_pass() = 0;
    /// Binds an object for the shaders of the pass that has begun, as its declaration says (see Binding).
    /// Called after begin_pass, and again if the pass replaces the object by `reserve`. A buffer with
    /// Usage::sampled is bound as texels of four 32-bit words; one with Usage::indirect becomes the source of
    /// draw and dispatch arguments.
    virtual void bind_texture(ObjectId texture, const TextureDesc& desc, Binding binding) = 0;
    virtual void bind_buffer(ObjectId buffer, Binding binding) = 0;
    /// A hash of the whole content of an object that this back end created: equal for equal content, and
    /// almost certainly different for different content. Used by verification, outside of passes; may wait
    /// for the GPU.
    [[nodiscard]] virtual std::uint64_t texture_digest(ObjectId texture) = 0;
    [[nodiscard]] virtual std::uint64_t buffer_digest(ObjectId buffer) = 0;
};

}  // namespace candela
