#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include <candela/scene/hierarchy.hpp>
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("closed forms") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{96, 64};
// The required accuracy. It allows for floats and for albedos in half floats (2⁻¹¹), not for acne or leaks.
constexpr double tolerance = 0.005;

using Irradiance = std::function<double(glm::dvec3 point)>;

/// A plane in world space.
struct Plane {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0, 1.0, 0.0};
};

/// Point light: E = I cos θ / r².
double point_irradiance(glm::dvec3 light, glm::dvec3 at, glm::dvec3 normal) {
    const glm::dvec3 to_light = light - at;
    const double r = glm::length(to_light);
    return std::max(glm::dot(to_light, normal), 0.0) / (r * r * r);
}

/// KHR_lights_punctual: the square of a ramp in the cosine, 1 inside the inner cone, 0 outside the outer one.
double cone(double cosine, double inner, double outer) {
    const double x = (cosine - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    return std::pow(std::clamp(x, 0.0, 1.0), 2.0);
}

class ClosedForm : public RenderFixture {
 protected:
    /// Compares both paths, with shadows and without indirect light, with ρ/π · E at every pixel, or as near
    /// to its centre as corners may be rounded.
    void check(const Scene& scene, const Plane& plane, double albedo, const Irradiance& irradiance) {
        const auto expected_beside = [&](glm::dvec2 beside) {
            return expected_picture(
                scene, size, plane.point, plane.normal,
                [&](glm::dvec3 at) { return glm::dvec3(albedo / pi * irradiance(at)); }, beside);
        };
        const Picture expected = expected_beside(glm::dvec2(0.0));
        Picture least = expected, most = expected;
        for (const glm::dvec2 beside : corner_rounding) {
            const Picture there = expected_beside(beside);
            for (std::size_t i = 0; i < there.pixels.size(); ++i) {
                least.pixels[i] = glm::min(least.pixels[i], there.pixels[i]);
                most.pixels[i] = glm::max(most.pixels[i], there.pixels[i]);
            }
        }
        double peak = 0.0;
        for (const glm::dvec3 pixel : expected.pixels) {
            peak = std::max(peak, pixel.r);
        }
        for (const ShadingPath path : {ShadingPath::forward, ShadingPath::deferred}) {
            CAPTURE(to_string(path));
            Configuration configuration = linear_configuration(path);
            configuration.indirect = false;
            configure(configuration);
            renderer.invalidate();  // the scenes of a loop have the same address
            // Where a falloff reaches zero its float terms cancel: there, the error is relative to 10⁻⁴ of
            // the peak.
            const Picture seen = render(scene, size);
            Picture nearest = seen;
            for (std::size_t i = 0; i < nearest.pixels.size(); ++i) {
                nearest.pixels[i] = glm::clamp(nearest.pixels[i], least.pixels[i], most.pixels[i]);
            }
            CHECK(worst_error(seen, nearest, std::max(1e-4 * peak, 1e-9)) < tolerance);
        }
    }
};

}  // namespace

TEST_CASE_FIXTURE(ClosedForm, "a plane under a point light") {
    Scene scene = ground();
    for (const glm::vec3 light : {glm::vec3(0.4F, 1.0F, -0.2F), glm::vec3(-3.0F, 0.15F, 0.5F)}) {
        scene.world.set(scene.light, at(light));
        scene.world.set(scene.light, PointLight{.intensity = 3.0F});
        check(scene, {}, 0.5, [&](glm::dvec3 p) { return 3.0 * point_irradiance(light, p, {0, 1, 0}); });
    }
}

TEST_CASE_FIXTURE(ClosedForm, "a plane under a point light with a range") {
    Scene scene = ground();
    scene.world.set(scene.light, at({0.4F, 1.0F, -0.2F}));
    scene.world.set(scene.light, PointLight{.intensity = 3.0F, .range = 1.5F});
    check(scene, {}, 0.5, [&](glm::dvec3 p) {
        const glm::dvec3 light(0.4F, 1.0F, -0.2F);
        // KHR_lights_punctual: max(min(1 - (r / range)⁴, 1), 0) / r².
        const double window = 1.0 - std::pow(glm::length(light - p) / 1.5, 4.0);
        return 3.0 * point_irradiance(light, p, {0, 1, 0}) * std::max(window, 0.0);
    });
}

TEST_CASE_FIXTURE(ClosedForm, "a plane under a spot light: inner cone, ramp and outside") {
    Scene scene = ground();
    struct Cone {
        float inner, outer;
    };
    // The last one is wider than a flat map can cover: its shadow comes from a cube map.
    for (const Cone& angles : {Cone{0.3F, 0.6F}, Cone{0.0F, 0.7854F}, Cone{0.2F, 1.4F}}) {
        const Transform pose = looking({0.6F, 1.5F, 0.3F}, {0.1F, 0.0F, -0.3F});
        scene.world.set(scene.light, pose);
        scene.world.set(scene.light,
                        SpotLight{.intensity = 5.0F, .inner_cone = angles.inner, .outer_cone = angles.outer});
        check(scene, {}, 0.5, [&](glm::dvec3 p) {
            const glm::dvec3 light(pose.translation);
            const glm::dvec3 axis = glm::dquat(pose.rotation) * glm::dvec3(0, 0, -1);
            const double cosine = glm::dot(glm::normalize(p - light), axis);
            return 5.0 * point_irradiance(light, p, {0, 1, 0}) *
                   cone(cosine, static_cast<double>(angles.inner), static_cast<double>(angles.outer));
        });
    }
}

