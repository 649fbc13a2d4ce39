#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "tests/reference/gltf_model.hpp"
#include "tests/reference/pictures.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("reference: glossy surfaces") {

using namespace candela;
using reference::Estimate;
using reference::GltfModel;
using reference::Settings;

namespace {

constexpr double pi = std::numbers::pi;

Estimate traced(const Scene& scene, const Settings& settings) {
    return trace(reference::Scene(scene.world), scene.camera, settings);
}

Material material_of(const GltfModel& model) {
    Material material;
    material.base_colour = glm::vec4(glm::vec3(static_cast<float>(model.base_colour)), 1.0F);
    material.metalness = static_cast<float>(model.metalness);
    material.roughness = static_cast<float>(model.roughness);
    material.specular = static_cast<float>(model.specular);
    material.ior = static_cast<float>(model.ior);
    return material;
}

std::shared_ptr<const Material> made_of(const GltfModel& model) {
    return std::make_shared<const Material>(material_of(model));
}

/// Reflects the same share of light from all directions, like a mirror.
GltfModel half_mirror() {
    return {.base_colour = 0.0, .roughness = 0.0, .specular = 0.5, .ior = 0.0};
}

std::shared_ptr<const Mesh> turned_outwards(const Mesh& inwards) {
    Mesh mesh = inwards;
    for (Primitive& primitive : mesh.primitives) {
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            std::swap(primitive.indices[i], primitive.indices[i + 1]);
        }
        for (Vertex& vertex : primitive.vertices) vertex.normal = -vertex.normal;
    }
    return std::make_shared<const Mesh>(std::move(mesh));
}

/// A camera 3 m above a square of 8 m × 8 m of this material at y = 0, looking at its middle at 45°.
Scene square_of(std::shared_ptr<const Material> material) {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(4.0F, std::move(material))});
    scene.camera = add(scene.world, looking({0, 3, 3}, {0, 0, 0}), Camera{.vertical_fov = 0.6F});
    return scene;
}

/// In the space of a surface that faces +Y: the normal is +Z there.
glm::dvec3 from_ground(glm::dvec3 v) {
    return {v.x, v.z, v.y};
}

/// Whether all pixels of a picture of grey surfaces are as expected; `value` takes the pixel's index.
void check_pixels(const tools::Picture& picture, const std::function<double(std::size_t)>& value,
                  double tolerance) {
    double worst = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const double truth = value(i);
        worst = std::max(worst, std::abs(static_cast<double>(picture.pixels[i].g) - truth) / truth);
    }
    CHECK(worst < tolerance);
}

/// A small rectangle of the ground at the origin, with the light of a lamp on a patch of a ceiling: the
/// camera is orthographic and sees about a point of the ground. The patch and the ground do not see
/// themselves, so that one bounce of indirect light takes one way: lamp, patch, ground, camera.
struct Patch {
    static constexpr double height = 1.0;
    static constexpr double half = 0.6;
    static constexpr glm::dvec3 lamp{0.3, 0.2, 0.5};
    static constexpr glm::dvec3 eye{-1.5, 1.2, 1.4};

    static Scene scene(const GltfModel& ground, std::shared_ptr<const Material> patch) {
        Scene scene;
        add(scene.world, Transform{}, MeshInstance{square(0.02F, made_of(ground))});
        add(scene.world, upside_down_at({0, static_cast<float>(height), 0}),
            MeshInstance{square(static_cast<float>(half), std::move(patch))});
        scene.light = add(scene.world, at(glm::vec3(lamp)), PointLight{.intensity = 3.0F});
        scene.camera = add(scene.world, looking(glm::vec3(eye), {0, 0, 0}),
                           Camera{.projection = Camera::Projection::orthographic,
                                  .half_height = 0.005F,
                                  .near_plane = 0.0F,
                                  .far_plane = 4.0F});
        return scene;
    }

