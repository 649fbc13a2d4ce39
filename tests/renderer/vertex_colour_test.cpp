// Colours of vertices, which multiply those of materials.

#include <doctest/doctest.h>

#include <numbers>
#include <utility>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("vertex colours") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{60, 44};

glm::u16vec4 stored(glm::vec4 colour) {
    return {colour * 65535.0F + 0.5F};
}

/// The mesh with white materials, whose colours its vertices have instead.
std::shared_ptr<const Mesh> painted(const Mesh& mesh) {
    Mesh result = mesh;
    for (Primitive& primitive : result.primitives) {
        Material material = *primitive.material;
        for (Vertex& vertex : primitive.vertices) vertex.colour = stored(material.base_colour);
        material.base_colour = glm::vec4(1.0F);
        primitive.material = std::make_shared<const Material>(std::move(material));
    }
    return std::make_shared<const Mesh>(std::move(result));
}

Scene painted(Scene scene) {
    std::vector<std::pair<Entity, std::shared_ptr<const Mesh>>> meshes;
    for (auto [entity, instance] : scene.world.view<MeshInstance>()) {
        meshes.emplace_back(entity, instance.mesh);
    }
    for (const auto& [entity, mesh] : meshes) scene.world.set(entity, MeshInstance{painted(*mesh)});
    return scene;
}

}  // namespace

TEST_CASE_FIXTURE(PathFixture, "colours of vertices are the same as those of materials, on every path") {
    const Scene plain = cornell_box();
    const Scene coloured = painted(plain);
    for (const VplPlacement placement : {VplPlacement::surfels, VplPlacement::paths}) {
        for (const ShadingPath path : all_shading_paths) {
            CAPTURE(to_string(placement));
            CAPTURE(to_string(path));
            Configuration configuration = linear_configuration();
            configuration.path = path;
            configuration.vpls.placement = placement;
            configure(configuration);
            renderer.invalidate();
            const Picture expected = render(plain, size);
            renderer.invalidate();
            const Picture picture = render(coloured, size);
            // Rays read colours of 8 bits in sRGB: half a step is 1.1 % of the darkest channel, 0.05, and
            // less of the others. The albedo seen by the camera has 16 bits.
            CHECK(worst_error(picture, expected, 0.01 * mean(expected)) < 0.012);
            CHECK(mean(picture) == doctest::Approx(mean(expected)).epsilon(0.002));
        }
    }
}

TEST_CASE_FIXTURE(PathFixture, "colours are interpolated between vertices") {
    Scene scene = ground();
    Mesh mesh;
    Entity ground_entity;
    for (auto [entity, instance] : scene.world.view<MeshInstance>()) {
        mesh = *instance.mesh;
        ground_entity = entity;
    }
    for (Vertex& vertex : mesh.primitives.at(0).vertices) {
        vertex.colour = stored({vertex.position.x > 0.0F ? 1.0F : 0.0F, 1.0F, 0.5F, 1.0F});
    }
    scene.world.set(ground_entity, MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});
    add(scene.world, looking({0, 2, 0}, {0, 0, 0}, {0, 0, 1}), DirectionalLight{.illuminance = 2.0F});
    configure(direct_only());
    const double white = 0.5 * 2.0 * std::numbers::inv_pi;
    const Picture expected = expected_picture(scene, size, glm::dvec3(0.0), {0, 1, 0}, [&](glm::dvec3 at) {
        return white * glm::dvec3((at.x + 4.0) / 8.0, 1.0, 0.5);
    });
    // The albedo of the G-buffer is rounded to half floats: 1/2048.
    CHECK(worst_error(render(scene, size), expected, 1e-3) < 1e-3);
}

TEST_CASE_FIXTURE(PathFixture, "alpha of vertices makes holes in masks, for the camera and for light") {
    // A square above the ground whose vertices are all below the cutoff: as if it were not there.
    Scene scene = ground();
    add(scene.world, looking({0.3F, 2, 0}, {0, 0, 0}), DirectionalLight{.illuminance = 2.0F});
    Scene covered = scene;
    Material material = *diffuse(glm::vec3(0.9F), true);
    material.alpha_mode = AlphaMode::mask;
    Mesh mesh = *square(1.0F, std::make_shared<const Material>(material));
    for (Vertex& vertex : mesh.primitives.at(0).vertices) {
        vertex.colour = stored({1.0F, 1.0F, 1.0F, 0.4F});
    }
    add(covered.world, at({0.0F, 0.5F, 0.0F}), MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});
    Configuration configuration = linear_configuration();
    configuration.vpls = {.placement = VplPlacement::surfels, .count = 64, .bounces = 1, .guided = false};
    configuration.show = Show::direct;
    configure(configuration);
    const Picture expected = render(scene, size);
    renderer.invalidate();
    // The scene's bounds, and so the sun's map, differ: edges of the map's texels round differently.
    CHECK(worst_error(render(covered, size), expected, mean(expected)) < 1e-3);
    CHECK(mean(expected) > 0.0);
}

}  // TEST_SUITE("vertex colours")
