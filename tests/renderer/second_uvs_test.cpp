// Images by second texture coordinates against the same images, moved.

#include <doctest/doctest.h>

#include <tuple>

#include <candela/scene/deformed_mesh.hpp>
#include "tests/renderer/path_fixture.hpp"
#include "tests/second_uvs.hpp"

TEST_SUITE("second texture coordinates") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{32, 24};

/// A square of 2 m × 2 m, from above at a slant, and a light.
Scene patch_under_light(const Material& material) {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{patch_of(*square(1.0F, nullptr), material)});
    scene.light = add(scene.world, at({0.3F, 1.5F, 0.2F}), PointLight{.intensity = 3.0F});
    scene.camera = add(scene.world, looking({0.4F, 2.0F, 1.2F}, {0, 0, 0}), Camera{});
    return scene;
}

/// The patch as a lamp above a ground that is a mirror or diffuse, which alone is seen.
Scene ground_under_patch(const Material& patch, float metalness, float roughness) {
    Scene scene;
    Material ground = *diffuse(glm::vec3(0.8F));
    ground.metalness = metalness;
    ground.roughness = roughness;
    add(scene.world, Transform{}, MeshInstance{square(2.0F, std::make_shared<const Material>(ground))});
    add(scene.world, upside_down_at({0, 1.5F, 0}), MeshInstance{patch_of(*square(1.0F, nullptr), patch)});
    scene.light = add(scene.world, at({0.5F, 0.7F, 0.0F}), PointLight{.intensity = 1.0F});
    scene.camera = add(scene.world, looking({0, 1.0F, 2.5F}, {0, 0, 0}), Camera{});
    return scene;
}

/// Software rasterisers filter images with weights of 8 bits, so that each value may be off by 1/256, and a
/// highlight by a few times as much.
constexpr double rounding = 1e-4;  // 1 % squared
/// Of pictures with an image in another place.
constexpr double other = 10.0 * rounding;

}  // namespace

TEST_CASE_FIXTURE(PathFixture, "every path shows every image where it belongs") {
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(path);
        configure(linear_configuration(path));
        const Picture moved = render(patch_under_light(patterned(Moved::by_second_uvs)), size);
        const Picture expected = render(patch_under_light(patterned(Moved::by_images)), size);
        CHECK(mean(expected) > 0.1);
        CHECK(relative_mean_square(moved, expected) < rounding);
    }
    // That depends on each of the images.
    configure(linear_configuration());
    const Picture expected = render(patch_under_light(patterned(Moved::by_images)), size);
    for (bool SecondUvUse::*image :
         {&SecondUvUse::emissive, &SecondUvUse::metal_roughness, &SecondUvUse::normal}) {
        Material material = patterned(Moved::by_second_uvs);
        material.second_uvs.*image = false;
        CHECK(relative_mean_square(render(patch_under_light(material), size), expected) > other);
    }
}

TEST_CASE_FIXTURE(PathFixture, "occlusion by them, and blended surfaces") {
    const auto picture = [&](Moved moved, AlphaMode alpha) {
        Material material = patterned(moved);
        material.alpha_mode = alpha;
        material.base_colour.a = 0.6F;
        Scene scene = patch_under_light(material);
        Environment sky;
        sky.radiance = glm::vec3(1.0F);
        add(scene.world, sky);
        return render(scene, size);
    };
    configure(linear_configuration());
    for (const AlphaMode alpha : {AlphaMode::opaque, AlphaMode::blend}) {
        const Picture expected = picture(Moved::by_images, alpha);
        CHECK(relative_mean_square(picture(Moved::by_second_uvs, alpha), expected) < rounding);
        CHECK(relative_mean_square(picture(Moved::not_at_all, alpha), expected) > other);
    }
}

TEST_CASE_FIXTURE(RenderFixture, "mirrors show emission and bumps where they belong") {
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 64;
    configure(configuration);
    const Picture moved = render(ground_under_patch(patterned(Moved::by_second_uvs), 1.0F, 0.0F), size);
    const Picture expected = render(ground_under_patch(patterned(Moved::by_images), 1.0F, 0.0F), size);
    CHECK(mean(expected) > 0.01);
    // The rays are the same, and the light of surfels differs as below.
    CHECK(relative_mean_square(moved, expected) < 1e-4);
    const Picture unmoved = render(ground_under_patch(patterned(Moved::not_at_all), 1.0F, 0.0F), size);
    CHECK(relative_mean_square(unmoved, expected) > 0.01);
}

TEST_CASE_FIXTURE(RenderFixture, "they light other surfaces with what they emit and reflect there") {
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 256;
    configure(configuration);
    // Of the emission, only one corner of the image is left.
    const auto lamp = [](Moved moved) {
        Material material = patterned(moved);
        Image image = *pattern(2, Encoding::srgb, false);
        for (std::size_t i = 0; i < image.texels.size(); ++i) {
            const std::size_t x = i % 4, y = i / 4;
            const bool lit = moved == Moved::by_images ? x == 3 && y == 2 : x == 0 && y == 0;
            image.texels[i] = glm::u8vec4(lit ? 255 : 0, lit ? 255 : 0, lit ? 255 : 0, 255);
        }
        material.emissive_texture = std::make_shared<const Image>(std::move(image));
        material.emissive = glm::vec3(20.0F);
        return material;
    };
    const Picture moved = render(ground_under_patch(lamp(Moved::by_second_uvs), 0.0F, 1.0F), size);
    const Picture expected = render(ground_under_patch(lamp(Moved::by_images), 0.0F, 1.0F), size);
    CHECK(mean(expected) > 0.01);
    // Points of surfels have the base colour of the nearest texel instead of a bilinear mixture.
    CHECK(relative_mean_square(moved, expected) < 1e-4);
    const Picture unmoved = render(ground_under_patch(lamp(Moved::not_at_all), 0.0F, 1.0F), size);
    CHECK(relative_mean_square(unmoved, expected) > 0.01);
}

TEST_CASE_FIXTURE(RenderFixture,
                  "they come and go with the surfaces that need them, and stay when these are deformed") {
    configure(linear_configuration());
    Scene scene = patch_under_light(patterned(Moved::not_at_all));
    const Entity plain = std::get<0>(*scene.world.view<MeshInstance>().begin());
    const auto mesh = scene.world.get<MeshInstance>(plain).mesh;
    const Picture before = render(scene, size);
    const auto second = patch_of(*square(1.0F, nullptr), patterned(Moved::by_second_uvs));
    scene.world.set(plain, MeshInstance{second});
    const Picture with = render(scene, size);
    CHECK(with == from_scratch(scene, size));
    CHECK(with != before);
    // Vertices of another place in their buffer.
    scene.world.set(plain, DeformedMesh{std::make_shared<const DeformedMesh::Vertices>(
                               1, second->primitives[0].vertices)});
    CHECK(render(scene, size) == with);
    scene.world.remove<DeformedMesh>(plain);
    scene.world.set(plain, MeshInstance{mesh});
    CHECK(render(scene, size) == before);
}

}  // TEST_SUITE("second texture coordinates")
