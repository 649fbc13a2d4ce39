// Material::transmission in the reference against closed forms.

#include <doctest/doctest.h>

#include "tests/glass.hpp"
#include "tests/reference/pictures.hpp"

TEST_SUITE("reference: glass") {

using namespace candela;

namespace {

constexpr glm::vec3 green(0.2F, 0.9F, 0.5F);
constexpr glm::vec3 red(0.8F, 0.4F, 0.25F);

glm::dvec3 seen(const Scene& scene) {
    const reference::Estimate estimate =
        trace(reference::Scene(scene.world), scene.camera, {.size = {3, 3}, .samples = 2});
    return glm::dvec3(total(estimate).pixels[4]);
}

void check_close(glm::dvec3 found, glm::dvec3 expected) {
    for (int i = 0; i < 3; ++i) CHECK(found[i] == doctest::Approx(expected[i]).epsilon(1e-4));  // floats
}

}  // namespace

TEST_CASE("the light behind, times colour and transmission, and what is not mirrored") {
    for (const float specular : {0.0F, 1.0F}) {
        for (const float angle : {0.0F, 1.0F}) {
            Scene scene = bright_wall(angle);
            add_pane(scene.world, 0.0F, glass(green, 0.6F, specular));
            check_close(seen(scene), glm::dvec3(wall_radiance) *
                                         let_through(green, 0.6F, specular, static_cast<double>(angle)));
        }
    }
}

TEST_CASE("panes multiply, and alpha covers what they let through") {
    Scene scene = bright_wall();
    add_pane(scene.world, -0.5F, glass(red, 0.7F));
    Material material = glass(green, 1.0F, 1.0F);
    const Entity near = add_pane(scene.world, 0.5F, material);
    const glm::dvec3 behind = glm::dvec3(wall_radiance) * let_through(red, 0.7F);
    const glm::dvec3 tint = let_through(green, 1.0F, 1.0F);
    check_close(seen(scene), behind * tint);
    const auto with = [&](AlphaMode mode) {
        material.base_colour.a = 0.25F;
        material.alpha_mode = mode;
        scene.world.set(near, MeshInstance{square(20.0F, std::make_shared<const Material>(material))});
        return seen(scene);
    };
    check_close(with(AlphaMode::opaque), behind * tint);
    check_close(with(AlphaMode::mask), behind);
    check_close(with(AlphaMode::blend), behind * (0.75 + 0.25 * tint));
}

TEST_CASE("the sky is seen through glass") {
    Scene scene;
    Environment sky;
    sky.radiance = wall_radiance;
    add(scene.world, sky);
    add_pane(scene.world, 0.0F, glass(green, 1.0F));
    scene.camera = add(scene.world, looking({0, 0, 2}, {0, 0, 0}), Camera{});
    check_close(seen(scene), glm::dvec3(wall_radiance) * let_through(green, 1.0F));
}

}  // TEST_SUITE("reference: glass")
