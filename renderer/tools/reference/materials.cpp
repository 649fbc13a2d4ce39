#include "renderer/tools/reference/materials.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace candela::reference {

namespace {

/// Decodes sRGB: IEC 61966-2-1.
float linear(std::uint8_t encoded) {
    const double value = encoded / 255.0;
    return static_cast<float>(value > 0.04045 ? std::pow((value + 0.055) / 1.055, 2.4) : value / 12.92);
}

glm::vec4 decode(glm::u8vec4 texel, Encoding encoding) {
    if (encoding == Encoding::linear) return glm::vec4(texel) / 255.0F;
    return {linear(texel.r), linear(texel.g), linear(texel.b), static_cast<float>(texel.a) / 255.0F};
}

/// KHR_materials_ior and KHR_materials_specular.
glm::vec3 dielectric_f0(const Material& material) {
    const float root = (material.ior - 1.0F) / (material.ior + 1.0F);
    return material.specular * glm::min(root * root * material.specular_colour, glm::vec3(1.0F));
}

/// Wraps `i` into [0, count).
int wrapped(int i, int count, Wrap mode) {
    if (mode == Wrap::clamp_to_edge) return std::clamp(i, 0, count - 1);
    const int period = mode == Wrap::repeat ? count : 2 * count;
    const int within = ((i % period) + period) % period;
    return within < count ? within : period - 1 - within;
}

}  // namespace

Texture::Texture(const Image& image)
    : size_(image.width, image.height), wrap_u_(image.wrap_u), wrap_v_(image.wrap_v) {
    texels_.resize(image.texels.size());
    std::ranges::transform(image.texels, texels_.begin(),
                           [&](glm::u8vec4 texel) { return decode(texel, image.encoding); });
}

glm::vec4 Texture::texel(int x, int y) const {
    const int column = wrapped(x, size_.x, wrap_u_);
    const int row = wrapped(y, size_.y, wrap_v_);
    return texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.x) +
                   static_cast<std::size_t>(column)];
}

glm::vec4 Texture::at(glm::vec2 uv) const {
    const glm::vec2 place = uv * glm::vec2(size_) - 0.5F;  // texel centres are at halves
    const glm::vec2 corner = glm::floor(place);
    const glm::vec2 share = place - corner;
    const int x = static_cast<int>(corner.x);
    const int y = static_cast<int>(corner.y);
    const glm::vec4 upper = glm::mix(texel(x, y), texel(x + 1, y), share.x);
    const glm::vec4 lower = glm::mix(texel(x, y + 1), texel(x + 1, y + 1), share.x);
    return glm::mix(upper, lower, share.y);
}

Gloss SurfaceMaterial::gloss(glm::vec3 colour, const ImagePlace& place) const {
    const glm::vec2 uv = place.of(by_second.metal_roughness);
    const glm::vec4 texel = metal_roughness_texture ? metal_roughness_texture->at(uv) : glm::vec4(1.0F);
    const float metal = metalness * texel.b;
    const float rough = roughness * texel.g;
    return {.diffuse = (1.0F - metal) * colour,
            .f0 = glm::mix(dielectric_f0, colour, metal),
            .f90 = glm::mix(specular, 1.0F, metal),
            .alpha = rough * rough};
}

glm::vec3 SurfaceMaterial::bump(const ImagePlace& place) const {
    const glm::vec3 stored = 2.0F * glm::vec3(normal_texture->at(place.of(by_second.normal))) - 1.0F;
    return {normal_scale * stored.x, normal_scale * stored.y, stored.z};
}

float SurfaceMaterial::openness(const ImagePlace& place) const {
    if (!occlusion_texture) return 1.0F;
    return glm::mix(1.0F, occlusion_texture->at(place.of(by_second.occlusion)).r, occlusion_strength);
}

std::uint32_t MaterialList::index_of(const std::shared_ptr<const Material>& material) {
    const auto [found, is_new] =
        index_.try_emplace(material.get(), static_cast<std::uint32_t>(materials_.size()));
    if (is_new) {
        materials_.push_back(
            {.base_colour = material->base_colour,
             .texture = texture_of(material->base_colour_texture),
             .emissive = material->emissive,
             .emissive_texture = texture_of(material->emissive_texture),
             .double_sided = material->double_sided,
             .alpha_mode = is_seen_through(*material) ? AlphaMode::blend : material->alpha_mode,
             .own_alpha_mode = material->alpha_mode,
             .transmission = material->transmission,
             .alpha_cutoff = material->alpha_cutoff,
             .is_glossy = candela::is_glossy(*material),
             .metalness = material->metalness,
             .roughness = material->roughness,
             .dielectric_f0 = dielectric_f0(*material),
             .specular = material->specular,
             .metal_roughness_texture = texture_of(material->metal_roughness_texture),
             .normal_texture = texture_of(material->normal_texture),
             .normal_scale = material->normal_scale,
             .occlusion_texture = texture_of(material->occlusion_texture),
             .occlusion_strength = material->occlusion_strength,
             .by_second = material->second_uvs,
             .needs_second_uvs = uses_second_uvs(*material)});
    }
    return found->second;
}

std::shared_ptr<const Texture> MaterialList::texture_of(const std::shared_ptr<const Image>& image) {
    if (!image) return nullptr;
    std::shared_ptr<const Texture>& texture = textures_[image.get()];
    if (!texture) texture = std::make_shared<const Texture>(*image);
    return texture;
}

}  // namespace candela::reference
