#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "tests/reference/pictures.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("reference: conventions") {

using namespace candela;
using reference::Estimate;

namespace {

constexpr glm::uvec2 size{33, 33};  // the middle pixel looks along the camera's axis
constexpr std::size_t middle = 33 * 16 + 16;

Estimate traced(const Scene& scene, std::uint32_t samples = 2, std::uint32_t bounces = 0) {
    return trace(reference::Scene(scene.world), scene.camera,
                 {.size = size, .samples = samples, .bounces = bounces});
}

std::shared_ptr<const Material> made_of(glm::vec4 colour, AlphaMode mode, bool double_sided) {
    Material material;
    material.base_colour = colour;
    material.alpha_mode = mode;
    material.double_sided = double_sided;
    return std::make_shared<const Material>(std::move(material));
}

/// A camera 3 m above a ground of albedo 1/2, under a light of π lx from above: the ground has radiance 1/2.
Scene lit_ground() {
    Scene scene = ground();
    scene.world.set(scene.light, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}));
    scene.world.set(scene.light, DirectionalLight{.illuminance = std::numbers::pi_v<float>});
    scene.world.set(scene.camera, looking({0, 3, 0}, {0, 0, 0}, {0, 0, -1}));
    return scene;
}

/// A square of 1 m × 1 m, 1 m above the ground, facing up or down.
Entity add_pane(Scene& scene, std::shared_ptr<const Material> material, bool faces_up = true) {
    const glm::quat turn = glm::angleAxis(faces_up ? 0.0F : std::numbers::pi_v<float>, glm::vec3(1, 0, 0));
    return add(scene.world, Transform{.translation = {0, 1, 0}, .rotation = turn},
               MeshInstance{square(0.5F, std::move(material))});
}

/// The direct light at the middle pixel. It is grey here.
float seen(const Scene& scene) {
    return traced(scene).direct.pixels[middle].g;
}

/// A chequered image of 2 × 2 texels, two of which are holes.
std::shared_ptr<const Material> with_holes() {
    Image image{.width = 2, .height = 2, .texels = {}};
    for (const int alpha : {255, 0, 0, 255}) image.texels.emplace_back(255, 255, 255, alpha);
    Material material;
    material.alpha_mode = AlphaMode::mask;
    material.double_sided = true;
    material.base_colour_texture = std::make_shared<const Image>(std::move(image));
    return std::make_shared<const Material>(std::move(material));
}

}  // namespace

TEST_CASE("the back of a single-sided surface is invisible, but blocks light") {
    Scene scene = lit_ground();
    CHECK(seen(scene) == doctest::Approx(0.5F));
    SUBCASE("single-sided") {
        add_pane(scene, made_of({0.2F, 0.2F, 0.2F, 1}, AlphaMode::opaque, false), false);
        CHECK(seen(scene) == 0.0F);  // sees the ground in the pane's shadow
    }
    SUBCASE("double-sided") {
        add_pane(scene, made_of({0.2F, 0.2F, 0.2F, 1}, AlphaMode::opaque, true), false);
        CHECK(seen(scene) == doctest::Approx(0.2F));
    }
    SUBCASE("from the front") {
        add_pane(scene, made_of({0.2F, 0.2F, 0.2F, 1}, AlphaMode::opaque, false), true);
        CHECK(seen(scene) == doctest::Approx(0.2F));
    }
}

TEST_CASE("the back of a single-sided surface does not reflect bounced light") {
    // A pane above the ground reflects light to the ground only if its front faces down or it is
    // double-sided.
    for (const bool faces_down : {true, false}) {
        for (const bool double_sided : {true, false}) {
            CAPTURE(faces_down);
            CAPTURE(double_sided);
            Scene scene = lit_ground();
            add_pane(scene, made_of(glm::vec4(0.9F), AlphaMode::opaque, double_sided), !faces_down);
            // Next to the pane, where the camera sees lit ground.
            scene.world.set(scene.camera, looking({0.8F, 3, 0}, {0.8F, 0, 0}, {0, 0, -1}));
            const bool reflects = faces_down || double_sided;
            CHECK((traced(scene, 256, 2).indirect.pixels[middle].g > 0.0F) == reflects);
        }
    }
}

TEST_CASE("the camera and light see through the holes of a mask") {
    Scene scene = lit_ground();
    const Entity pane = add_pane(scene, with_holes());
    // Texel centres are a quarter of the square's side away from its middle.
    for (const glm::vec2 aside : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(-1, 1), glm::vec2(1, 1)}) {
        CAPTURE(aside.x);
        CAPTURE(aside.y);
        scene.world.set(pane, Transform{.translation = {0.25F * aside.x, 1, 0.25F * aside.y}});
        const bool is_solid = aside.x * aside.y > 0.0F;
        CHECK(seen(scene) == doctest::Approx(is_solid ? 1.0F : 0.5F));
    }
}

