// Light from the sky.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include <candela/graph/describe.hpp>
#include "renderer/passes/sky/sky_patches.hpp"
#include "renderer/passes/view/refinement.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("sky") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{64, 48};

Environment uniform(glm::vec3 radiance) {
    return {.radiance = radiance, .picture = nullptr};
}

std::shared_ptr<const SkyPicture> picture_of(std::uint32_t width, std::vector<glm::vec3> texels) {
    return std::make_shared<const SkyPicture>(SkyPicture{width, width / 2, std::move(texels)});
}

/// A picture that is black but for one texel, and the illuminance in lux of a surface that faces it.
struct Sun {
    std::shared_ptr<const SkyPicture> picture;
    glm::vec3 direction;
    double illuminance;
};

Sun one_texel(float radiance) {
    constexpr std::uint32_t width = 512, height = 256, column = 300, row = 70;
    std::vector<glm::vec3> texels(std::size_t{width} * height, glm::vec3(0.0F));
    texels[row * width + column] = glm::vec3(radiance);
    const double solid_angle =
        2.0 * pi / width * (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height));
    return {picture_of(width, std::move(texels)),
            sky_direction((glm::vec2(column, row) + 0.5F) / glm::vec2(width, height)),
            static_cast<double>(radiance) * solid_angle};
}

class SkyFixture : public PathFixture {
 protected:
    /// Direct light by rays, all of it at each pixel.
    static Configuration direct_by_rays() {
        Configuration configuration = linear_configuration();
        configuration.show = Show::direct;
        configuration.visibility.method = VplVisibility::rays;
        configuration.vpls.count = 512;  // the number of patches grows with it
        configuration.vpls.bounces = 0;  // no surfels on surfaces that only reflect light
        return configuration;
    }

    /// Seen at a slant, so that half of the picture is background.
    static Configuration small() {
        Configuration configuration = linear_configuration();
        configuration.vpls.count = 16;
        configuration.visibility = {VplVisibility::maps, 16};
        return configuration;
    }
};

}  // namespace

TEST_CASE_FIXTURE(SkyFixture, "a plane under a uniform sky has radiance ρ L, however it is tilted") {
    configure(direct_by_rays());
    const glm::vec3 radiance(2.0F, 1.0F, 0.25F);
    for (const glm::vec3 normal :
         {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0.6F, 0.0F, -0.8F),
          glm::normalize(glm::vec3(1, 2, 3)), glm::normalize(glm::vec3(-3, 1, 2))}) {
        CAPTURE(normal);
        World world;
        add(world, uniform(radiance));
        add(world, Transform{.rotation = glm::quat(glm::vec3(0, 1, 0), normal)},
            MeshInstance{square(1.0F, diffuse(glm::vec3(0.5F)))});
        const glm::vec3 aside = glm::abs(normal.y) > 0.9F ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
        const Entity camera =
            add(world, looking(normal, glm::vec3(0.0F), aside), Camera{.vertical_fov = 0.1F});
        renderer.invalidate();
        const glm::vec3 seen = render(world, camera, {1, 1}).at(0, 0);
        // 1 %: the patches that the horizon divides, of about 256, are approximated.
        for (int i = 0; i < 3; ++i) {
            CHECK(seen[i] == doctest::Approx(0.5F * radiance[i]).epsilon(0.01));
        }
    }
}

TEST_CASE_FIXTURE(SkyFixture,
                  "a plane beside an endless wall sees half of the sky at its foot, more away from it") {
    Scene scene = ground();
    add(scene.world, uniform(glm::vec3(1.0F)));
    // 2 m high and 200 m long, practically endless: at a distance d, it hides (1 - d / √(d² + h²)) / 2 of
    // the light.
    const double height = 2.0;
    add(scene.world,
        Transform{.translation = {-1.0F, 1.0F, 0.0F},
                  .rotation = glm::angleAxis(static_cast<float>(-pi / 2), glm::vec3(0, 0, 1)),
                  .scale = {1.0F, 1.0F, 100.0F}},
        MeshInstance{square(1.0F, diffuse(glm::vec3(0.0F), true))});
    Configuration configuration = direct_by_rays();
    configuration.refinement = {.enabled = true, .frames = 64};
    configure(configuration);
    const auto error_at = [&](float distance) {
        const glm::vec3 point(-1.0F + distance, 0.0F, 0.0F);
        const Entity camera = add(scene.world, looking(point + glm::vec3(0.3F, 0.4F, 0.0F), point),
                                  Camera{.vertical_fov = 0.01F});
        const double d = static_cast<double>(distance);
        const double share = 1.0 - 0.5 * (1.0 - d / std::hypot(d, height));
        double last = static_cast<double>(render(scene.world, camera, {1, 1}).at(0, 0).r);
        const double first_error = std::abs(last / (0.5 * share) - 1.0);
        for (int frame = 1; frame < 64; ++frame) {
            last = static_cast<double>(render(scene.world, camera, {1, 1}).at(0, 0).r);
        }
        return std::array{first_error, std::abs(last / (0.5 * share) - 1.0)};
    };
    for (const float distance : {0.05F, 0.5F, 2.0F}) {
        CAPTURE(distance);
        const auto [first, refined] = error_at(distance);
        // The wall's edge crosses about 10 of 256 patches, of which each is a percent of the light: √10 /
        // 2 of them are on the wrong side, and 8 sets of patches are averaged.
        CHECK(first < 0.03);
        CHECK(refined < 0.01);
    }
}

