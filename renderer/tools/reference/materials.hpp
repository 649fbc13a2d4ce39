#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <candela/scene/components.hpp>
#include "renderer/tools/reference/bsdf.hpp"

namespace candela::reference {

/// An image, decoded to linear light.
class Texture {
 public:
    explicit Texture(const Image& image);
    /// Bilinear; the origin of `uv` is the top left corner of the image. There is no minification filter: a
    /// texture finer than the pixels is sampled at pixel centres, like everything else.
    [[nodiscard]] glm::vec4 at(glm::vec2 uv) const;

 private:
    [[nodiscard]] glm::vec4 texel(int x, int y) const;

    glm::ivec2 size_;
    Wrap wrap_u_;
    Wrap wrap_v_;
    std::vector<glm::vec4> texels_;
};

/// Where the images of a material lie: by the first texture coordinates, or by the second.
struct ImagePlace {
    glm::vec2 first;
    glm::vec2 second;  ///< the first again if no image needs it

    [[nodiscard]] glm::vec2 of(bool by_second) const { return by_second ? second : first; }
};

/// The material of a surface.
struct SurfaceMaterial {
    glm::vec4 base_colour;
    std::shared_ptr<const Texture> texture;  ///< null: none
    glm::vec3 emissive;
    std::shared_ptr<const Texture> emissive_texture;  ///< null: none
    bool double_sided;
    AlphaMode alpha_mode;      ///< blended if it is seen through
    AlphaMode own_alpha_mode;  ///< the material's
    float transmission;
    float alpha_cutoff;
    bool is_glossy;
    float metalness;
    float roughness;
    glm::vec3 dielectric_f0;  ///< reflectance of what is not metal for light along the normal
    float specular;           ///< the same for light that grazes it
    std::shared_ptr<const Texture> metal_roughness_texture;  ///< null: none
    std::shared_ptr<const Texture> normal_texture;           ///< null: none
    float normal_scale;
    std::shared_ptr<const Texture> occlusion_texture;  ///< null: none
    float occlusion_strength;
    SecondUvUse by_second;
    bool needs_second_uvs;

    /// Linear RGB, with alpha.
    [[nodiscard]] glm::vec4 colour(glm::vec2 uv) const {
        return texture ? base_colour * texture->at(uv) : base_colour;
    }
    /// Radiance that it emits.
    [[nodiscard]] glm::vec3 emission(const ImagePlace& place) const {
        if (!emissive_texture) return emissive;
        return emissive * glm::vec3(emissive_texture->at(place.of(by_second.emissive)));
    }
    /// What it looks like where its base colour is `colour`.
    [[nodiscard]] Gloss gloss(glm::vec3 colour, const ImagePlace& place) const;
    /// Normal in the space of tangent, bitangent and normal, not of unit length. There must be a texture.
    [[nodiscard]] glm::vec3 bump(const ImagePlace& place) const;
    /// The share of the light from emitters, the sky and other surfaces that reaches it.
    [[nodiscard]] float openness(const ImagePlace& place) const;
    /// The share of what is behind that a surface that is seen through hides, but for what glass lets
    /// through.
    [[nodiscard]] float cover(float alpha) const {
        if (own_alpha_mode == AlphaMode::blend) return alpha;
        return own_alpha_mode == AlphaMode::mask && alpha < alpha_cutoff ? 0.0F : 1.0F;
    }
    [[nodiscard]] bool is_hole(glm::vec4 colour) const {
        return alpha_mode == AlphaMode::mask && colour.a < alpha_cutoff;
    }
};

/// The materials of a scene; every image is decoded once.
class MaterialList {
 public:
    /// The index of the material in the list; adds it if it is new.
    [[nodiscard]] std::uint32_t index_of(const std::shared_ptr<const Material>& material);
    [[nodiscard]] std::vector<SurfaceMaterial> take() { return std::move(materials_); }

 private:
    [[nodiscard]] std::shared_ptr<const Texture> texture_of(const std::shared_ptr<const Image>& image);

    std::vector<SurfaceMaterial> materials_;
    std::unordered_map<const Material*, std::uint32_t> index_;
    std::unordered_map<const Image*, std::shared_ptr<const Texture>> textures_;
};

}  // namespace candela::reference