TEST_CASE_FIXTURE(ClosedForm, "spot lights are exact down to the narrowest cone") {
    Scene scene = ground();
    const glm::vec3 light(0.0F, 2.0F, 0.0F);
    scene.world.set(scene.light, looking(light, {0, 0, 0}, {0, 0, 1}));
    for (const float outer : {1e-2F, 1e-3F, 1e-4F}) {
        CAPTURE(outer);
        scene.world.set(scene.light, SpotLight{.intensity = 5.0F, .inner_cone = 0.0F, .outer_cone = outer});
        // Sees the lit disc, which has a radius of 2 · outer metres, from above.
        scene.world.set(scene.camera, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}));
        scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                             .half_height = 3.0F * outer,
                                             .near_plane = 0.1F,
                                             .far_plane = 10.0F});
        const Picture expected = expected_picture(scene, size, {}, {0, 1, 0}, [&](glm::dvec3 p) {
            const double cosine = (glm::dvec3(light) - p).y / glm::length(glm::dvec3(light) - p);
            return glm::dvec3(0.5 / pi * 5.0 * point_irradiance(light, p, {0, 1, 0}) *
                              cone(cosine, 0.0, static_cast<double>(outer)));
        });
        constexpr double peak = 0.5 / pi * 5.0 / 4.0;
        Configuration configuration = linear_configuration();
        configuration.indirect = false;
        configure(configuration);
        // Unit vectors are rounded by 6e-8, which is 6e-4 of the narrowest angle.
        CHECK(worst_error(render(scene, size), expected, peak) < 5e-3);
    }
}

TEST_CASE_FIXTURE(ClosedForm, "a plane under a directional light, steep and grazing") {
    Scene scene = ground();
    for (const glm::vec3 to_light :
         {glm::vec3(0.3F, 1.0F, 0.2F), glm::vec3(0, 1, 0), glm::vec3(3, 0.1F, 1)}) {
        scene.world.set(scene.light, looking(to_light, {0, 0, 0}, {0, 0, 1}));
        scene.world.set(scene.light, DirectionalLight{.illuminance = 2.0F});
        const double cosine = glm::normalize(glm::dvec3(to_light)).y;
        check(scene, {}, 0.5, [&](glm::dvec3) { return 2.0 * cosine; });
    }
}

TEST_CASE_FIXTURE(ClosedForm, "lights of several colours add up") {
    Scene scene = ground();
    scene.world.set(scene.light, at({0.4F, 1.0F, -0.2F}));
    scene.world.set(scene.light, PointLight{.colour = {1, 0, 0}, .intensity = 3.0F});
    add(scene.world, at({-0.4F, 1.5F, 0.3F}), PointLight{.colour = {0, 0, 1}, .intensity = 2.0F});
    add(scene.world, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}),
        DirectionalLight{.colour = {0, 0.5F, 0}, .illuminance = 2.0F});
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    const Picture expected = expected_picture(scene, size, {}, {0, 1, 0}, [](glm::dvec3 p) {
        const glm::dvec3 up(0, 1, 0);
        return 0.5 / pi *
               glm::dvec3(3.0 * point_irradiance(glm::vec3(0.4F, 1.0F, -0.2F), p, up), 1.0,
                          2.0 * point_irradiance(glm::vec3(-0.4F, 1.5F, 0.3F), p, up));
    });
    CHECK(worst_error(render(scene, size), expected, 1e-6) < tolerance);
}

TEST_CASE_FIXTURE(ClosedForm, "a plane seen by an orthographic camera") {
    Scene scene = ground();
    scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                         .half_height = 1.0F,
                                         .near_plane = 0.0F,
                                         .far_plane = 10.0F});
    const glm::vec3 light(0.4F, 1.0F, -0.2F);
    scene.world.set(scene.light, at(light));
    scene.world.set(scene.light, PointLight{});
    check(scene, {}, 0.5, [&](glm::dvec3 p) { return point_irradiance(light, p, {0, 1, 0}); });
}