    /// The midpoint rule over the patch.
    static double truth(const GltfModel& ground, const GltfModel& patch) {
        constexpr int steps = 400;
        const glm::dvec3 viewer = from_ground(glm::normalize(eye));
        double sum = 0.0;
        for (int i = 0; i < steps * steps; ++i) {
            const glm::dvec3 place(half * (2.0 * (i % steps + 0.5) / steps - 1.0), height,
                                   half * (2.0 * (i / steps + 0.5) / steps - 1.0));
            const glm::dvec3 to_lamp = lamp - place;
            const double squared = glm::dot(to_lamp, to_lamp);
            // The patch faces down: upside down it is as the ground.
            const glm::dvec3 flip(1, -1, 1);
            const double radiance = patch.reflected(from_ground(flip * -glm::normalize(place)),
                                                    from_ground(flip * to_lamp / std::sqrt(squared))) *
                                    3.0 / squared;
            const double distance = glm::length(place);
            const double solid_angle = place.y / (distance * distance * distance);  // of a unit area
            sum += ground.reflected(viewer, from_ground(place / distance)) * radiance * solid_angle;
        }
        return sum * 4.0 * half * half / (double(steps) * steps);
    }
};

}  // namespace

TEST_CASE("a plane under a point light is what the formulas say, at every pixel") {
    for (const GltfModel& model : {GltfModel{.base_colour = 0.8, .metalness = 1.0, .roughness = 0.5},
                                   GltfModel{.base_colour = 0.6, .roughness = 0.3},
                                   GltfModel{.base_colour = 0.6, .metalness = 0.4, .roughness = 0.8},
                                   GltfModel{.roughness = 0.4, .specular = 0.5, .ior = 1.8}}) {
        Scene scene = square_of(made_of(model));
        const glm::dvec3 lamp(0.4, 1.0, -0.2);
        scene.light = add(scene.world, at(glm::vec3(lamp)), PointLight{.intensity = 2.0F});
        const glm::uvec2 size(48, 32);
        const auto radiance = [&](glm::dvec3 place) {
            const glm::dvec3 to_lamp = lamp - place;
            const double squared = glm::dot(to_lamp, to_lamp);
            const glm::dvec3 viewer = glm::normalize(glm::dvec3(0, 3, 3) - place);
            return glm::dvec3(
                model.reflected(from_ground(viewer), from_ground(to_lamp / std::sqrt(squared))) * 2.0 /
                squared);
        };
        const auto expected =
            reference::flipped(expected_picture(scene, size, glm::dvec3(0.0), {0, 1, 0}, radiance));
        const Estimate estimate = traced(scene, {.size = size, .samples = 2, .bounces = 0});
        // Floats: the slope of GGX multiplies the rounding of the half vector.
        CHECK(reference::worst_error(estimate.direct, expected, estimate.hit, 0.0) < 1e-4);
    }
}

TEST_CASE("the highlight of a point light in a mirror is as wide as alpha = 1/512") {
    Scene scene = square_of(made_of({.metalness = 1.0, .roughness = 0.0}));
    scene.light = add(scene.world, at({0, 3, -3}), PointLight{.intensity = 2.0F});
    // An odd number of pixels: the middle one sees the lamp's mirror image.
    const Estimate estimate = traced(scene, {.size = {3, 3}, .samples = 2, .bounces = 0});
    const double cosine = std::sqrt(0.5);
    const double alpha = 1.0 / 512.0;
    const double smith = std::sqrt(alpha * alpha + (1.0 - alpha * alpha) * cosine * cosine);
    const double peak = 1.0 / (pi * alpha * alpha) * 0.5 / (2.0 * cosine * smith) * cosine * 2.0 / 18.0;
    // 1e-7 of rounding in the half vector is 5e-5 of the width.
    CHECK(static_cast<double>(estimate.direct.pixels[4].g) == doctest::Approx(peak).epsilon(1e-3));
}

