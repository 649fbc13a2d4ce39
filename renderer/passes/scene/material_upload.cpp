#include "renderer/passes/scene/material_upload.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <glm/common.hpp>
#include <glm/packing.hpp>
#include <iterator>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "engine/scene/decoded.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/mirror_shares.hpp"
#include "renderer/passes/scene/mask_levels.hpp"
#include "renderer/passes/scene/normal_levels.hpp"

namespace candela {
namespace {

// Most texels along the longer side of an image for traced rays, unless it has alpha: a diffuse bounce blurs
// finer detail.
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

gl::SamplerDesc sampler_of(const Image& image) {
    return {.min_filter = GL_LINEAR_MIPMAP_LINEAR,
            .wrap_u = wrap_mode(image.wrap_u),
            .wrap_v = wrap_mode(image.wrap_v),
            .anisotropy = 8.0F};
}

/// The image on the GPU, without what its mip levels contain.
MaterialTexture make_texture(Gpu& gpu, const Image& image) {
    const TextureDesc desc{
        .size = {image.width, image.height},
        .format = image.encoding == Encoding::srgb ? Format::srgb8_alpha8 : Format::rgba8,
        .mips = static_cast<std::uint32_t>(std::bit_width(std::max(image.width, image.height)))};
    gl::Texture texture(gpu.device(), "material", desc);
    gl::Sampler sampler(gpu.device(), "material", sampler_of(image));
    return {std::move(texture), std::move(sampler)};
}

std::vector<glm::u8vec4> read_level(const gl::Texture& texture, std::uint32_t level) {
    const std::vector<std::byte> read = texture.read(level);
    std::vector<glm::u8vec4> texels(read.size() / sizeof(glm::u8vec4));
    std::memcpy(texels.data(), read.data(), read.size());
    return texels;
}

/// Makes mip levels cover as much as the image, up to the last one that can.
void keep_coverage(Gpu& gpu, MaterialTexture& made, const Image& image, float cutoff) {
    const float share = coverage(image, cutoff);
    if (share == 0.0F || share == 1.0F) return;
    std::uint32_t level = 1;
    for (; level < made.texture.desc().mips; ++level) {
        const glm::uvec2 size = made.texture.level_size(level);
        const auto kept = with_coverage({.width = size.x,
                                         .height = size.y,
                                         .texels = read_level(made.texture, level),
                                         .wrap_u = image.wrap_u,
                                         .wrap_v = image.wrap_v},
                                        cutoff, share);
        if (!kept) break;
        made.texture.upload(std::as_bytes(std::span(kept->texels)), level);
    }
    // More anisotropic samples would have the mean of holes and of what is between them.
    gl::SamplerDesc sampler = sampler_of(image);
    sampler.anisotropy = 1.0F;
    sampler.last_level = level - 1;
    made.sampler = gl::Sampler(gpu.device(), "mask", sampler);
}

MaterialTexture upload_texture(Gpu& gpu, const Image& image, float cutoff) {
    MaterialTexture made = make_texture(gpu, image);
    made.texture.upload(std::as_bytes(std::span(image.texels)));
    made.texture.generate_mips();
    if (cutoff > 0.0F) keep_coverage(gpu, made, image, cutoff);
    return made;
}

MaterialTexture upload_normals(Gpu& gpu, const Image& image, const std::vector<NormalLevel>& levels) {
    MaterialTexture made = make_texture(gpu, image);
    for (std::uint32_t i = 0; i < levels.size(); ++i) {
        made.texture.upload(std::as_bytes(std::span(levels[i])), i);
    }
    return made;
}

bool is_opaque(const Image& image) {
    return std::ranges::all_of(image.texels, [](const glm::u8vec4& texel) { return texel.a == 255; });
}

std::uint32_t pack(const glm::u8vec4& texel) {
    return texel.r | static_cast<std::uint32_t>(texel.g) << 8U | static_cast<std::uint32_t>(texel.b) << 16U |
           static_cast<std::uint32_t>(texel.a) << 24U;
}

/// The largest mip level that is small enough for traced rays.
std::uint32_t traced_level(const Image& image) {
    std::uint32_t level = 0;
    while (std::max(image.width, image.height) >> level > traced_image_size) ++level;
    return level;
}

/// Sets what traced rays see of an image to its texels at a mip level.
void set_traced(UploadedImage& uploaded, std::uint32_t level, std::span<const glm::u8vec4> texels) {
    uploaded.width = std::max(uploaded.image->width >> level, 1U);
    uploaded.height = std::max(uploaded.image->height >> level, 1U);
    uploaded.texels.reserve(texels.size());
    std::ranges::transform(texels, std::back_inserter(uploaded.texels), pack);
    uploaded.range.count = static_cast<std::uint32_t>(texels.size());
}

/// One with alpha stays as it is: the shadows of masked surfaces are found by rays.
void set_traced_colours(UploadedImage& uploaded) {
    const Image& image = *uploaded.image;
    const std::uint32_t level = traced_level(image);
    if (level == 0 || !is_opaque(image)) return set_traced(uploaded, 0, image.texels);
    set_traced(uploaded, level, read_level(uploaded.texture->texture, level));
}

std::uint32_t wrap_bits(const Image* image) {
    if (image == nullptr) return 0;
    return static_cast<std::uint32_t>(image->wrap_u) | static_cast<std::uint32_t>(image->wrap_v)
                                                           << MATERIAL_WRAP_BITS;
}

std::uint32_t second_uv_flags(const Material& material) {
    const SecondUvUse& use = material.second_uvs;
    return (use.emissive && material.emissive_texture ? MATERIAL_SECOND_UV_EMISSIVE : 0U) |
           (use.metal_roughness && material.metal_roughness_texture ? MATERIAL_SECOND_UV_GLOSS : 0U) |
           (use.normal && material.normal_texture ? MATERIAL_SECOND_UV_NORMAL : 0U) |
           (use.occlusion && material.occlusion_texture ? MATERIAL_SECOND_UV_OCCLUSION : 0U);
}

std::uint32_t material_flags(const Material& material) {
    const bool ignores_alpha = material.transmission > 0.0F && material.alpha_mode != AlphaMode::blend;
    return (material.double_sided ? MATERIAL_DOUBLE_SIDED : 0U) |
           (ignores_alpha ? MATERIAL_ALPHA_IGNORED : 0U) |
           wrap_bits(material.base_colour_texture.get()) << MATERIAL_BASE_COLOUR_WRAP_SHIFT |
           wrap_bits(material.emissive_texture.get()) << MATERIAL_EMISSIVE_WRAP_SHIFT |
           wrap_bits(material.normal_texture.get()) << MATERIAL_NORMAL_WRAP_SHIFT | second_uv_flags(material);
}

bool is_masked(const Material& material) {
    return material.alpha_mode == AlphaMode::mask;
}

/// Mean of the channels of an image, decoded; 1 if it is empty.
glm::vec3 mean_of(const Image& image) {
    if (image.texels.empty()) return glm::vec3(1.0F);
    const std::array<double, 256> decoded = decoded_values(image.encoding);
    glm::dvec3 sum(0.0);
    for (const glm::u8vec4& texel : image.texels) {
        sum += glm::dvec3(decoded[texel.r], decoded[texel.g], decoded[texel.b]);
    }
    return glm::vec3(sum / static_cast<double>(image.texels.size()));
}

ImageUse use_of(const Material& material, std::size_t slot) {
    const float alpha = material.base_colour.a;
    const bool has_holes = slot == base_colour_slot && is_masked(material) && alpha > 0.0F;
    return {.image = (material.*material_image_slots[slot].image).get(),
            .normals = slot == normal_slot,
            .cutoff = has_holes ? material.alpha_cutoff / alpha : 0.0F};
}

void upload_normal_image(Gpu& gpu, UploadedImage& uploaded) {
    const Image& image = *uploaded.image;
    const std::vector<NormalLevel> levels = normal_levels(image);
    uploaded.texture = std::make_shared<const MaterialTexture>(upload_normals(gpu, image, levels));
    const std::uint32_t level = traced_level(image);
    set_traced(uploaded, level, levels[level]);
}

/// Only colours are for tracing.
void upload_colour_image(Gpu& gpu, UploadedImage& uploaded, float cutoff) {
    const Image& image = *uploaded.image;
    uploaded.texture = std::make_shared<const MaterialTexture>(upload_texture(gpu, image, cutoff));
    uploaded.mean = mean_of(image);
    if (image.encoding == Encoding::srgb) set_traced_colours(uploaded);
}

/// The reflectance of what is not metal in the mirror direction, where it faces the viewer and (alpha) at
/// grazing angles: KHR_materials_specular, with that of an interface to air by Fresnel.
glm::vec4 mirror_of(const Material& material) {
    const float ratio = (material.ior - 1.0F) / (material.ior + 1.0F);
    return material.specular *
           glm::vec4(glm::min(ratio * ratio * material.specular_colour, glm::vec3(1.0F)), 1.0F);
}

float largest_of(const glm::vec3& v) {
    return std::max({v.r, v.g, v.b});
}

/// A Lambertian surface that reflects as much light as a glossy one, of light from all sides: its albedo is
/// `share` times the base colour plus `mirror`.
struct TracedReflection {
    glm::vec3 mirror{0.0F};
    float share = 1.0F;
};

TracedReflection traced_reflection(const Material& material, float metalness, float roughness) {
    if (!is_glossy(material)) return {};
    const glm::vec3 shares = mean_mirror_shares(roughness);
    const glm::vec4 mirror = mirror_of(material);
    const glm::vec3 facing(mirror);
    const glm::vec3 fresnel = glm::mix(facing, glm::vec3(mirror.a), shares.z);
    const glm::vec3 mirrored = shares.x * facing + shares.y * mirror.a;
    // At most what is not mirrored: by the specification's formula, smooth white surfaces would reflect more
    // light than they receive.
    const float diffuse = 1.0F - largest_of(glm::max(fresnel, mirrored));
    return {(1.0F - metalness) * mirrored + metalness * shares.y,
            (1.0F - metalness) * diffuse + metalness * shares.x};
}

void warn_of_gain(Log& log, const Material& material) {
    if (largest_of(glm::vec3(material.base_colour)) > 1.0F) {
        log.warn(fmt::format("material \"{}\"", material.name),
                 "its base colour is above 1, as if it reflected more light than it receives; light that is "
                 "reflected more than once is bounded");
    }
}

}  // namespace

std::uint32_t MaterialTable::take(const std::shared_ptr<const Material>& material) {
    return materials_.take(material.get(), [&] {
        warn_of_gain(gpu_->log(), *material);
        Listed listed{.material = material};
        for (std::size_t slot = 0; slot < material_image_slots.size(); ++slot) {
            listed.images[slot] = number_of(*material, slot);
        }
        return listed;
    });
}

/// The number of the image in a slot of a material. Normals and masks have mip levels of their own, also of
/// an image that is used for something else, too.
std::uint32_t MaterialTable::number_of(const Material& material, std::size_t slot) {
    const ImageUse use = use_of(material, slot);
    if (use.image == nullptr) return 0;
    const auto upload_image = [&] {
        UploadedImage uploaded;
        uploaded.image = material.*material_image_slots[slot].image;
        if (use.normals) {
            upload_normal_image(*gpu_, uploaded);
        } else {
            upload_colour_image(*gpu_, uploaded, use.cutoff);
        }
        return uploaded;
    };
    return images_.take(use, upload_image) + 1;
}

void MaterialTable::drop_unused() {
    materials_.drop_unused([&](std::uint32_t index) {
        const Material& material = *materials_[index].material;
        for (std::size_t slot = 0; slot < material_image_slots.size(); ++slot) {
            const ImageUse use = use_of(material, slot);
            if (use.image != nullptr) images_.release(use);
        }
        dropped_.push_back(index);
    });
    images_.drop_unused([&](std::uint32_t number) { texel_places_.take_back(images_[number].range); });
}

const UploadedImage& MaterialTable::image_of(const Listed& listed, std::size_t slot) const {
    static const UploadedImage none{};
    const std::uint32_t number = listed.images[slot];
    return number == 0 ? none : images_[number - 1];
}

glm::vec3 MaterialTable::mean_albedo(std::uint32_t material) const {
    const Listed& listed = materials_[material];
    const gpu::Material record = record_of(listed);
    return record.traced_share * glm::vec3(record.base_colour) * mean_of_image(listed, base_colour_slot) +
           record.traced_mirror;
}

/// Mean of a material's image; 1 if it has none.
glm::vec3 MaterialTable::mean_of_image(const Listed& listed, std::size_t slot) const {
    return listed.images[slot] == 0 ? glm::vec3(1.0F) : image_of(listed, slot).mean;
}

MaterialBinding MaterialTable::binding_of(std::uint32_t material) const {
    const Listed& listed = materials_[material];
    MaterialBinding binding{.alpha = drawn_alpha(*listed.material),
                            .double_sided = listed.material->double_sided,
                            .emits = emits(*listed.material),
                            .textures = {}};
    for (std::size_t slot = 0; slot < binding.textures.size(); ++slot) {
        binding.textures[slot] = image_of(listed, slot).texture;
    }
    return binding;
}

gpu::Material MaterialTable::record_of(const Listed& listed) const {
    if (!listed.material) return {};
    const Material& material = *listed.material;
    const UploadedImage& colour = image_of(listed, base_colour_slot);
    const UploadedImage& emissive = image_of(listed, emissive_slot);
    const UploadedImage& normals = image_of(listed, normal_slot);
    const glm::vec3 gloss = mean_of_image(listed, metal_roughness_slot);
    const glm::vec2 mean_gloss(material.roughness * gloss.g, material.metalness * gloss.b);
    const TracedReflection traced = traced_reflection(material, mean_gloss.y, mean_gloss.x);
    return {.base_colour = material.base_colour,
            .first_texel = colour.range.first,
            .texel_width = colour.width,
            .texel_height = colour.height,
            .flags = material_flags(material),
            .alpha_cutoff = is_masked(material) ? material.alpha_cutoff : 0.0F,
            .first_emissive_texel = emissive.range.first,
            .emissive_width = emissive.width,
            .emissive_height = emissive.height,
            .emissive = material.emissive,
            .metalness = material.metalness,
            .mirror = mirror_of(material),
            .traced_mirror = traced.mirror,
            .traced_share = traced.share,
            .roughness = material.roughness,
            .normal_scale = material.normal_texture ? material.normal_scale : 0.0F,
            .occlusion_strength = material.occlusion_texture ? material.occlusion_strength : 0.0F,
            .mean_gloss = glm::packHalf2x16(mean_gloss),
            .first_normal_texel = normals.range.first,
            .normal_width = normals.width,
            .normal_height = normals.height,
            .transmission = material.transmission};
}

void MaterialTable::upload(Execution& run, BufferHandle<gpu::Material> materials,
                           BufferHandle<std::uint32_t> texels, SceneLayout& layout) {
    std::vector<std::uint32_t> changed = materials_.take_added();
    changed.insert(changed.end(), dropped_.begin(), dropped_.end());
    dropped_.clear();
    layout.materials.resize(materials_.size());
    for (const std::uint32_t index : changed) layout.materials.set(index, materials_[index].material);

    // Records contain where texels are.
    const bool other_texels = upload_texels(run, texels);
    if (reserve_more(run, materials, materials_.size()) || other_texels) {
        changed.resize(materials_.size());
        std::iota(changed.begin(), changed.end(), 0U);
    }
    std::ranges::sort(changed);
    BufferWriter<gpu::Material> writer(*gpu_, run.object(materials));
    for (const std::uint32_t index : changed) {
        writer.seek(index);
        writer.push_back(record_of(materials_[index]));
    }
    writer.flush();
}

/// Returns whether any that were there have got other places.
bool MaterialTable::upload_texels(Execution& run, BufferHandle<std::uint32_t> texels) {
    std::vector<UploadedImage*> images;
    const auto add = [&](UploadedImage& image) { images.push_back(&image); };
    const auto ranges = [&] {
        std::vector<BufferRange*> all;
        all.reserve(images.size());
        for (UploadedImage* image : images) all.push_back(&image->range);
        return all;
    };
    for (const std::uint32_t number : images_.take_added()) add(images_[number]);
    const bool moved = place_ranges(run, texels, texel_places_, ranges(), [&] {
        images.clear();
        images_.visit(add);
        return ranges();
    });
    upload_ranges(*gpu_, run, texels, ranges(), [&](std::size_t i, BufferWriter<std::uint32_t>& writer) {
        writer.append(images[i]->texels);
    });
    return moved;
}

}  // namespace candela
