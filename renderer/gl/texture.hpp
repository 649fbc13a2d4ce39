#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string_view>
#include <vector>

#include <candela/graph/resources.hpp>
#include "renderer/gl/objects.hpp"

namespace candela::gl {

/// OpenGL constants of a Format: for its storage, and for texels on the CPU.
struct FormatInfo {
    GLenum internal = 0;  ///< sized internal format
    GLenum layout = 0;    ///< of texels on the CPU: GL_RGBA, ...
    GLenum type = 0;      ///< of the components on the CPU, as stored: GL_UNSIGNED_BYTE, ...
    std::uint32_t components = 0;
};
[[nodiscard]] FormatInfo format_info(Format format);
[[nodiscard]] GLenum texture_target(TextureShape shape);

/// A texture with immutable storage. The layers of a cube array are faces, in the order of OpenGL.
class Texture : public Object {
 public:
    Texture() = default;
    /// Undefined content. Wraps by clamping to the edge. Filters linearly, between mip levels too if there
    /// are several; Format::r32ui filters to the nearest. Throws GlError if the driver's limits do not allow
    /// the texture or there is not enough memory.
    Texture(Device& device, std::string_view label, const TextureDesc& desc);

    /// A view of one layer of a mip level of the texture named `whole`, whose storage `desc` describes. It
    /// shares that storage and keeps it alive.
    Texture(Device& device, std::string_view label, GLuint whole, const TextureDesc& desc, std::uint32_t mip,
            std::uint32_t layer);

    [[nodiscard]] const TextureDesc& desc() const { return desc_; }
    [[nodiscard]] GLenum target() const { return texture_target(desc_.shape); }
    /// Size of a mip level in texels.
    [[nodiscard]] glm::uvec2 level_size(std::uint32_t level) const;

    /// Replaces one layer of one level. Texels are in the stored type (half floats for 16-bit float formats),
    /// tightly packed, the row at v = 0 first. Independent of the host's pixel-store state. Throws GlError if
    /// the number of bytes does not match or the level or layer does not exist.
    void upload(std::span<const std::byte> texels, std::uint32_t level = 0, std::uint32_t layer = 0);
    /// Computes mip levels 1 and up from level 0.
    void generate_mips();

    /// Reads back one layer of one level, in the stored type (sRGB colours encoded) or as floats; waits for
    /// the GPU.
    [[nodiscard]] std::vector<std::byte> read(std::uint32_t level = 0, std::uint32_t layer = 0) const;
    [[nodiscard]] std::vector<float> read_floats(std::uint32_t level = 0, std::uint32_t layer = 0) const;

    /// Binds to a texture unit.
    void bind(GLuint unit) const;

 private:
    void set_sampling();
    [[nodiscard]] std::size_t texels(std::uint32_t level) const;
    void require_layer(std::uint32_t level, std::uint32_t layer) const;
    void read_as(GLenum type, std::span<std::byte> texels, std::uint32_t level, std::uint32_t layer) const;

    TextureDesc desc_;
};

/// Texels of level 0 of a 2D texture of this name; 0 without storage.
[[nodiscard]] glm::uvec2 texture_size(const Functions& gl, GLuint texture);

/// What shaders can read of a texture that Candela has not made.
struct TextureTraits {
    glm::uvec2 size{0};
    std::uint32_t channels = 0;  ///< of colour
    bool depth = false;          ///< a depth format
    bool integers = false;
    bool has_sign = false;  ///< values may be below 0
    bool srgb = false;      ///< converted to linear values when it is read
};
/// Those of level 0 of a 2D texture.
[[nodiscard]] TextureTraits traits_of(const Functions& gl, GLuint texture);

/// `size` texels from `first` on, in level 0 of a 2D colour texture of this name, row by row, the bottom row
/// first; missing channels are (0, 0, 0, 1). Waits for the GPU.
[[nodiscard]] std::vector<glm::vec4> read_texels(const Functions& gl, GLuint texture, glm::uvec2 size,
                                                 glm::uvec2 first = glm::uvec2(0));
/// The same of window depth: that of a depth format, or else red.
[[nodiscard]] std::vector<float> read_depths(const Functions& gl, GLuint texture, glm::uvec2 size,
                                             glm::uvec2 first);

/// Copies level 0 of a 2D texture to another of the same size and format.
void copy_texels(const Functions& gl, GLuint from, GLuint to, glm::uvec2 size);

}  // namespace candela::gl
