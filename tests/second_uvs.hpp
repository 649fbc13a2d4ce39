#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <candela/scene/components.hpp>
#include <candela/scene/tangents.hpp>

namespace candela {

// Patches whose images but that of the base colour are found in two ways: moved by second texture
// coordinates, or moved themselves. Both look the same.

/// By how much of their size the images are moved.
inline constexpr glm::vec2 uv_shift{0.25F, 0.5F};

/// 4 × 4 texels of random values of at least `least`, moved by `uv_shift` if wanted.
inline std::shared_ptr<const Image> pattern(std::uint32_t seed, Encoding encoding, bool moved,
                                            int least = 0) {
    constexpr std::size_t side = 4;
    std::minstd_rand random(seed);
    const auto value = [&] {
        return static_cast<std::uint8_t>(least +
                                         static_cast<int>(random() % (256U - static_cast<unsigned>(least))));
    };
    std::vector<glm::u8vec4> texels(side * side);
    for (glm::u8vec4& texel : texels) {
        texel.r = value();
        texel.g = value();
        texel.b = value();
        texel.a = 255;
    }
    Image image{.width = side, .height = side, .texels = texels, .encoding = encoding};
    for (std::size_t y = 0; y < side && moved; ++y) {
        for (std::size_t x = 0; x < side; ++x) {
            image.texels[y * side + x] = texels[(y + 2) % side * side + (x + 1) % side];
        }
    }
    return std::make_shared<const Image>(std::move(image));
}

/// The same for normals, whose slopes are at most about 1/4.
inline std::shared_ptr<const Image> normal_pattern(std::uint32_t seed, bool moved) {
    Image image = *pattern(seed, Encoding::linear, moved);
    for (glm::u8vec4& texel : image.texels) {
        texel = {static_cast<std::uint8_t>(96 + texel.r / 4), static_cast<std::uint8_t>(96 + texel.g / 4),
                 255, 255};
    }
    return std::make_shared<const Image>(std::move(image));
}

/// How the images of a patch are moved.
enum class Moved : std::uint8_t { not_at_all, by_second_uvs, by_images };

/// Every kind of image.
inline Material patterned(Moved moved) {
    const bool images = moved == Moved::by_images;
    Material material;
    material.base_colour_texture = pattern(1, Encoding::srgb, false);
    material.emissive = glm::vec3(1.0F);
    material.emissive_texture = pattern(2, Encoding::srgb, images);
    material.metalness = 0.6F;
    material.roughness = 0.9F;
    material.metal_roughness_texture = pattern(3, Encoding::linear, images, 100);
    material.normal_texture = normal_pattern(4, images);
    material.occlusion_texture = pattern(5, Encoding::linear, images);
    material.double_sided = true;
    if (moved == Moved::by_second_uvs) material.second_uvs = {true, true, true, true};
    return material;
}

/// The mesh with this material and the second texture coordinates that move its images.
inline std::shared_ptr<const Mesh> patch_of(Mesh mesh, Material material) {
    Primitive& primitive = mesh.primitives[0];
    primitive.material = std::make_shared<const Material>(std::move(material));
    if (uses_second_uvs(*primitive.material)) {
        for (const Vertex& vertex : primitive.vertices) primitive.second_uvs.push_back(vertex.uv + uv_shift);
    }
    derive_tangents(primitive);
    return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace candela