TEST_CASE_FIXTURE(ClosedForm, "normals of tilted, sheared and mirrored instances") {
    const glm::vec3 light(0.4F, 2.0F, 0.6F);
    for (const float mirror : {1.0F, -1.0F}) {
        CAPTURE(mirror);
        Scene scene;
        // Rotated in a parent with non-uniform scale: neither rotation nor scale alone transforms the
        // normal.
        const Entity parent = add(scene.world, Transform{.scale = {mirror * 1.5F, 0.6F, 1.2F}});
        const glm::quat turn = glm::angleAxis(0.5F, glm::normalize(glm::vec3(1.0F, 0.3F, 0.4F)));
        const Entity plane =
            add(scene.world, Transform{.rotation = turn, .scale = {1, 1, 2}, .parent = parent},
                MeshInstance{square(4.0F, diffuse(glm::vec3(0.8F)))});
        scene.light = add(scene.world, at(light), PointLight{});
        scene.camera = add(scene.world, looking({0.2F, 2.5F, 0.6F}, {0, 0, 0}), Camera{});
        // The normal of the plane, from its tangents.
        const glm::dmat4 matrix(world_matrix(scene.world, plane));
        glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(matrix[2]), glm::dvec3(matrix[0])));
        normal *= normal.y < 0.0 ? -1.0 : 1.0;
        check(scene, {{0, 0, 0}, normal}, 0.8,
              [&](glm::dvec3 p) { return point_irradiance(light, p, normal); });
    }
}

TEST_CASE_FIXTURE(ClosedForm, "the back of a surface is lit from the back if it is double-sided") {
    for (const bool double_sided : {true, false}) {
        for (const float light_height : {-1.0F, 1.0F}) {
            CAPTURE(double_sided);
            CAPTURE(light_height);
            Scene scene;
            add(scene.world, Transform{}, MeshInstance{square(4.0F, diffuse(glm::vec3(0.5F), double_sided))});
            const glm::vec3 light(0.4F, light_height, -0.2F);
            scene.light = add(scene.world, at(light), PointLight{});
            scene.camera = add(scene.world, looking({0.3F, -3.0F, 1.2F}, {0, 0, 0}), Camera{});
            check(scene, {}, double_sided ? 0.5 : 0.0, [&](glm::dvec3 p) {
                return point_irradiance(light, p, {0, -1, 0});
            });
        }
    }
}

TEST_CASE_FIXTURE(ClosedForm, "images are decoded from sRGB and oriented as glTF specifies") {
    // Blocks of 4 × 4 texels, so that filtering does not reach their middles.
    constexpr std::uint32_t texels = 16;
    constexpr float half = 2.0F;
    Image image{.width = texels, .height = texels, .texels = {}};
    const auto value = [](std::uint32_t x, std::uint32_t y) {
        return glm::u8vec4(5 + 80 * (x / 4), 10 + 60 * (y / 4), 255 - 70 * (x / 4), 255);
    };
    for (std::uint32_t y = 0; y < texels; ++y) {
        for (std::uint32_t x = 0; x < texels; ++x) {
            image.texels.push_back(value(x, y));
        }
    }
    Material material;
    material.base_colour = {0.5F, 0.9F, 1.0F, 1.0F};
    material.base_colour_texture = std::make_shared<const Image>(std::move(image));
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(half, std::make_shared<const Material>(material))});
    add(scene.world, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}), DirectionalLight{.illuminance = 3.0F});
    scene.camera = add(scene.world, looking({0.1F, 3.0F, 0.9F}, {0, 0, 0}), Camera{});

    // The bytes of the image in the middle of each block; -1 elsewhere.
    const Picture expected = expected_picture(scene, size, {}, {0, 1, 0}, [&](glm::dvec3 p) {
        const glm::dvec2 at = (glm::dvec2(p.x, p.z) / (2.0 * static_cast<double>(half)) + 0.5) * 16.0;
        // Filtering reaches half a texel. A texel is at least 8 pixels wide, so nothing is minified.
        const glm::dvec2 from_middle = glm::abs(glm::mod(at, 4.0) - 2.0);
        const bool outside = std::min({at.x, at.y, 16.0 - at.x, 16.0 - at.y}) < 0.0;
        if (outside || std::max(from_middle.x, from_middle.y) > 1.4) return glm::dvec3(-1.0);
        return glm::dvec3(value(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y)));
    });
    // IEC 61966-2-1.
    const auto encode = [](double c) {
        return 255.0 * (c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055);
    };
    const glm::dvec3 scale = glm::dvec3(0.5, 0.9, 1.0) * 3.0 / pi;
    for (const ShadingPath path : {ShadingPath::forward, ShadingPath::deferred}) {
        Configuration configuration = linear_configuration(path);
        configuration.indirect = false;
        configure(configuration);
        const Picture picture = render(scene, size);
        double worst = 0.0;
        std::size_t compared = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            const glm::dvec3 byte(expected.pixels[i]);
            if (byte.r < 0.0) continue;
            ++compared;
            const glm::dvec3 albedo = glm::dvec3(picture.pixels[i]) / scale;
            for (int c = 0; c < 3; ++c) {
                worst = std::max(worst, std::abs(encode(albedo[c]) - byte[c]));
            }
        }
        CHECK(compared > picture.pixels.size() / 4);
        // Drivers may approximate the decoding by up to half a step of 8 bits.
        CHECK(worst < 0.5);
    }
}

}  // TEST_SUITE("closed forms")
