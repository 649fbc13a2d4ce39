#include "renderer/passes/scene/material_upload.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#define STB_IMAGE_RESIZE_IMPLEMENTATION
#define STB_IMAGE_RESIZE_STATIC
#include <stb/stb_image_resize.h>

namespace candela {
namespace {

// Most texels along the longer side of an image for traced rays: a diffuse bounce blurs finer detail.
constexpr std::uint32_t traced_image_size = 256;

GLint wrap_mode(Wrap wrap) {
    switch (wrap) {
        case Wrap::mirrored_repeat:
            return GL_MIRRORED_REPEAT;
        case Wrap::clamp_to_edge:
            return GL_CLAMP_TO_EDGE;
        case Wrap::repeat:
            break;
    }
    return GL_REPEAT;
}

std::shared_ptr<const MaterialTexture> upload_texture(Gpu& gpu, const Image& image) {
    const TextureDesc desc{
        .size = {image.width, image.height},
        .format = Format::srgb8_alpha8,
        .mips = static_cast<std::uint32_t>(std::bit_width(std::max(image.width, image.height)))};
    gl::Texture texture(gpu.device(), "material", desc);
    texture.upload(std::as_bytes(std::span(image.texels)));
    texture.generate_mips();
    gl::Sampler sampler(gpu.device(), "material",
                        {.min_filter = GL_LINEAR_MIPMAP_LINEAR,
                         .wrap_u = wrap_mode(image.wrap_u),
                         .wrap_v = wrap_mode(image.wrap_v),
                         .anisotropy = 8.0F});
    return std::make_shared<const MaterialTexture>(MaterialTexture{std::move(texture), std::move(sampler)});
}

/// Scales an image down to `traced_image_size` if it is larger. Alpha is filtered linearly and does not
/// weight the colours, because most materials ignore it.
Image reduce(const Image& image) {
    const std::uint32_t longer = std::max(image.width, image.height);
    if (longer <= traced_image_size) {
        return image;
    }
    Image reduced = image;
    reduced.width = std::max(1U, image.width * traced_image_size / longer);
    reduced.height = std::max(1U, image.height * traced_image_size / longer);
    reduced.texels.resize(static_cast<std::size_t>(reduced.width) * reduced.height);
    stbir_resize_uint8_srgb(&image.texels[0].x, static_cast<int>(image.width), static_cast<int>(image.height),
                            0, &reduced.texels[0].x, static_cast<int>(reduced.width),
                            static_cast<int>(reduced.height), 0, 4, 3, STBIR_FLAG_ALPHA_PREMULTIPLIED);
    return reduced;
}

std::uint32_t pack(const glm::u8vec4& texel) {
    return texel.r | static_cast<std::uint32_t>(texel.g) << 8U | static_cast<std::uint32_t>(texel.b) << 16U |
           static_cast<std::uint32_t>(texel.a) << 24U;
}

std::uint32_t wrap_bits(const Image* image) {
    if (image == nullptr) {
        return 0;
    }
    return static_cast<std::uint32_t>(image->wrap_u) | static_cast<std::uint32_t>(image->wrap_v)
                                                           << MATERIAL_WRAP_BITS;
}

std::uint32_t material_flags(const Material& material) {
    return (material.double_sided ? MATERIAL_DOUBLE_SIDED : 0U) |
           wrap_bits(material.base_colour_texture.get()) << MATERIAL_BASE_COLOUR_WRAP_SHIFT |
           wrap_bits(material.emissive_texture.get()) << MATERIAL_EMISSIVE_WRAP_SHIFT;
}

bool is_masked(const Material& material) {
    return material.alpha_mode == AlphaMode::mask;
}

/// sRGB decoding: IEC 61966-2-1.
float srgb_decode(std::uint8_t encoded) {
    const float c = static_cast<float>(encoded) / 255.0F;
    return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
}

glm::vec3 mean_albedo_of(const Material& material) {
    const glm::vec3 factor(material.base_colour);
    const Image* image = material.base_colour_texture.get();
    if (image == nullptr || image->texels.empty()) {
        return factor;
    }
    std::array<double, 256> decoded{};
    for (std::size_t i = 0; i < decoded.size(); ++i) {
        decoded[i] = srgb_decode(static_cast<std::uint8_t>(i));
    }
    glm::dvec3 sum(0.0);
    for (const glm::u8vec4& texel : image->texels) {
        sum += glm::dvec3(decoded[texel.r], decoded[texel.g], decoded[texel.b]);
    }
    return factor * glm::vec3(sum / static_cast<double>(image->texels.size()));
}

}  // namespace

std::uint32_t MaterialTable::index_of(const std::shared_ptr<const Material>& material) {
    const auto [found, is_new] =
        material_index_.try_emplace(material.get(), static_cast<std::uint32_t>(materials_.size()));
    if (!is_new) {
        return found->second;
    }
    const MaterialImages images{.base_colour = add_image(material->base_colour_texture),
                                .emissive = add_image(material->emissive_texture)};
    const UploadedImage& colour = images_[images.base_colour];
    const UploadedImage& emissive = images_[images.emissive];
    materials_.push_back(material);
    images_of_.push_back(images);
    mean_albedos_.push_back(mean_albedo_of(*material));
    records_.push_back({.base_colour = material->base_colour,
                        .first_texel = colour.first_texel,
                        .texel_width = colour.width,
                        .texel_height = colour.height,
                        .flags = material_flags(*material),
                        .alpha_cutoff = is_masked(*material) ? material->alpha_cutoff : 0.0F,
                        .first_emissive_texel = emissive.first_texel,
                        .emissive_width = emissive.width,
                        .emissive_height = emissive.height,
                        .emissive = material->emissive});
    return found->second;
}

std::uint32_t MaterialTable::add_image(const std::shared_ptr<const Image>& image) {
    if (!image) {
        return 0;
    }
    const auto [found, is_new] =
        image_index_.try_emplace(image.get(), static_cast<std::uint32_t>(images_.size()));
    if (!is_new) {
        return found->second;
    }
    const Image reduced = reduce(*image);
    images_.push_back({.texture = upload_texture(*gpu_, *image),
                       .first_texel = static_cast<std::uint32_t>(texels_.size()),
                       .width = reduced.width,
                       .height = reduced.height});
    std::transform(reduced.texels.begin(), reduced.texels.end(), std::back_inserter(texels_), pack);
    return found->second;
}

std::shared_ptr<const MaterialTexture> MaterialTable::texture(std::uint32_t image) const {
    return images_[image].texture;
}

}  // namespace candela
