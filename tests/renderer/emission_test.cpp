// Surfaces that emit light.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include <candela/graph/describe.hpp>
#include "tests/area_lights.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("emission") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{48, 32};

/// A square lamp, 0.6 m wide, 1 m above the ground.
constexpr float half = 0.3F;
constexpr glm::vec3 lamp_position{0.4F, 1.0F, -0.2F};

Scene ground_under_lamp(std::shared_ptr<const Material> material) {
    Scene scene = ground();
    scene.light =
        add(scene.world, upside_down_at(lamp_position), MeshInstance{square(half, std::move(material))});
    return scene;
}

double irradiance_of_lamp(glm::dvec3 at) {
    const double h = static_cast<double>(half);
    const glm::dvec3 p(lamp_position);
    const std::array corners{p + glm::dvec3(-h, 0, -h), p + glm::dvec3(h, 0, -h), p + glm::dvec3(h, 0, h),
                             p + glm::dvec3(-h, 0, h)};
    return irradiance_of_polygon(corners, at, {0, 1, 0});
}

std::shared_ptr<const Mesh> sphere_outwards(float radius, int subdivisions,
                                            std::shared_ptr<const Material> material) {
    Mesh mesh = *sphere_inwards(radius, subdivisions, std::move(material));
    for (Primitive& primitive : mesh.primitives) {
        for (Vertex& vertex : primitive.vertices) {
            vertex.normal = -vertex.normal;
        }
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
        }
    }
    return std::make_shared<const Mesh>(std::move(mesh));
}

class EmissionFixture : public PathFixture {
 protected:
    /// The largest error of the ground's direct light, ρ/π · E with ρ = 0.5, relative to 1 % of its peak
    /// where it is darker than that.
    double worst_ground_error(const Scene& scene, const std::function<double(glm::dvec3)>& irradiance,
                              VplVisibility visibility = VplVisibility::none) {
        Configuration configuration = linear_configuration();
        configuration.indirect = false;
        configuration.visibility.method = visibility;
        configure(configuration);
        Picture expected = expected_picture(scene, size, glm::dvec3(0.0), {0, 1, 0},
                                            [&](auto at) { return glm::dvec3(0.5 / pi * irradiance(at)); });
        double peak = 0.0;
        for (const glm::dvec3 pixel : expected.pixels) {
            peak = std::max(peak, pixel.r);
        }
        const Picture picture = render(scene, size);
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            if (picture.pixels[i] == glm::vec3(1.0F)) {
                expected.pixels[i] = glm::vec3(1.0F);  // the lamp itself
            }
        }
        return worst_error(picture, expected, 0.01 * peak);
    }
};

/// The lamp's box with few surfels.
Configuration small_configuration(Show show = Show::total) {
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 16;
    configuration.show = show;
    return configuration;
}

}  // namespace

// 1 %: the lamp is sampled at about 1,000 points, and its cells are treated as discs from three times
// their width on.
TEST_CASE_FIXTURE(EmissionFixture, "a rectangle lights a plane as Lambert's formula says") {
    const Scene scene = ground_under_lamp(emitter(glm::vec3(1.0F)));
    CHECK(worst_ground_error(scene, irradiance_of_lamp) < 0.01);
}

TEST_CASE_FIXTURE(EmissionFixture, "emitted light is not reflected light") {
    // The ground reflects light to the black lamp only.
    const Scene scene = ground_under_lamp(emitter(glm::vec3(1.0F)));
    configure(small_configuration(Show::indirect));
    CHECK(mean(render(scene, size)) == 0.0);
    configure(small_configuration(Show::direct));
    const Picture direct = render(scene, size);
    CHECK(mean(direct) > 0.0);
    configure(small_configuration());
    // The sums of the same terms are rounded in another order.
    CHECK(worst_error(render(scene, size), direct, mean(direct)) < 1e-5);
}

TEST_CASE_FIXTURE(EmissionFixture, "a sphere lights a plane like its solid angle") {
    Scene scene = ground();
    const float radius = 0.2F;
    // 20,480 triangles have the sphere's area to 1e-3.
    add(scene.world, at(lamp_position), MeshInstance{sphere_outwards(radius, 5, emitter(glm::vec3(1.0F)))});
    const auto irradiance = [&](glm::dvec3 point) {
        return irradiance_of_sphere(glm::dvec3(lamp_position), static_cast<double>(radius), point, {0, 1, 0});
    };
    CHECK(worst_ground_error(scene, irradiance) < 0.01);
    // 64 rays: cells at the sphere's horizon count as visible or hidden as a whole.
    CHECK(worst_ground_error(scene, irradiance, VplVisibility::rays) < 0.03);
}

