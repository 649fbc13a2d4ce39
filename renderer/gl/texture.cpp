#include "renderer/gl/texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>

#include <glm/common.hpp>

namespace candela::gl {
namespace {

/// Sets tightly packed transfers between textures and CPU memory, whatever the host has set, and restores the
/// host's state in the destructor.
class PackedTransfers {
 public:
    explicit PackedTransfers(const Functions& gl) : gl_(gl) {
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            gl.GetIntegerv(parameters[i].first, &saved_[i]);
            gl.PixelStorei(parameters[i].first, parameters[i].second);
        }
        gl.GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack_buffer_);
        gl.GetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &pack_buffer_);
        gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
        gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    }
    ~PackedTransfers() {
        for (std::size_t i = 0; i < parameters.size(); ++i) gl_.PixelStorei(parameters[i].first, saved_[i]);
        gl_.BindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpack_buffer_));
        gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(pack_buffer_));
    }
    PackedTransfers(const PackedTransfers&) = delete;
    PackedTransfers& operator=(const PackedTransfers&) = delete;

 private:
    static constexpr std::array<std::pair<GLenum, GLint>, 14> parameters = {{
        {GL_UNPACK_ALIGNMENT, 1},
        {GL_UNPACK_ROW_LENGTH, 0},
        {GL_UNPACK_IMAGE_HEIGHT, 0},
        {GL_UNPACK_SKIP_PIXELS, 0},
        {GL_UNPACK_SKIP_ROWS, 0},
        {GL_UNPACK_SKIP_IMAGES, 0},
        {GL_UNPACK_SWAP_BYTES, 0},
        {GL_PACK_ALIGNMENT, 1},
        {GL_PACK_ROW_LENGTH, 0},
        {GL_PACK_IMAGE_HEIGHT, 0},
        {GL_PACK_SKIP_PIXELS, 0},
        {GL_PACK_SKIP_ROWS, 0},
        {GL_PACK_SKIP_IMAGES, 0},
        {GL_PACK_SWAP_BYTES, 0},
    }};

    const Functions& gl_;
    std::array<GLint, parameters.size()> saved_{};
    GLint unpack_buffer_ = 0;
    GLint pack_buffer_ = 0;
};

/// Why a texture cannot be made within these limits; empty if it can.
std::string error(const TextureDesc& desc, const Limits& limits) {
    const std::uint32_t longest = std::max(desc.size.x, desc.size.y);
    if (std::min(desc.size.x, desc.size.y) == 0) return "a side has no texels";
    if (longest > limits.texture_size) {
        return fmt::format("the driver allows {} texels a side", limits.texture_size);
    }
    if (desc.layers == 0 || desc.layers > limits.texture_layers) {
        return fmt::format("{} layers, but the driver allows 1 to {}", desc.layers, limits.texture_layers);
    }
    if (desc.shape == TextureShape::flat && desc.layers != 1) return "a flat texture has one layer";
    if (desc.shape == TextureShape::cube_array && (desc.layers % 6 != 0 || desc.size.x != desc.size.y)) {
        return "a cube array has square faces, six a cube";
    }
    if (desc.mips == 0 || desc.mips > static_cast<std::uint32_t>(std::bit_width(longest))) {
        return fmt::format("{} mip levels do not fit", desc.mips);
    }
    return {};
}

GLint min_filter(const TextureDesc& desc) {
    if (desc.format == Format::r32ui) return desc.mips > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST;
    return desc.mips > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR;
}

GLuint create_texture(const Functions& gl, TextureShape shape) {
    GLuint name = 0;
    gl.CreateTextures(texture_target(shape), 1, &name);
    return name;
}

/// The description of one layer of a mip level as a texture of its own.
TextureDesc picture_desc(const TextureDesc& whole, std::uint32_t mip) {
    return {.size = glm::max(whole.size >> mip, glm::uvec2(1)), .format = whole.format};
}

GLuint create_view(const Functions& gl, GLuint whole, Format format, std::uint32_t mip, std::uint32_t layer) {
    GLuint name = 0;
    gl.GenTextures(1, &name);  // CreateTextures gives the name a target, which glTextureView does not accept
    gl.TextureView(name, GL_TEXTURE_2D, whole, format_info(format).internal, mip, 1, layer, 1);
    return name;
}

GLuint level_parameter(const Functions& gl, GLuint texture, GLenum what) {
    GLint value = 0;
    gl.GetTextureLevelParameteriv(texture, 0, what, &value);
    return static_cast<GLuint>(value);
}