TEST_CASE_FIXTURE(SkyFixture, "in a uniform sky, white objects cannot be told from it") {
    // All light that a white surface does not receive from the sky, it receives from other white
    // surfaces: the radiance is that of the sky everywhere, by all bounces together.
    Scene scene = shipped_scene("court");
    const auto white = diffuse(glm::vec3(1.0F));
    std::vector<std::pair<Entity, MeshInstance>> painted;
    for (auto [entity, instance] : scene.world.view<MeshInstance>()) {
        Mesh mesh = *instance.mesh;
        for (Primitive& primitive : mesh.primitives) primitive.material = white;
        painted.push_back({entity, {std::make_shared<const Mesh>(std::move(mesh))}});
    }
    for (auto& [entity, instance] : painted) scene.world.set(entity, std::move(instance));
    std::vector<Entity> skies;
    for (auto [entity, sky] : scene.world.view<Environment>()) skies.push_back(entity);
    scene.world.set(skies.at(0), uniform(glm::vec3(1.0F)));
    Configuration configuration = linear_configuration();
    configuration.visibility.method = VplVisibility::rays;
    configuration.vpls.count = 512;
    configure(configuration);
    const Picture picture = render(scene, size);
    // 512 surfels: single pixels err by up to a third in narrow places, behind the posts and under the
    // ball.
    CHECK(mean(picture) == doctest::Approx(1.0).epsilon(0.03));
    const auto far_off = std::ranges::count_if(
        picture.pixels, [](glm::vec3 pixel) { return std::abs(pixel.r - 1.0F) > 0.25F; });
    CHECK(static_cast<double>(far_off) < 0.05 * static_cast<double>(picture.pixels.size()));
}

TEST_CASE_FIXTURE(SkyFixture, "a sky of one bright texel lights like a directional light") {
    const Sun sun = one_texel(1000.0F);
    Scene by_sky = ground();
    add(by_sky.world, at({0.0F, 0.5F, 0.0F}), MeshInstance{square(0.4F, diffuse(glm::vec3(0.5F), true))});
    Scene by_light = by_sky;
    add(by_sky.world, Environment{.radiance = glm::vec3(1.0F), .picture = sun.picture});
    add(by_light.world, looking(sun.direction, glm::vec3(0.0F)),
        DirectionalLight{.illuminance = static_cast<float>(sun.illuminance)});
    Configuration configuration = direct_by_rays();
    configuration.shadows.map_resolution = 1024;
    configure(configuration);
    const Picture expected = render(by_light, size);
    renderer.invalidate();
    const Picture picture = render(by_sky, size);
    // The texel is 0.7 degrees wide, the light has no width: only its mean direction is compared.
    const auto different = [&](std::size_t i) {
        return std::abs(picture.pixels[i].r - expected.pixels[i].r) > 1e-3F * expected.pixels[i].r;
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) count += different(i) ? 1 : 0;
    CHECK(mean(expected) > 0.0);
    CHECK(count <= 2);                           // pixels on the shadow's edge
    CHECK(renderer.report().lights.count == 1);  // it is small enough for a sun
}