TEST_CASE_FIXTURE(EmissionFixture, "each of many lamps lights a plane in its own colour") {
    // The lamps on the left are red, those on the right blue, of one flux together.
    for (const int side : {2, 4, 5, 8, 14}) {
        CAPTURE(side);
        Scene scene = ground();
        const int count = side * side;
        const double radius = 0.02;
        const double radiance = 100.0 / count;
        const auto ball = [&](glm::vec3 colour) {
            return MeshInstance{sphere_outwards(static_cast<float>(radius), 2,
                                                emitter(static_cast<float>(radiance) * colour))};
        };
        const MeshInstance red = ball({1, 0, 0}), blue = ball({0, 0, 1});
        std::vector<glm::dvec3> places;
        for (int i = 0; i < count; ++i) {
            const glm::dvec2 on_grid = (glm::dvec2(i % side, i / side) + 0.5) / static_cast<double>(side);
            places.emplace_back(3.0 * on_grid.x - 1.5, 1.0 + 0.3 * on_grid.y, 2.0 * on_grid.y - 1.0);
            add(scene.world, at(glm::vec3(places.back())), places.back().x < 0.0 ? red : blue);
        }
        const auto radiance_at = [&](glm::dvec3 point) {
            glm::dvec3 sum(0.0);
            for (const glm::dvec3& place : places) {
                const double light = irradiance_of_sphere(place, radius, point, {0, 1, 0});
                (place.x < 0.0 ? sum.r : sum.b) += 0.5 / pi * radiance * light;
            }
            return sum;
        };
        Configuration configuration = linear_configuration();
        configuration.indirect = false;
        configuration.visibility.method = VplVisibility::rays;
        configure(configuration);
        const Picture picture = render(scene, size);
        const Picture expected = expected_picture(scene, size, glm::dvec3(0.0), {0, 1, 0}, radiance_at);
        glm::dvec3 found(0.0), right(0.0);
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            if (std::max(picture.pixels[i].r, picture.pixels[i].b) > 0.9 * radiance) continue;  // a lamp
            found += glm::dvec3(picture.pixels[i]);
            right += glm::dvec3(expected.pixels[i]);
        }
        // 320 triangles have 1.5 % less area than their sphere. Lamps hide less than 1 % of each other's
        // light.
        CHECK(found.r == doctest::Approx(right.r).epsilon(0.03));
        CHECK(found.b == doctest::Approx(right.b).epsilon(0.03));
        CHECK(found.g == 0.0);
    }
}

TEST_CASE_FIXTURE(EmissionFixture, "the camera sees the emitted radiance on every path") {
    Scene scene = ground();
    const glm::vec3 radiance(3.0F, 2.0F, 0.5F);
    add(scene.world, at({0.0F, 0.01F, 0.0F}), MeshInstance{square(4.0F, emitter(radiance))});
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        configure(linear_configuration(path));
        for (const glm::vec3 pixel : render(scene, {16, 12}).pixels) {
            CHECK(pixel == radiance);
        }
    }
}

TEST_CASE_FIXTURE(EmissionFixture, "the light of a closed lamp is all absorbed") {
    Scene scene = furnace_box(0.5F);
    scene.world.destroy(scene.light);
    add(scene.world, upside_down_at({0.0F, 0.99F, 0.0F}),
        MeshInstance{square(0.25F, emitter(glm::vec3(2.0F)))});
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 512;  // with fewer, more of the light is lost between them
    configuration.visibility.method = VplVisibility::maps;
    configure(configuration);
    static_cast<void>(render(scene, {4, 4}));
    const auto report = renderer.report().vpls;
    REQUIRE(report);
    const EnergyAccount& flux = report->flux;
    const double emitted = pi * 2.0 * 0.25;  // π L A
    CHECK(flux.emitted.r == doctest::Approx(emitted).epsilon(1e-3));
    CHECK(flux.absorbed.r + flux.truncated.r == doctest::Approx(emitted).epsilon(0.005));
    CHECK(flux.escaped.r < 0.005 * emitted);
}

TEST_CASE_FIXTURE(EmissionFixture,
                  "light follows a lamp that moves, changes or goes, and its passes go with it") {
    Scene scene = ground_under_lamp(emitter(glm::vec3(1.0F)));
    configure(small_configuration());
    static_cast<void>(render(scene, size));
    scene.world.edit<Transform>(scene.light, [](Transform& pose) { pose.translation.x += 0.5F; });
    CHECK(render(scene, size) == from_scratch(scene, size));
    scene.world.set(scene.light, MeshInstance{square(half, emitter({0.0F, 2.0F, 1.0F}))});
    CHECK(render(scene, size) == from_scratch(scene, size));
    CHECK(ran("emission"));
    scene.world.destroy(scene.light);
    CHECK(mean(render(scene, size)) == 0.0);
    CHECK(describe_text(renderer.description()).find("emission") == std::string::npos);
}