/// Reads floats of these channels from level 0 of a 2D texture.
void read_part(const Functions& gl, GLuint texture, glm::uvec2 size, glm::uvec2 first, GLenum channels,
               std::span<std::byte> content) {
    const PackedTransfers packed(gl);
    gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    gl.GetTextureSubImage(texture, 0, static_cast<GLint>(first.x), static_cast<GLint>(first.y), 0,
                          static_cast<GLsizei>(size.x), static_cast<GLsizei>(size.y), 1, channels, GL_FLOAT,
                          static_cast<GLsizei>(content.size()), content.data());
}

}  // namespace

FormatInfo format_info(Format format) {
    switch (format) {
        case Format::rgba8:
            return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
        case Format::srgb8_alpha8:
            return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
        case Format::rgba16f:
            return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 4};
        case Format::rgba32f:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 4};
        case Format::rg32f:
            return {GL_RG32F, GL_RG, GL_FLOAT, 2};
        case Format::r32f:
            return {GL_R32F, GL_RED, GL_FLOAT, 1};
        case Format::rg16f:
            return {GL_RG16F, GL_RG, GL_HALF_FLOAT, 2};
        case Format::r16f:
            return {GL_R16F, GL_RED, GL_HALF_FLOAT, 1};
        case Format::r32ui:
            return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 1};
        case Format::depth32f:
            return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 1};
    }
    return {};
}

GLenum texture_target(TextureShape shape) {
    switch (shape) {
        case TextureShape::flat:
            return GL_TEXTURE_2D;
        case TextureShape::array:
            return GL_TEXTURE_2D_ARRAY;
        case TextureShape::cube_array:
            return GL_TEXTURE_CUBE_MAP_ARRAY;
    }
    return GL_NONE;
}

Texture::Texture(Device& device, std::string_view label, const TextureDesc& desc)
    : Object(device, ObjectKind::texture, create_texture(device.gl(), desc.shape), label), desc_(desc) {
    const std::string called = fmt::format("texture \"{}\" of {}×{}", label, desc.size.x, desc.size.y);
    if (const std::string why = error(desc, device.limits()); !why.empty()) {
        throw GlError(fmt::format("{}: {}", called, why));
    }

    const auto width = static_cast<GLsizei>(desc.size.x);
    const auto height = static_cast<GLsizei>(desc.size.y);
    const auto mips = static_cast<GLsizei>(desc.mips);
    const GLenum internal = format_info(desc.format).internal;
    if (desc.shape == TextureShape::flat) {
        gl().TextureStorage2D(name(), mips, internal, width, height);
    } else {
        gl().TextureStorage3D(name(), mips, internal, width, height, static_cast<GLsizei>(desc.layers));
    }
    // Not glGetError: it would also return, and clear, an error of the host.
    GLint stored = GL_FALSE;
    gl().GetTextureParameteriv(name(), GL_TEXTURE_IMMUTABLE_FORMAT, &stored);
    if (stored != GL_TRUE) throw MemoryError(fmt::format("{}: no memory", called));
    set_bytes(byte_size(desc));
    set_sampling();
}

Texture::Texture(Device& device, std::string_view label, GLuint whole, const TextureDesc& desc,
                 std::uint32_t mip, std::uint32_t layer)
    : Object(device, ObjectKind::texture, create_view(device.gl(), whole, desc.format, mip, layer), label),
      desc_(picture_desc(desc, mip)) {
    set_sampling();
}