TEST_CASE("a ball under a uniform sky shows its directional albedo") {
    // A view along parallel lines: the cosine of the normal follows from the place in the picture.
    constexpr std::uint32_t side = 24;
    constexpr int nodes = 40;
    for (const double metalness : {1.0, 0.0}) {
        for (int step = 0; step < 10; ++step) {
            const GltfModel model{
                .base_colour = 0.5, .metalness = metalness, .roughness = 0.05 + 0.95 * step / 9.0};
            Scene scene;
            add(scene.world, Transform{},
                MeshInstance{turned_outwards(*sphere_inwards(1.0F, 6, made_of(model)))});
            add(scene.world, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
            scene.camera = add(scene.world, looking({0, 0, 3}, {0, 0, 0}),
                               Camera{.projection = Camera::Projection::orthographic,
                                      .half_height = 0.6F,
                                      .near_plane = 0.0F,
                                      .far_plane = 4.0F});
            const Estimate estimate = traced(scene, {.size = glm::uvec2(side), .samples = 64, .bounces = 0});
            std::vector<double> albedo;  // by the cosine
            for (int i = 0; i <= nodes; ++i) {
                albedo.push_back(reference::directional_albedo(model, 0.4 + 0.6 * i / nodes));
            }
            double sum = 0.0;
            double truth = 0.0;
            for (std::uint32_t i = 0; i < side * side; ++i) {
                const glm::dvec2 place = 1.2 * ((glm::dvec2(i % side, i / side) + 0.5) / double(side) - 0.5);
                const double cosine = std::sqrt(1.0 - glm::dot(place, place));
                const double at = (cosine - 0.4) / 0.6 * nodes;
                const auto node = std::min(static_cast<std::size_t>(at), albedo.size() - 2);
                truth += glm::mix(albedo[node], albedo[node + 1], at - static_cast<double>(node));
                sum += static_cast<double>(estimate.direct.pixels[i].g);
            }
            CAPTURE(model.metalness);
            CAPTURE(model.roughness);
            // 576 pixels × 64 samples, of which each has an error of less than half its value: 0.3 %.
            // Facets of 1° hide as little of the sky, and of the lobe of grazing light.
            CHECK(sum == doctest::Approx(truth).epsilon(0.01));
        }
    }
}

TEST_CASE("a mirror shows an emitter and a sky as they are") {
    const double fresnel_45 = 0.04 + 0.96 * std::pow(1.0 - std::sqrt(0.5), 5.0);
    const GltfModel silver{.base_colour = 1.0, .metalness = 1.0, .roughness = 0.0};
    const GltfModel black_glass{.base_colour = 0.0, .roughness = 0.0};
    const auto middle = [](const Estimate& estimate) {
        return static_cast<double>(estimate.direct.pixels[4].g);
    };
    const Settings settings{.size = {3, 3}, .samples = 64, .bounces = 0};
    SUBCASE("an emitter") {
        for (const auto& [model, share] : {std::pair(silver, 1.0), std::pair(black_glass, fresnel_45)}) {
            Scene scene = square_of(made_of(model));
            // It faces the middle of the square, where the camera's mirror image is.
            Transform pose = looking({0, 2, -2}, {0, 0, 0});
            pose.rotation = pose.rotation * glm::angleAxis(float(-pi / 2.0), glm::vec3(1, 0, 0));
            add(scene.world, pose, MeshInstance{square(0.8F, emitter(glm::vec3(5.0F)))});
            CHECK(middle(traced(scene, settings)) == doctest::Approx(5.0 * share).epsilon(0.01));
        }
    }
    SUBCASE("a sky") {
        for (const auto& [model, share] : {std::pair(silver, 1.0), std::pair(black_glass, fresnel_45)}) {
            Scene scene = square_of(made_of(model));
            add(scene.world, Environment{.radiance = glm::vec3(2.0F), .picture = nullptr});
            CHECK(middle(traced(scene, settings)) == doctest::Approx(2.0 * share).epsilon(0.01));
        }
    }
    SUBCASE("a picture of a sky") {
        const auto shown = std::make_shared<SkyPicture>(SkyPicture{8, 4, {}});
        for (int i = 0; i < 32; ++i) shown->texels.emplace_back(1.0F + static_cast<float>(i * i % 7));
        Scene scene = square_of(made_of(silver));
        add(scene.world, Environment{.radiance = glm::vec3(1.0F), .picture = shown});
        const glm::uvec2 size(24, 16);
        // A direction that the sky draws beside the mirror direction counts half: now and then there
        // is one, of 256.
        const Estimate mirrored = traced(scene, {.size = size, .samples = 256, .bounces = 0});
        // The camera's mirror image, whose picture is upside down.
        Scene above;
        add(above.world, Environment{.radiance = glm::vec3(1.0F), .picture = shown});
        above.camera = add(above.world, looking({0, -3, 3}, {0, 0, 0}), Camera{.vertical_fov = 0.6F});
        const Estimate seen = traced(above, {.size = size, .samples = 2, .bounces = 0});
        check_pixels(
            mirrored.direct,
            [&](std::size_t i) {
                const std::size_t row = size.y - 1 - i / size.x;
                return static_cast<double>(seen.direct.pixels[row * size.x + i % size.x].g);
            },
            0.01);
    }
}

TEST_CASE("a mirror shows a lit surface as it is") {
    Scene scene = square_of(made_of({.base_colour = 1.0, .metalness = 1.0, .roughness = 0.0}));
    scene.light = add(scene.world, at({0.4F, 1, -1}), PointLight{.intensity = 3.0F});
    const glm::quat upright = glm::angleAxis(float(pi / 2.0), glm::vec3(1, 0, 0));
    add(scene.world, Transform{.translation = {0, 2, -3}, .rotation = upright},
        MeshInstance{square(2.0F, diffuse(glm::vec3(0.6F)))});
    const glm::uvec2 size(24, 16);
    Scene above = scene;
    above.world.set(above.camera, looking({0, -3, 3}, {0, 0, 0}));
    const Estimate seen = traced(above, {.size = size, .samples = 2, .bounces = 0});
    for (const bool caustics : {true, false}) {
        const Estimate mirrored =
            traced(scene, {.size = size, .samples = 64, .bounces = 1, .caustics = caustics});
        for (std::size_t i = 0; i < mirrored.hit.size(); ++i) {
            const std::size_t row = size.y - 1 - i / size.x;
            const float truth = seen.direct.pixels[row * size.x + i % size.x].g;
            // The mirror is single-sided: from below it is not seen.
            if (truth > 0.0F) {
                CHECK(mirrored.indirect.pixels[i].g == doctest::Approx(truth).epsilon(0.01));
            }
        }
    }
}

TEST_CASE("light from one glossy surface to another is the integral over them") {
    const GltfModel chalk{.base_colour = 0.8, .specular = 0.0};
    const GltfModel metal{.base_colour = 0.8, .metalness = 1.0, .roughness = 0.5};
    const GltfModel plastic{.base_colour = 0.5, .roughness = 0.3};
    const GltfModel smooth{.base_colour = 0.8, .metalness = 1.0, .roughness = 0.2};
    const std::vector<std::pair<GltfModel, GltfModel>> pairs{
        {chalk, chalk}, {metal, chalk}, {chalk, metal}, {plastic, metal}, {metal, plastic}, {smooth, chalk}};
    for (const auto& pair : pairs) {
        const GltfModel& ground = pair.first;
        const GltfModel& patch = pair.second;
        const Scene scene = Patch::scene(ground, made_of(patch));
        const Estimate estimate = traced(scene, {.size = {16, 16}, .samples = 1024, .bounces = 1});
        const reference::NoisyMean mean = reference::mean_indirect(estimate, estimate.hit);
        const double truth = Patch::truth(ground, patch);
        CAPTURE(ground.roughness);
        CAPTURE(patch.roughness);
        CHECK(mean.error < 0.01 * truth);
        // The camera sees 1 cm of the ground.
        CHECK(std::abs(mean.value - truth) < 4.0 * mean.error + 0.002 * truth);
    }
}

TEST_CASE("in a closed sphere of mirrors that emit light, light adds up to emission / (1 - reflectance)") {
    // Each surface is found by drawing emitters, and by looking around: it must count once.
    Scene scene;
    Material material = material_of(half_mirror());
    material.emissive = glm::vec3(1.0F);
    add(scene.world, Transform{},
        MeshInstance{sphere_inwards(2.0F, 4, std::make_shared<const Material>(std::move(material)))});
    scene.camera = add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
    for (const bool caustics : {true, false}) {
        const Estimate estimate = traced(scene, {.size = {16, 16}, .samples = 256, .caustics = caustics});
        const reference::NoisyMean indirect = reference::mean_indirect(estimate, estimate.hit);
        CHECK(mean(candela::Picture{{16, 16}, estimate.direct.pixels}) ==
              doctest::Approx(1.5).epsilon(0.005));
        CHECK(indirect.error < 0.01);
        CHECK(std::abs(indirect.value - 0.5) < 4.0 * indirect.error + 0.002);
    }
}

TEST_CASE("factors and the texture of metalness and roughness multiply, and the texture is linear") {
    const auto picture = [](float metalness, float roughness, std::shared_ptr<const Image> texture) {
        Material material = material_of({.base_colour = 0.8, .metalness = metalness, .roughness = roughness});
        material.metal_roughness_texture = std::move(texture);
        Scene scene = square_of(std::make_shared<const Material>(std::move(material)));
        scene.light = add(scene.world, at({0.4F, 1, -0.2F}), PointLight{.intensity = 2.0F});
        return traced(scene, {.size = {16, 16}, .samples = 2, .bounces = 0}).direct;
    };
    Image image{.width = 1, .height = 1, .texels = {{7, 102, 51, 255}}, .encoding = Encoding::linear};
    const auto with = picture(1.0F, 1.0F, std::make_shared<const Image>(image));
    const auto without = picture(51.0F / 255.0F, 102.0F / 255.0F, nullptr);
    check_pixels(
        with, [&](std::size_t i) { return static_cast<double>(without.pixels[i].g); }, 1e-5);
}

TEST_CASE("a Lambertian surface is the same whatever its roughness, to the last bit") {
    const auto picture = [](float roughness, bool caustics) {
        Scene scene = furnace_box(0.5F);
        Material material = *diffuse(glm::vec3(0.5F));
        material.roughness = roughness;
        material.ior = 2.0F;
        add(scene.world, at({0, -0.5F, 0}),
            MeshInstance{square(0.4F, std::make_shared<const Material>(std::move(material)))});
        return total(traced(scene, {.size = {16, 16}, .samples = 16, .caustics = caustics}));
    };
    CHECK(picture(0.2F, true).pixels == picture(1.0F, true).pixels);
    CHECK(picture(0.2F, false).pixels == picture(1.0F, true).pixels);
}

TEST_CASE("without caustics, Lambertian surfaces see Lambertian ones of equal albedo") {
    const GltfModel model{.base_colour = 0.7, .metalness = 1.0, .roughness = 0.4};
    const auto indirect = [](std::shared_ptr<const Material> material, bool caustics) {
        const Scene scene = Patch::scene({.base_colour = 0.8, .specular = 0.0}, std::move(material));
        const Estimate estimate = traced(scene, {.size = {8, 8}, .samples = 256, .caustics = caustics});
        return static_cast<double>(reference::mean_indirect(estimate, estimate.hit).value);
    };
    const auto albedo = static_cast<float>(reference::mean_albedo(model));
    const double standing_in = indirect(diffuse(glm::vec3(albedo)), true);
    // The same random numbers: only the albedo's own error of 0.003 is left.
    CHECK(indirect(made_of(model), false) == doctest::Approx(standing_in).epsilon(0.006));
    CHECK(std::abs(indirect(made_of(model), true) - standing_in) > 0.05 * standing_in);
}

TEST_CASE("without caustics, what smooth surfaces show is glossy, and what rough ones show is not") {
    const GltfModel chalk{.base_colour = 0.8, .specular = 0.0};
    const GltfModel metal{.base_colour = 0.8, .metalness = 1.0, .roughness = 0.4};
    const auto same = [&](const GltfModel& ground) {
        const Scene scene = Patch::scene(ground, made_of(metal));
        const auto indirect = [&](bool caustics) {
            const Estimate estimate =
                traced(scene, {.size = {16, 16}, .samples = 256, .bounces = 1, .caustics = caustics});
            return reference::mean_indirect(estimate, estimate.hit);
        };
        const reference::NoisyMean with = indirect(true);
        const reference::NoisyMean without = indirect(false);
        return std::abs(with.value - without.value) < 4.0 * std::hypot(with.error, without.error);
    };
    CHECK(same({.base_colour = 0.8, .metalness = 1.0, .roughness = 0.25}));
    CHECK_FALSE(same({.base_colour = 0.8, .metalness = 1.0, .roughness = 0.6}));
    CHECK_FALSE(same(chalk));
}

}  // TEST_SUITE("reference: glossy surfaces")