TEST_CASE("suns and patches of a sky together have its light, and only what is small and bright is a sun") {
    constexpr std::uint32_t width = 720, height = 360;  // half a degree a texel
    const glm::vec3 middle = sky_direction({0.3F, 0.4F});
    const auto sky_with_disc = [&](float radius, float radiance) {
        std::vector<glm::vec3> texels;
        for (std::uint32_t i = 0; i < width * height; ++i) {
            const glm::vec3 direction =
                sky_direction((glm::vec2(i % width, i / width) + 0.5F) / glm::vec2(width, height));
            const bool inside = glm::dot(direction, middle) > std::cos(glm::radians(radius));
            texels.push_back(inside ? glm::vec3(radiance, 0.5F * radiance, 1.0F) : glm::vec3(1.0F));
        }
        return SkyPicture{width, height, std::move(texels)};
    };
    struct Disc {
        float radius;    // degrees
        float radiance;  // that of the sky is 1
        std::size_t suns;
    };
    // A disc of radius r has a solid angle of 9.6e-4 r² sr, the sky 12.6 sr.
    for (const Disc& disc :
         {Disc{0.8F, 1e4F, 1}, Disc{0.8F, 1.0F, 0}, Disc{0.8F, 100.0F, 0}, Disc{5.0F, 1e4F, 0}}) {
        CAPTURE(disc.radius);
        CAPTURE(disc.radiance);
        const SkyPicture picture = sky_with_disc(disc.radius, disc.radiance);
        const SplitSky split = split_sky(&picture, 128);
        CHECK(split.suns.size() == disc.suns);
        CHECK(split.patches.size() <= 128);
        glm::dvec3 expected(0.0);
        for (std::uint32_t y = 0; y < height; ++y) {
            const double solid_angle =
                2.0 * pi / width * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
            for (std::uint32_t x = 0; x < width; ++x) {
                expected += solid_angle * glm::dvec3(picture.texels[y * width + x]);
            }
        }
        glm::dvec3 found(0.0);
        for (const SkySun& sun : split.suns) found += glm::dvec3(sun.light);
        for (const SkyPatch& patch : split.patches) {
            for (std::uint32_t y = patch.first.y; y < patch.last.y; ++y) {
                for (std::uint32_t x = patch.first.x; x < patch.last.x; ++x) {
                    found += glm::dvec3(split.grid->at(x, y).light);
                }
            }
        }
        // Sums of floats.
        for (int i = 0; i < 3; ++i) CHECK(found[i] == doctest::Approx(expected[i]).epsilon(1e-4));
        for (const SkySun& sun : split.suns) {
            CHECK(glm::distance(sun.direction, middle) < 0.005F);
            CHECK(sun.light.r == doctest::Approx(2.0F * sun.light.g).epsilon(1e-3));
        }
    }
}

TEST_CASE_FIXTURE(SkyFixture, "the background shows the picture in its direction, rotated, on every path") {
    // One colour to each side: -Z in the middle, +X to its right, +Z at the edges, -X to its left.
    std::vector<glm::vec3> texels;
    for (std::uint32_t y = 0; y < 8; ++y) {
        for (std::uint32_t x = 0; x < 16; ++x) {
            const std::uint32_t side = (x + 2) / 4 % 4;
            texels.emplace_back(side == 2 ? 1.0F : 0.0F, side == 3 ? 1.0F : 0.0F, side == 0 ? 1.0F : 0.0F);
        }
    }
    World world;
    const Entity sky =
        add(world, Environment{.radiance = glm::vec3(3.0F, 2.0F, 1.0F), .picture = picture_of(16, texels)});
    const auto seen = [&](glm::vec3 direction) {
        const Entity camera = add(world, looking(glm::vec3(0.0F), direction), Camera{.vertical_fov = 0.01F});
        const glm::vec3 pixel = render(world, camera, {1, 1}).at(0, 0);
        world.destroy(camera);
        return pixel;
    };
    const glm::vec3 red(3, 0, 0), green(0, 2, 0), blue(0, 0, 1), black(0);
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        configure(linear_configuration(path));
        world.edit<Environment>(sky, [](Environment& e) { e.rotation = 0.0F; });
        CHECK(seen({0, 0, -1}) == red);
        CHECK(seen({1, 0, 0}) == green);
        CHECK(seen({0, 0, 1}) == blue);
        CHECK(seen({-1, 0, 0}) == black);
        // A quarter turn from +Z towards +X: what was at +Z is at +X.
        world.edit<Environment>(sky, [](Environment& e) { e.rotation = static_cast<float>(pi / 2); });
        CHECK(seen({1, 0, 0}) == blue);
        CHECK(seen({0, 0, -1}) == green);
        CHECK(seen({-1, 0, 0}) == red);
    }
}