void Texture::set_sampling() {
    gl().TextureParameteri(name(), GL_TEXTURE_MIN_FILTER, min_filter(desc_));
    gl().TextureParameteri(name(), GL_TEXTURE_MAG_FILTER,
                           desc_.format == Format::r32ui ? GL_NEAREST : GL_LINEAR);
    gl().TextureParameteri(name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl().TextureParameteri(name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

glm::uvec2 Texture::level_size(std::uint32_t level) const {
    return {std::max(desc_.size.x >> level, 1U), std::max(desc_.size.y >> level, 1U)};
}

std::size_t Texture::texels(std::uint32_t level) const {
    const glm::uvec2 size = level_size(level);
    return std::size_t{size.x} * size.y;
}

void Texture::require_layer(std::uint32_t level, std::uint32_t layer) const {
    if (level >= desc_.mips || layer >= desc_.layers) {
        throw GlError(fmt::format("level {}, layer {} of a texture of {} levels and {} layers", level, layer,
                                  desc_.mips, desc_.layers));
    }
}

void Texture::upload(std::span<const std::byte> data, std::uint32_t level, std::uint32_t layer) {
    require_layer(level, layer);
    const std::size_t expected = texels(level) * bytes_per_texel(desc_.format);
    if (data.size() != expected) {
        throw GlError(fmt::format("an upload of {} bytes to a texture level of {}", data.size(), expected));
    }
    const PackedTransfers packed(gl());
    const FormatInfo info = format_info(desc_.format);
    const auto mip = static_cast<GLint>(level);
    const auto width = static_cast<GLsizei>(level_size(level).x);
    const auto height = static_cast<GLsizei>(level_size(level).y);
    if (desc_.shape == TextureShape::flat) {
        gl().TextureSubImage2D(name(), mip, 0, 0, width, height, info.layout, info.type, data.data());
    } else {
        gl().TextureSubImage3D(name(), mip, 0, 0, static_cast<GLint>(layer), width, height, 1, info.layout,
                               info.type, data.data());
    }
}

void Texture::generate_mips() {
    gl().GenerateTextureMipmap(name());
}

std::vector<std::byte> Texture::read(std::uint32_t level, std::uint32_t layer) const {
    std::vector<std::byte> content(texels(level) * bytes_per_texel(desc_.format));
    read_as(format_info(desc_.format).type, content, level, layer);
    return content;
}

std::vector<float> Texture::read_floats(std::uint32_t level, std::uint32_t layer) const {
    std::vector<float> content(texels(level) * format_info(desc_.format).components);
    read_as(GL_FLOAT, std::as_writable_bytes(std::span(content)), level, layer);
    return content;
}

void Texture::read_as(GLenum type, std::span<std::byte> content, std::uint32_t level,
                      std::uint32_t layer) const {
    require_layer(level, layer);
    const PackedTransfers packed(gl());
    const glm::uvec2 size = level_size(level);
    gl().MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    gl().GetTextureSubImage(name(), static_cast<GLint>(level), 0, 0, static_cast<GLint>(layer),
                            static_cast<GLsizei>(size.x), static_cast<GLsizei>(size.y), 1,
                            format_info(desc_.format).layout, type, static_cast<GLsizei>(content.size()),
                            content.data());
}

void Texture::bind(GLuint unit) const {
    gl().BindTextureUnit(unit, name());
}

glm::uvec2 texture_size(const Functions& gl, GLuint texture) {
    return {level_parameter(gl, texture, GL_TEXTURE_WIDTH), level_parameter(gl, texture, GL_TEXTURE_HEIGHT)};
}

TextureTraits traits_of(const Functions& gl, GLuint texture) {
    const auto get = [&](GLenum what) { return level_parameter(gl, texture, what); };
    TextureTraits traits{.size = texture_size(gl, texture)};
    for (const GLenum bits : std::array<GLenum, 4>{GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE,
                                                   GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE}) {
        if (get(bits) > 0) ++traits.channels;
    }
    const GLenum type = get(GL_TEXTURE_RED_TYPE);
    const GLenum format = get(GL_TEXTURE_INTERNAL_FORMAT);
    const bool unsigned_floats = format == GL_R11F_G11F_B10F || format == GL_RGB9_E5;
    traits.depth = get(GL_TEXTURE_DEPTH_SIZE) > 0;
    traits.integers = type == GL_INT || type == GL_UNSIGNED_INT;
    traits.has_sign = (type == GL_FLOAT && !unsigned_floats) || type == GL_SIGNED_NORMALIZED;
    traits.srgb =
        format == GL_SRGB8 || format == GL_SRGB8_ALPHA8 || format == GL_SRGB || format == GL_SRGB_ALPHA;
    return traits;
}

std::vector<glm::vec4> read_texels(const Functions& gl, GLuint texture, glm::uvec2 size, glm::uvec2 first) {
    std::vector<glm::vec4> texels(static_cast<std::size_t>(size.x) * size.y);
    read_part(gl, texture, size, first, GL_RGBA, std::as_writable_bytes(std::span(texels)));
    return texels;
}

std::vector<float> read_depths(const Functions& gl, GLuint texture, glm::uvec2 size, glm::uvec2 first) {
    std::vector<float> depths(static_cast<std::size_t>(size.x) * size.y);
    const bool depth_format = level_parameter(gl, texture, GL_TEXTURE_DEPTH_SIZE) > 0;
    read_part(gl, texture, size, first, depth_format ? GL_DEPTH_COMPONENT : GL_RED,
              std::as_writable_bytes(std::span(depths)));
    return depths;
}

void copy_texels(const Functions& gl, GLuint from, GLuint to, glm::uvec2 size) {
    gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    gl.CopyImageSubData(from, GL_TEXTURE_2D, 0, 0, 0, 0, to, GL_TEXTURE_2D, 0, 0, 0, 0,
                        static_cast<GLsizei>(size.x), static_cast<GLsizei>(size.y), 1);
}

}  // namespace candela::gl
