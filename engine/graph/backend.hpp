#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "engine/graph/resources.hpp"

namespace candela {

using ObjectId = std::uint32_t;  ///< a back end's name for a texture or a buffer; 0 is none

/// Ordering of incoherent writes before later accesses, named after the GL's memory-barrier bits.
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
/// "texture fetch + storage"; "none" for none.
[[nodiscard]] std::string to_string(Barrier bits);

/// Attachments of a pass, in the order of declaration. All have one size.
struct PassTargets {
    std::span<const ObjectId> colour;
    ObjectId depth = 0;
    glm::uvec2 size{0};  ///< texels
};

/// What the frame graph asks of a graphics API. All objects that it creates it destroys.
class Backend {
 public:
    virtual ~Backend() = default;
    [[nodiscard]] virtual ObjectId create_texture(std::string_view name, const TextureDesc& desc) = 0;
    [[nodiscard]] virtual ObjectId create_buffer(std::string_view name, const BufferDesc& desc) = 0;
    virtual void destroy_texture(ObjectId texture) = 0;
    virtual void destroy_buffer(ObjectId buffer) = 0;
    virtual void barrier(Barrier bits) = 0;
    /// Around each pass that runs. `index` is its place in the order of the compiled graph; `targets` is null
    /// for passes without attachments and lasts until end_pass. end_pass follows also when the pass throws.
    virtual void begin_pass(std::string_view name, std::uint32_t index, const PassTargets* targets) = 0;
    virtual void end_pass() = 0;
    /// A number that tells the whole content of an object that this back end made: equal for equal content,
    /// and else almost surely another. Called between passes; may wait for the GPU.
    [[nodiscard]] virtual std::uint64_t texture_digest(ObjectId texture) = 0;
    [[nodiscard]] virtual std::uint64_t buffer_digest(ObjectId buffer) = 0;
};

}  // namespace candela