TEST_CASE("a blended surface covers its background by its alpha, and casts no shadow") {
    Scene scene = lit_ground();
    add_pane(scene, made_of({0.2F, 0.2F, 0.2F, 0.25F}, AlphaMode::blend, false));
    CHECK(seen(scene) == doctest::Approx(0.25F * 0.2F + 0.75F * 0.5F));
    add(scene.world, Transform{.translation = {0, 2, 0}},
        MeshInstance{square(0.2F, made_of({0.8F, 0.8F, 0.8F, 0.5F}, AlphaMode::blend, false))});
    CHECK(seen(scene) == doctest::Approx(0.5F * 0.8F + 0.5F * (0.25F * 0.2F + 0.75F * 0.5F)));
}

TEST_CASE("bounced light passes through a blended surface unchanged") {
    Scene scene = furnace_box(0.5F);
    const Estimate without = traced(scene, 16, 3);
    add(scene.world, Transform{.translation = {0, -0.5F, 0}},
        MeshInstance{square(0.3F, made_of({0, 0, 0, 0.9F}, AlphaMode::blend, true))});
    const Estimate with = traced(scene, 16, 3);
    std::size_t same = 0;
    for (std::size_t i = 0; i < with.hit.size(); ++i) {
        same += with.indirect.pixels[i] == without.indirect.pixels[i] ? 1 : 0;
    }
    // All pixels except those that see the pane, which covers about a tenth of the picture.
    CHECK(same > with.hit.size() * 3 / 4);
    CHECK(same < with.hit.size());
}

TEST_CASE("a blended surface receives indirect light itself") {
    Scene scene = lit_ground();
    add_pane(scene, made_of(glm::vec4(0.5F), AlphaMode::blend, false), false);
    // Seen from below, the pane shows its front, which faces the lit ground.
    scene.world.set(scene.camera, looking({0, 0.5F, 0}, {0, 1, 0}, {0, 0, 1}));
    const Estimate estimate = traced(scene, 512, 1);
    // The ground extends to ±4 m: form factor 0.94 (Howell B-4). What is behind the pane is black.
    CHECK(estimate.indirect.pixels[middle].g == doctest::Approx(0.5F * 0.5F * 0.5F * 0.94F).epsilon(0.05));
}

TEST_CASE("the mesh's normals weight the light that a camera sees") {
    Scene scene = lit_ground();
    const Mesh flat = *square(0.5F, diffuse(glm::vec3(0.5F)));
    Mesh tilted = flat;
    for (Vertex& vertex : tilted.primitives[0].vertices) {
        vertex.normal = glm::vec3(0, std::cos(1.0F), std::sin(1.0F));
    }
    add(scene.world, Transform{.translation = {0, 1, 0}},
        MeshInstance{std::make_shared<const Mesh>(std::move(tilted))});
    CHECK(seen(scene) == doctest::Approx(0.5F * std::cos(1.0F)));
}

TEST_CASE("a light that casts no shadow lights occluded surfaces") {
    Scene scene = lit_ground();
    add_pane(scene, made_of({0.2F, 0.2F, 0.2F, 1}, AlphaMode::opaque, false), false);
    scene.world.edit<DirectionalLight>(scene.light, [](auto& light) { light.casts_shadow = false; });
    CHECK(seen(scene) == doctest::Approx(0.5F));
}

TEST_CASE("mirrored instances keep their front") {
    Scene scene = lit_ground();
    const Entity pane = add_pane(scene, made_of({0.2F, 0.2F, 0.2F, 1}, AlphaMode::opaque, false));
    scene.world.edit<Transform>(pane, [](auto& pose) { pose.scale = {-1, 1, 1}; });
    CHECK(seen(scene) == doctest::Approx(0.2F));
}

TEST_CASE("nothing is seen before the near plane or beyond the far plane") {
    Scene scene = lit_ground();
    add_pane(scene, made_of({0.2F, 0.2F, 0.2F, 1}, AlphaMode::opaque, false));
    scene.world.set(scene.camera, Camera{.near_plane = 2.5F});
    CHECK(seen(scene) == 0.0F);  // sees the ground in the pane's shadow
    scene.world.set(scene.camera, Camera{.near_plane = 0.1F, .far_plane = 1.5F});
    CHECK(std::ranges::count(traced(scene).hit, 1) == 0);
}

TEST_CASE("row 0 is at the top") {
    Scene scene = lit_ground();
    add(scene.world, at({0, 1, -1}), PointLight{.colour = {1, 0, 0}});
    // The camera looks down, with -Z up: what is towards -Z is in the upper half.
    const Estimate estimate = traced(scene);
    CHECK(estimate.direct.pixels[16].r > estimate.direct.pixels[33 * 32 + 16].r);
}

TEST_CASE("edges are marked at shadows and silhouettes, and nowhere else") {
    Scene scene = lit_ground();
    CHECK(std::ranges::count(traced(scene).edge, 1) == 0);
    add_pane(scene, made_of({0.2F, 0.2F, 0.2F, 1}, AlphaMode::opaque, false));
    const Estimate estimate = traced(scene);
    CHECK(estimate.edge[middle] == 0);
    // The pane is 1 m wide and 2 m away, where 33 pixels span 1.66 m.
    const auto marked = std::ranges::count(estimate.edge, 1);
    CHECK(marked > 4 * 20 * 2);
    CHECK(marked < 4 * 20 * 6);
}

}  // TEST_SUITE("reference: conventions")