TEST_CASE_FIXTURE(SkyFixture, "rotating the sky is the same as rotating everything else the other way") {
    const Sun sun = one_texel(1000.0F);
    Scene still = ground();
    add(still.world, at({0.3F, 0.2F, 0.1F}), MeshInstance{square(0.3F, diffuse(glm::vec3(0.5F), true))});
    const Entity sky = add(still.world, Environment{.radiance = glm::vec3(1.0F), .picture = sun.picture});
    Scene turned = still;
    const float angle = 0.7F;
    still.world.edit<Environment>(sky, [&](Environment& e) { e.rotation = angle; });
    const glm::quat back = glm::angleAxis(-angle, glm::vec3(0, 1, 0));
    std::vector<Entity> poses;
    for (auto [entity, pose] : turned.world.view<Transform>()) poses.push_back(entity);
    for (const Entity entity : poses) {
        turned.world.edit<Transform>(entity, [&](Transform& pose) {
            pose.translation = back * pose.translation;
            pose.rotation = back * pose.rotation;
        });
    }
    Configuration configuration = direct_by_rays();
    configuration.shadows.map_resolution = 1024;
    configure(configuration);
    const Picture expected = render(still, size);
    renderer.invalidate();
    const Picture picture = render(turned, size);
    std::size_t different = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        different +=
            std::abs(picture.pixels[i].r - expected.pixels[i].r) > 1e-3F * expected.pixels[i].r ? 1 : 0;
    }
    CHECK(mean(expected) > 0.0);
    CHECK(different <= 2);  // pixels on the shadow's edge
}

TEST_CASE_FIXTURE(SkyFixture, "light follows a sky that changes, turns or goes, and its passes go with it") {
    Scene scene = shipped_scene("court");
    Entity sky;
    for (auto [entity, environment] : scene.world.view<Environment>()) sky = entity;
    configure(small());
    static_cast<void>(render(scene, size));
    scene.world.edit<Environment>(sky, [](Environment& e) { e.rotation = 1.0F; });
    CHECK(render(scene, size) == from_scratch(scene, size));
    CHECK_FALSE(ran("sky-split"));  // the picture is the same
    scene.world.edit<Environment>(sky, [](Environment& e) { e.radiance = {0.0F, 2.0F, 1.0F}; });
    CHECK(render(scene, size) == from_scratch(scene, size));
    scene.world.set(sky, uniform(glm::vec3(0.5F)));
    CHECK(render(scene, size) == from_scratch(scene, size));
    CHECK(ran("background"));
    scene.world.set(sky, Environment{});
    CHECK(mean(render(scene, size)) == 0.0);
    CHECK(describe_text(renderer.description()).find("sky") == std::string::npos);
    CHECK(describe_text(renderer.description()).find("background") == std::string::npos);
}

TEST_CASE_FIXTURE(SkyFixture, "light of the sky is computed again only when another sample of it is shown") {
    Scene scene = ground();
    add(scene.world, Environment{.radiance = glm::vec3(1.0F), .picture = one_texel(1e3F).picture});
    Configuration configuration = small();
    configuration.refinement = {.enabled = true, .frames = 64};
    configure(configuration);
    for (std::uint32_t set = 0; set < 2 * frames_a_surfel_set; ++set) {
        CAPTURE(set);
        static_cast<void>(render(scene, size));
        for (const std::string_view pass : {"sky-patches", "surfel-light", "surfel-bounce"}) {
            CAPTURE(pass);
            CHECK(ran(pass) == (set % frames_a_surfel_set == 0));
        }
    }
}

TEST_CASE_FIXTURE(SkyFixture, "the flux of the sky is accounted for") {
    Scene scene = ground();
    add(scene.world, uniform(glm::vec3(2.0F)));
    configure(small());
    static_cast<void>(render(scene, {4, 4}));
    const auto report = renderer.report().vpls;
    REQUIRE(report);
    const EnergyAccount& flux = report->flux;
    const double emitted = pi * 2.0 * 64.0;  // π L A: a plane of 8 m × 8 m sees nothing but the sky
    // 1 %: of the patches that the horizon divides.
    CHECK(flux.emitted.r == doctest::Approx(emitted).epsilon(0.01));
    CHECK(flux.absorbed.r == doctest::Approx(0.5 * flux.emitted.r).epsilon(1e-3));
    CHECK(flux.escaped.r == doctest::Approx(0.5 * flux.emitted.r).epsilon(1e-3));
}

TEST_CASE_FIXTURE(SkyFixture, "the sky shines through a blended surface as far as that does not cover it") {
    World world;
    add(world, uniform(glm::vec3(4.0F)));
    Material material = *diffuse(glm::vec3(0.0F), true);
    material.alpha_mode = AlphaMode::blend;
    material.base_colour.a = 0.25F;
    add(world, at({0, 0, 0}), MeshInstance{square(1.0F, std::make_shared<const Material>(material))});
    const Entity camera = add(world, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}), Camera{.vertical_fov = 0.1F});
    configure(linear_configuration());
    CHECK(render(world, camera, {1, 1}).at(0, 0).r == doctest::Approx(3.0F).epsilon(1e-3));
}

}  // TEST_SUITE("sky")
