#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include <candela/scene/components.hpp>
#include "renderer/gpu/gpu.hpp"
#include "shaders/bindings.glsl"

namespace candela {

/// An image that a material may have, and the unit where shaders sample it.
struct MaterialImageSlot {
    std::shared_ptr<const Image> Material::*image;
    GLuint unit;
};
/// All of them. What is kept for the images of a material is an array with an element for each slot.
inline constexpr std::array material_image_slots{
    MaterialImageSlot{&Material::base_colour_texture, UNIT_BASE_COLOUR},
    MaterialImageSlot{&Material::emissive_texture, UNIT_EMISSION},
    MaterialImageSlot{&Material::metal_roughness_texture, UNIT_METAL_ROUGHNESS},
    MaterialImageSlot{&Material::normal_texture, UNIT_NORMAL_MAP},
    MaterialImageSlot{&Material::occlusion_texture, UNIT_OCCLUSION}};
inline constexpr std::size_t base_colour_slot = 0;
inline constexpr std::size_t emissive_slot = 1;
inline constexpr std::size_t metal_roughness_slot = 2;
inline constexpr std::size_t normal_slot = 3;

/// An image of a material on the GPU, with mip levels; the sampler has its wrap modes.
struct MaterialTexture {
    gl::Texture texture;
    gl::Sampler sampler;
};

/// How surfaces of the material are drawn: all that are seen through are blended.
[[nodiscard]] inline AlphaMode drawn_alpha(const Material& material) {
    return is_seen_through(material) ? AlphaMode::blend : material.alpha_mode;
}

/// Which kinds of surfaces there may be, by drawn_alpha.
struct SurfaceKinds {
    bool opaque = false;
    bool masked = false;
    bool blended = false;

    void add(AlphaMode alpha) {
        opaque |= alpha == AlphaMode::opaque;
        masked |= alpha == AlphaMode::mask;
        blended |= alpha == AlphaMode::blend;
    }
    [[nodiscard]] bool any() const { return opaque || masked || blended; }
    bool operator==(const SurfaceKinds&) const = default;
};

/// What draws with a material need besides its record in the buffer of materials, which has its factors.
/// Materials that differ in nothing but factors have equal bindings, and one call draws all their meshes.
struct MaterialBinding {
    AlphaMode alpha = AlphaMode::opaque;  ///< drawn_alpha
    bool double_sided = false;
    bool emits = false;
    /// By slot; null: white.
    std::array<std::shared_ptr<const MaterialTexture>, material_image_slots.size()> textures;

    /// Binds the textures.
    void bind(const Gpu& gpu) const;
    bool operator==(const MaterialBinding&) const = default;
};

}  // namespace candela
