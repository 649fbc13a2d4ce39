#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "engine/graph/resources.hpp"
#include "renderer/gl/objects.hpp"

namespace candela::gl {

/// How a format is stored and how its texels travel.
struct FormatInfo {
    GLenum internal = 0;  ///< sized internal format
    GLenum layout = 0;    ///< of texels on the CPU: GL_RGBA, ...
    GLenum type = 0;      ///< of their components, as stored: GL_UNSIGNED_BYTE, ...
    std::uint32_t components = 0;
};
[[nodiscard]] FormatInfo format_info(Format format);
[[nodiscard]] GLenum texture_target(TextureShape shape);

/// Immutable texture storage. Layers of cube arrays are faces, in the GL's order.
class Texture : public Object {
 public:
    Texture() = default;
    /// Undefined content; filters without mip maps and clamps to the edge until told otherwise. Throws
    /// GlError if the driver's limits forbid it or there is no memory left.
    Texture(Device& device, std::string_view label, const TextureDesc& desc);

    [[nodiscard]] const TextureDesc& desc() const { return desc_; }
    [[nodiscard]] GLenum target() const { return texture_target(desc_.shape); }
    /// Texels of one level, in each direction.
    [[nodiscard]] glm::uvec2 level_size(std::uint32_t level) const;

    /// Replaces one layer of one level. Texels are as stored (halves for 16-bit floats), tightly packed, the
    /// row at v = 0 first. Throws GlError if the count of bytes differs. Regardless of the host's pixel-store
    /// state.
    void upload(std::span<const std::byte> texels, std::uint32_t level = 0, std::uint32_t layer = 0);
    /// Fills the levels above 0 from level 0.
    void generate_mips();

    /// One layer of one level as stored, or all components as floats; waits for the GPU. For tests and
    /// captures.
    [[nodiscard]] std::vector<std::byte> read(std::uint32_t level = 0, std::uint32_t layer = 0) const;
    [[nodiscard]] std::vector<float> read_floats(std::uint32_t level = 0, std::uint32_t layer = 0) const;

    /// Binds to a texture unit.
    void bind(GLuint unit) const;

 private:
    [[nodiscard]] std::size_t texels(std::uint32_t level) const;
    void require_layer(std::uint32_t level, std::uint32_t layer) const;
    void read_as(GLenum type, std::span<std::byte> texels, std::uint32_t level, std::uint32_t layer) const;

    TextureDesc desc_;
};

}  // namespace candela::gl