TEST_CASE_FIXTURE(EmissionFixture, "an emissive texture shines where it is bright") {
    const glm::u8vec4 white(255);
    const glm::u8vec4 black(0, 0, 0, 255);
    const Image image{.width = 4,
                      .height = 1,
                      .texels = {white, black, black, white},
                      .wrap_u = Wrap::clamp_to_edge,
                      .wrap_v = Wrap::clamp_to_edge};
    Material material = *emitter(glm::vec3(4.0F));
    material.emissive_texture = std::make_shared<const Image>(image);
    const auto textured = std::make_shared<const Material>(material);

    // Far away, only the mean matters: 1/2.
    Scene far = ground();
    add(far.world, upside_down_at({0.0F, 3.0F, 0.0F}), MeshInstance{square(0.05F, textured)});
    Scene plain = ground();
    add(plain.world, upside_down_at({0.0F, 3.0F, 0.0F}),
        MeshInstance{square(0.05F, emitter(glm::vec3(2.0F)))});
    configure(small_configuration(Show::direct));
    const Picture expected = render(plain, size);
    renderer.invalidate();
    // 1 %: about 1,000 points sample the texture.
    CHECK(worst_error(render(far, size), expected, 0.01 * mean(expected)) < 0.01);

    // The camera sees the texels: the outer eighths of the square are white. It sees x = -1.6 m to 1.6 m
    // at the lower edge.
    Scene near = ground();
    add(near.world, at({0.0F, 0.01F, 0.0F}), MeshInstance{square(1.8F, textured)});
    renderer.invalidate();
    const Picture seen = render(near, size);
    CHECK(seen.at(0, 0).r == doctest::Approx(4.0F).epsilon(0.01));  // GPUs filter by weights of 8 bits
    CHECK(seen.at(size.x / 2, 0).r == 0.0F);
}

TEST_CASE_FIXTURE(EmissionFixture, "a blended surface shows its emission as far as it covers") {
    Scene scene = ground();
    Material material = *emitter(glm::vec3(3.0F));
    material.alpha_mode = AlphaMode::blend;
    material.base_colour.a = 0.25F;
    add(scene.world, at({0.0F, 0.5F, 0.0F}),
        MeshInstance{square(4.0F, std::make_shared<const Material>(material))});
    configure(linear_configuration());
    CHECK(render(scene, {16, 12}).at(8, 6).r == doctest::Approx(0.75F).epsilon(1e-3));
}

TEST_CASE_FIXTURE(EmissionFixture, "a lamp of 80 thousand triangles lights all of a room") {
    Scene scene = cornell_box();
    scene.world.destroy(scene.light);
    add(scene.world, at({0.0F, 1.5F, 0.0F}),
        MeshInstance{sphere_outwards(0.2F, 6, emitter(glm::vec3(5.0F)))});
    // Emitters have rays in both cases. With maps, an invocation shades four pixels, of which some show
    // no surface: rays from there must not use up the loops that software drivers allow.
    Configuration configuration = small_configuration(Show::direct);
    configuration.interleave = Interleave::eight;
    configuration.visibility.method = VplVisibility::rays;
    configure(configuration);
    const Picture expected = render(scene, {128, 128});
    configuration.visibility = {VplVisibility::maps, 16};
    configure(configuration);
    CHECK(worst_error(render(scene, {128, 128}), expected, mean(expected)) < 1e-3);
}

TEST_CASE_FIXTURE(EmissionFixture, "shadows of a lamp converge to the share of it that is visible") {
    // A wall that hides exactly one half of the lamp from a point below it: half of the light arrives.
    Scene scene = ground_under_lamp(emitter(glm::vec3(1.0F)));
    add(scene.world,
        Transform{.translation = lamp_position + glm::vec3(0.0F, -0.5F, 0.0F),
                  .rotation = glm::angleAxis(static_cast<float>(pi / 2.0), glm::vec3(0.0F, 0.0F, 1.0F))},
        MeshInstance{square(0.499F, diffuse(glm::vec3(0.0F), true))});
    const glm::vec3 below = lamp_position * glm::vec3(1.0F, 0.0F, 1.0F) + glm::vec3(0.02F, 0.0F, 0.0F);
    const Entity camera =
        add(scene.world, looking(below + glm::vec3(0.3F, 0.4F, 0.0F), below), Camera{.vertical_fov = 0.02F});
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configuration.visibility = {VplVisibility::rays, 64};
    configure(configuration);
    const double shown = static_cast<double>(render(scene.world, camera, {1, 1}).at(0, 0).r);
    const glm::dvec3 at(below);
    // The half of the lamp towards +x, seen from right of the wall. 64 shadow rays: 1/64 of the lamp.
    const double h = static_cast<double>(half);
    const glm::dvec3 p(lamp_position);
    const std::array corners{p + glm::dvec3(0, 0, -h), p + glm::dvec3(h, 0, -h), p + glm::dvec3(h, 0, h),
                             p + glm::dvec3(0, 0, h)};
    const double expected = 0.5 / pi * irradiance_of_polygon(corners, at, {0, 1, 0});
    CHECK(shown == doctest::Approx(expected).epsilon(0.05));
}

}  // TEST_SUITE("emission")
