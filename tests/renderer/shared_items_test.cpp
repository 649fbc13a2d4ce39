// Light of worlds with so many objects that one surfel stands for several.

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <utility>

#include "renderer/frame/build_frame.hpp"
#include "renderer/passes/scene/scene_check.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("surfels: shared items") {

using namespace candela;

namespace {

constexpr double pi = glm::pi<double>();

class SharedItems : public PathFixture {
 protected:
    static Configuration settings(std::uint32_t vpls, std::uint32_t bounces, Interleave interleave) {
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.vpls = {
            .placement = VplPlacement::surfels, .count = vpls, .bounces = bounces, .seed = 0};
        configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 32};
        configuration.interleave = interleave;
        return configuration;
    }
};

/// Each triangle of the mesh as an object of its own.
void add_in_parts(World& world, const Mesh& mesh) {
    const Primitive& whole = mesh.primitives.front();
    for (std::size_t i = 0; i < whole.indices.size(); i += 3) {
        Primitive part{.vertices = {}, .indices = {0, 1, 2}, .material = whole.material};
        for (std::size_t k = 0; k < 3; ++k) part.vertices.push_back(whole.vertices[whole.indices[i + k]]);
        add(world, Transform{},
            MeshInstance{std::make_shared<const Mesh>(Mesh{.name = {}, .primitives = {std::move(part)}})});
    }
}

/// A ground of 40 m × 40 m of `side`² tiles with albedo 0.6, the sun straight above with 3 lux, and a wall of
/// 4 m × 2 m that stands in its middle. The camera sees nothing but the wall.
Scene wall_on_tiles(int side) {
    Scene scene;
    const float width = 40.0F / static_cast<float>(side);
    const auto tile = square(0.5F * width, diffuse(glm::vec3(0.6F)));
    for (int i = 0; i < side * side; ++i) {
        const glm::vec2 middle = width * (glm::vec2(i % side, i / side) + 0.5F) - 20.0F;
        add(scene.world, at({middle.x, 0.0F, middle.y}), MeshInstance{tile});
    }
    const Transform upright{.translation = {0.0F, 1.0F, 0.0F},
                            .rotation = glm::angleAxis(glm::half_pi<float>(), glm::vec3(1.0F, 0.0F, 0.0F)),
                            .scale = {2.0F, 1.0F, 1.0F}};
    add(scene.world, upright, MeshInstance{square(1.0F, diffuse(glm::vec3(1.0F)))});
    add(scene.world, looking({0, 5, 0}, {0, 0, 0}, {1, 0, 0}), DirectionalLight{.illuminance = 3.0F});
    scene.camera = add(scene.world, looking({0.0F, 1.0F, 3.0F}, {0.0F, 1.0F, 0.0F}),
                       Camera{.projection = Camera::Projection::orthographic,
                              .half_height = 0.8F,
                              .near_plane = 0.0F,
                              .far_plane = 10.0F});
    return scene;
}

}  // namespace

TEST_CASE_FIXTURE(SharedItems, "a sphere of many parts, lit from its centre, is equally bright everywhere") {
    // Indirect radiance ρ/π · I/R² · ρ/(1 - ρ): all that a pixel sees has the same radiosity. Facets are
    // up to 4° off the sphere, and the light of their cells with them.
    constexpr double rho = 0.7;
    Scene scene;
    add_in_parts(scene.world, *sphere_inwards(2.0F, 3, diffuse(glm::vec3(static_cast<float>(rho)))));
    add(scene.world, Transform{}, PointLight{.intensity = 3.0F});
    scene.camera = add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
    const double expected = rho / pi * 3.0 / 4.0 * rho / (1.0 - rho);
    for (const Interleave interleave : {Interleave::one, Interleave::four}) {
        for (const VplVisibility method : {VplVisibility::maps, VplVisibility::rays}) {
            Configuration configuration = settings(256, all_bounces, interleave);
            configuration.visibility.method = method;
            configure(configuration);
            const Picture picture = render(scene, {48, 36});
            CHECK(mean(picture) == doctest::Approx(expected).epsilon(0.02));
            for (const glm::vec3& pixel : picture.pixels) {
                CHECK(static_cast<double>(pixel.r) == doctest::Approx(expected).epsilon(0.06));
            }
        }
    }
}

TEST_CASE_FIXTURE(SharedItems, "a wall on sunlit tiles has their light, as far as they fill its view") {
    // At the height h on a wall, ground of radiosity B as far as L fills B/2 (1 - h / √(h² + L²)).
    const Scene scene = wall_on_tiles(40);
    const Picture expected = expected_picture(scene, {32, 24}, {0, 0, 0}, {0, 0, 1}, [](glm::dvec3 position) {
        const double h = position.y;
        return glm::dvec3(0.6 * 3.0 / pi * 0.5 * (1.0 - h / std::hypot(h, 20.0)));
    });
    for (const Interleave interleave : {Interleave::one, Interleave::two}) {
        configure(settings(512, 1, interleave));
        // 64 rays, each in one of 8 × 8 strata, find the share. In the 16 strata across its edges they
        // may err by half a stratum each: together by 1/2 √16/64, 6 % of the share, and hardly ever
        // twice.
        CHECK(worst_error(render(scene, {32, 24}), expected, 1e-6) < 0.13);
    }
}

TEST_CASE("items are shared if there are more than 16, and more than a quarter as many as surfels") {
    Log log({});
    SceneCheck check(log, false);
    const auto shares = [&](const World& world, std::uint32_t vpls) {
        return contents_of(world, check, vpls).of_frame.shares_items;
    };
    World world;
    const auto quad = square(1.0F, diffuse(glm::vec3(0.5F)));
    for (int i = 0; i < 16; ++i) add(world, Transform{}, MeshInstance{quad});
    // What emits or is blended has no such surfels.
    auto glass = std::make_shared<Material>(*diffuse(glm::vec3(0.5F)));
    glass->alpha_mode = AlphaMode::blend;
    add(world, Transform{}, MeshInstance{square(1.0F, emitter(glm::vec3(1.0F)))});
    add(world, Transform{}, MeshInstance{square(1.0F, glass)});
    CHECK(!shares(world, 32));
    add(world, Transform{}, MeshInstance{quad});
    CHECK(shares(world, 32));
    CHECK(shares(world, 64));
    CHECK(!shares(world, 68));
}

TEST_CASE_FIXTURE(SharedItems, "all shading paths agree") {
    for (const Interleave interleave : {Interleave::one, Interleave::two}) {
        Configuration configuration = settings(64, 2, interleave);
        configuration.show = Show::total;
        check_paths(wall_on_tiles(10), {52, 36}, configuration);
    }
}

}  // TEST_SUITE("surfels: shared items")
