#include "tests/reference/closed_forms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "tests/area_lights.hpp"
#include "tests/reference/pictures.hpp"

namespace candela::reference {

namespace {

constexpr double pi = std::numbers::pi;

/// Floating-point error: a cosine is accurate to about 3e-7. The ramp of the spot's cone amplifies that by
/// 7.7, and, where the square of the ramp is 0.01, by another 2 / 0.1.
constexpr double float_tolerance = 1e-4;
constexpr double standard_errors = 4.0;

using Irradiance = std::function<double(glm::dvec3)>;

/// The irradiance, by Lambert's law, of a light of 1 cd on a surface that faces +Y.
double lambert(glm::dvec3 light, glm::dvec3 at) {
    const glm::dvec3 to_light = light - at;
    return to_light.y / std::pow(glm::length(to_light), 3.0);
}

template <class LightComponent>
candela::Scene lit_ground(const Transform& pose, const LightComponent& light) {
    candela::Scene scene = ground();
    scene.world.set(scene.light, pose);
    scene.world.set(scene.light, light);
    return scene;
}

bool shows(const candela::Scene& scene, const Irradiance& irradiance, Defect defect) {
    const glm::uvec2 size(96, 64);
    const auto radiance = [&](glm::dvec3 at) { return glm::dvec3(0.5 / pi * irradiance(at)); };
    const tools::Picture expected =
        flipped(expected_picture(scene, size, glm::dvec3(0.0), {0, 1, 0}, radiance));
    const Estimate estimate =
        trace(Scene(scene.world), scene.camera, {.size = size, .samples = 2, .bounces = 0, .defect = defect});
    const auto brighter = [](glm::vec3 a, glm::vec3 b) { return a.r < b.r; };
    const glm::vec3 peak = *std::max_element(expected.pixels.begin(), expected.pixels.end(), brighter);
    // Where a falloff reaches zero its terms cancel: there, the error is relative to 1 % of the peak.
    const double floor = 0.01 * static_cast<double>(peak.r);
    const double error = worst_error(estimate.direct, expected, estimate.hit, floor);
    MESSAGE("worst error of the plane: ", error);
    return error < float_tolerance;
}

constexpr glm::vec3 lamp{0.4F, 1.0F, -0.2F};

Estimate trace_inside(const candela::Scene& scene, glm::uvec2 size, std::uint32_t samples,
                      std::optional<std::uint32_t> bounces, Defect defect) {
    return trace(Scene(scene.world), scene.camera,
                 {.size = size, .samples = samples, .bounces = bounces, .defect = defect});
}

bool is_within(const NoisyMean& mean, double truth, double tolerance) {
    MESSAGE("mean ", mean.value, " for ", truth, " with a standard error of ", mean.error);
    return std::abs(mean.value - truth) < standard_errors * mean.error + tolerance * truth;
}

/// A sphere of radius 2 m around a light of 3 cd.
candela::Scene sphere_around_light(double albedo) {
    candela::Scene scene;
    const auto material = diffuse(glm::vec3(static_cast<float>(albedo)));
    add(scene.world, Transform{}, MeshInstance{sphere_inwards(2.0F, 5, material)});
    scene.light = add(scene.world, Transform{}, PointLight{.intensity = 3.0F});
    scene.camera = add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
    return scene;
}

/// Discs of radius 1 m, 1 m apart, facing each other. The light arrives at a slant between them, so that the
/// shadow of the upper disc falls next to the lower one, which is lit uniformly. The upper disc faces away
/// from the light.
struct Discs {
    static constexpr double radius = 1.0;
    static constexpr double distance = 1.0;
    static constexpr double lower_albedo = 0.8;
    static constexpr double upper_albedo = 0.5;
    static constexpr double illuminance = 4.0;
    /// Of atan 3: the shadow is offset by 3 m, more than 2 radii.
    static constexpr double cosine = 0.31622776601683794;
};

/// A disc in the plane y = 0 that faces +Y, as a polygon whose area is that of the circle to 2e-5.
std::shared_ptr<const Mesh> disc(double albedo) {
    constexpr std::uint32_t corners = 600;
    const glm::vec3 up(0, 1, 0);
    Primitive primitive{.vertices = {{glm::vec3(0.0F), up, {}}},
                        .indices = {},
                        .material = diffuse(glm::vec3(static_cast<float>(albedo)))};
    for (std::uint32_t i = 0; i < corners; ++i) {
        const double angle = -2.0 * pi * i / corners;
        const glm::vec3 corner(glm::dvec3(std::cos(angle), 0.0, std::sin(angle)) * Discs::radius);
        primitive.vertices.push_back({corner, up, {}});
        primitive.indices.insert(primitive.indices.end(), {0U, 1 + i, 1 + (i + 1) % corners});
    }
    return std::make_shared<const Mesh>(Mesh{"disc", {std::move(primitive)}});
}

candela::Scene two_discs() {
    candela::Scene scene;
    add(scene.world, Transform{}, MeshInstance{disc(Discs::lower_albedo)});
    const glm::quat upside_down = glm::angleAxis(static_cast<float>(pi), glm::vec3(1, 0, 0));
    const Transform above{.translation = {0, Discs::distance, 0}, .rotation = upside_down};
    add(scene.world, above, MeshInstance{disc(Discs::upper_albedo)});
    scene.light = add(scene.world, looking({3, 1, 0}, {0, 0, 0}),
                      DirectionalLight{.illuminance = static_cast<float>(Discs::illuminance)});
    scene.camera = add(scene.world, looking({0, 0.5F, 0}, {0, 1, 0}, {0, 0, 1}),
                       Camera{.projection = Camera::Projection::orthographic,
                              .half_height = static_cast<float>(Discs::radius),
                              .near_plane = 0.0F,
                              .far_plane = 2.0F});
    return scene;
}

/// The form factor from an element to a parallel disc, with the element `aside` from the disc's axis: Howell,
/// "A Catalog of Radiation Heat Transfer Configuration Factors", B-13.
double element_to_disc(double aside) {
    const double a = aside * aside;
    const double h = Discs::distance * Discs::distance;
    const double r = Discs::radius * Discs::radius;
    return 0.5 * (1.0 - (a + h - r) / std::sqrt(std::pow(a + h + r, 2.0) - 4.0 * r * a));
}

/// The form factor between two equal discs: the same catalogue, C-41.
double disc_to_disc() {
    const double r = Discs::radius / Discs::distance;
    const double s = 2.0 + 1.0 / (r * r);
    return 0.5 * (s - std::sqrt(s * s - 4.0));
}

/// The radiance of the upper disc for a form factor.
double upper_radiance(double form_factor) {
    return Discs::upper_albedo / pi * Discs::lower_albedo * Discs::illuminance * Discs::cosine * form_factor;
}

tools::Picture expected_disc(const candela::Scene& scene, glm::uvec2 size) {
    return flipped(expected_picture(scene, size, {0, Discs::distance, 0}, {0, 1, 0}, [](glm::dvec3 at) {
        return glm::dvec3(upper_radiance(element_to_disc(std::hypot(at.x, at.z))));
    }));
}

constexpr glm::uvec2 disc_pixels{128, 128};

Estimate trace_discs(const candela::Scene& scene, Defect defect) {
    return trace_inside(scene, disc_pixels, 128, 1, defect);
}

/// The mean over the pixels of their ratio to those expected, whose errors are independent.
NoisyMean mean_ratio(const tools::Picture& picture, const tools::Picture& expected) {
    double sum = 0.0;
    double squares = 0.0;
    const auto count = static_cast<double>(expected.pixels.size());
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const auto truth = static_cast<double>(expected.pixels[i].r);
        const double error = static_cast<double>(picture.pixels[i].r) / truth - 1.0;
        sum += error;
        squares += error * error;
    }
    return {1.0 + sum / count, std::sqrt(squares) / count};
}

}  // namespace

bool plane_under_point_light(Defect defect) {
    const candela::Scene scene = lit_ground(at(lamp), PointLight{.intensity = 3.0F});
    return shows(
        scene, [](glm::dvec3 p) { return 3.0 * lambert(lamp, p); }, defect);
}

bool plane_under_ranged_light(Defect defect) {
    const candela::Scene scene = lit_ground(at(lamp), PointLight{.intensity = 3.0F, .range = 1.5F});
    const auto irradiance = [](glm::dvec3 p) {
        // KHR_lights_punctual: max(min(1 - (r / range)⁴, 1), 0) / r².
        const double window = 1.0 - std::pow(glm::length(glm::dvec3(lamp) - p) / 1.5, 4.0);
        return 3.0 * lambert(lamp, p) * std::max(window, 0.0);
    };
    return shows(scene, irradiance, defect);
}

bool plane_under_spot_light(Defect defect) {
    const Transform pose = looking({0.6F, 1.5F, 0.3F}, {0.1F, 0.0F, -0.3F});
    const candela::Scene scene =
        lit_ground(pose, SpotLight{.intensity = 5.0F, .inner_cone = 0.3F, .outer_cone = 0.6F});
    const glm::dvec3 place(pose.translation);
    const glm::dvec3 axis = glm::dquat(pose.rotation) * glm::dvec3(0, 0, -1);
    const auto irradiance = [&](glm::dvec3 p) {
        // KHR_lights_punctual: the square of a ramp in the cosine between the cones.
        const double cosine = glm::dot(glm::normalize(p - place), axis);
        const double ramp = (cosine - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6));
        return 5.0 * lambert(place, p) * std::pow(std::clamp(ramp, 0.0, 1.0), 2.0);
    };
    return shows(scene, irradiance, defect);
}

bool plane_under_directional_light(Defect defect) {
    const glm::vec3 to_light(0.9F, 1.0F, 0.2F);
    const candela::Scene scene =
        lit_ground(looking(to_light, {0, 0, 0}), DirectionalLight{.illuminance = 2.0F});
    const double cosine = glm::normalize(glm::dvec3(to_light)).y;
    return shows(
        scene, [&](glm::dvec3) { return 2.0 * cosine; }, defect);
}

namespace {

/// Whether a square of this material emits light of a radiance of 1 from `left` on, of -1 to 1.
bool plane_under_square(const std::shared_ptr<const Material>& material, float left) {
    candela::Scene scene = ground();
    constexpr float half = 0.3F;
    add(scene.world, upside_down_at(lamp), MeshInstance{square(half, material)});
    const auto corner = [](float x, float z) { return glm::dvec3(lamp + half * glm::vec3(x, 0.0F, z)); };
    const std::array corners{corner(left, -1), corner(1, -1), corner(1, 1), corner(left, 1)};

    const glm::uvec2 size(96, 64);
    const tools::Picture expected =
        flipped(expected_picture(scene, size, glm::dvec3(0.0), {0, 1, 0}, [&](glm::dvec3 at) {
            return glm::dvec3(0.5 / pi * irradiance_of_polygon(corners, at, {0, 1, 0}));
        }));
    const Estimate estimate = trace_inside(scene, size, 512, 0, Defect::none);
    const NoisyMean mean = mean_ratio(estimate.direct, expected);
    return mean.error < 1e-3 && is_within(mean, 1.0, float_tolerance);
}

}  // namespace

bool plane_under_rectangle() {
    return plane_under_square(emitter(glm::vec3(1.0F)), -1.0F);
}

bool plane_under_half_a_rectangle() {
    Material material = *emitter(glm::vec3(1.0F));
    material.alpha_mode = AlphaMode::mask;
    // Alpha reaches the cutoff of 1/2 midway between the middles of the two texels.
    material.base_colour_texture = std::make_shared<const Image>(Image{
        .width = 2, .height = 1, .texels = {{0, 0, 0, 0}, {0, 0, 0, 255}}, .wrap_u = Wrap::clamp_to_edge});
    return plane_under_square(std::make_shared<const Material>(std::move(material)), 0.0F);
}

namespace {

/// Whether the direct light of the ground's middle is as expected, and the noise of its estimate is small.
bool middle_is(const candela::Scene& scene, double expected) {
    const Estimate estimate = trace_inside(scene, {16, 16}, 4096, 0, Defect::none);
    const tools::Picture truth{estimate.direct.size, std::vector(estimate.direct.pixels.size(),
                                                                 glm::vec3(static_cast<float>(expected)))};
    const NoisyMean mean = mean_ratio(estimate.direct, truth);
    return mean.error < 2e-3 && is_within(mean, 1.0, float_tolerance);
}

/// The ground's middle, seen through a narrow lens.
candela::Scene middle_of_ground() {
    candela::Scene scene = ground();
    scene.camera = add(scene.world, looking({0.3F, 0.4F, 0.0F}, {0, 0, 0}), Camera{.vertical_fov = 0.001F});
    return scene;
}

}  // namespace

bool plane_under_uniform_sky() {
    candela::Scene scene = middle_of_ground();
    add(scene.world, Environment{.radiance = glm::vec3(2.0F), .picture = nullptr});
    return middle_is(scene, 0.5 * 2.0);
}

bool plane_beside_wall() {
    candela::Scene scene = middle_of_ground();
    add(scene.world, Environment{.radiance = glm::vec3(2.0F), .picture = nullptr});
    constexpr float distance = 0.7F;
    add(scene.world,
        Transform{.translation = {-distance, 1.0F, 0.0F},
                  .rotation = glm::angleAxis(static_cast<float>(-pi / 2), glm::vec3(0, 0, 1)),
                  .scale = {1.0F, 1.0F, 100.0F}},
        MeshInstance{square(1.0F, diffuse(glm::vec3(0.0F), true))});
    // 2 m high and 200 m long, practically endless: it hides (1 - d / √(d² + h²)) / 2 of the light.
    const double hidden =
        0.5 * (1.0 - static_cast<double>(distance) / std::hypot(static_cast<double>(distance), 2.0));
    return middle_is(scene, 0.5 * 2.0 * (1.0 - hidden));
}

bool plane_under_bright_texel() {
    constexpr std::uint32_t width = 64, height = 32, column = 20, row = 8;
    SkyPicture picture{width, height, std::vector<glm::vec3>(std::size_t{width} * height, glm::vec3(0.0F))};
    picture.texels[row * width + column] = glm::vec3(500.0F);
    candela::Scene scene = middle_of_ground();
    const float rotation = 1.1F;
    add(scene.world, Environment{.radiance = glm::vec3(1.0F),
                                 .picture = std::make_shared<const SkyPicture>(std::move(picture)),
                                 .rotation = rotation});
    // ∫ L cos θ dω over the ground's hemisphere. Between the middles of texels the radiance is bilinear: a
    // tent, over two texels across and two down.
    constexpr int steps = 400;
    double expected = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double off = 2.0 * (i + 0.5) / steps - 1.0;  // from the texel's middle, in texels
        const double polar = pi * (row + 0.5 + off) / height;
        expected += (1.0 - std::abs(off)) * std::cos(polar) * std::sin(polar) * (2.0 / steps);
    }
    expected *= 500.0 * (pi / height) * (2.0 * pi / width);
    return middle_is(scene, 0.5 / pi * expected);
}

bool glowing_sphere(double albedo) {
    candela::Scene scene;
    constexpr double radiance = 2.0;
    const auto material = emitter(glm::vec3(static_cast<float>(radiance)), static_cast<float>(albedo));
    add(scene.world, Transform{}, MeshInstance{sphere_inwards(2.0F, 4, material)});
    scene.camera = add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
    const Estimate estimate = trace_inside(scene, {16, 16}, 256, std::nullopt, Defect::none);
    const double direct = radiance * (1.0 + albedo);
    // Every way finds an emitter, and only the weights of the two ways vary: 256 samples have 1 % of noise.
    const double seen = candela::mean(candela::Picture{{16, 16}, estimate.direct.pixels});
    MESSAGE("direct ", seen, " for ", direct);
    return std::abs(seen / direct - 1.0) < 0.005 &&
           is_within(mean_indirect(estimate, estimate.hit), radiance / (1.0 - albedo) - direct, 1e-3);
}

bool sphere_furnace(double albedo, Defect defect) {
    const candela::Scene scene = sphere_around_light(albedo);
    const double direct = albedo / pi * 3.0 / 4.0;
    // The centres of facets are nearer to the light by up to 0.03 %, and light hits them at up to 1.3°.
    constexpr double facets = 1e-3;
    bool agrees = true;
    double reflected = 0.0;
    for (const std::uint32_t bounces : {1U, 2U, 3U}) {
        reflected += direct * std::pow(albedo, bounces);
        const Estimate estimate = trace_inside(scene, {16, 16}, 32, bounces, defect);
        agrees = agrees && is_within(mean_indirect(estimate, estimate.hit), reflected, facets);
    }
    const Estimate all = trace_inside(scene, {16, 16}, 128, std::nullopt, defect);
    NoisyMean mean = mean_indirect(all, all.hit);
    mean.value += static_cast<double>(all.direct.pixels.front().r);
    // The light of a path varies as much as its number of bounces: 32,768 paths have 0.6 % of noise at most.
    return agrees && mean.error < 0.006 * mean.value && is_within(mean, direct / (1.0 - albedo), facets);
}

bool box_furnace(double albedo, Defect defect) {
    candela::Scene scene = furnace_box(static_cast<float>(albedo));
    scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                         .half_height = 1.0F,
                                         .near_plane = 0.0F,
                                         .far_plane = 4.0F});
    // Means over the six walls of 2 m × 2 m, each seen head-on.
    NoisyMean walls{0.0, 0.0};
    for (const glm::vec3 wall : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),
                                 glm::vec3(0, -1, 0), glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
        const glm::vec3 up(0, wall.y == 0.0F, wall.y != 0.0F);
        scene.world.set(scene.camera, looking({0, 0, 0}, wall, up));
        const Estimate estimate = trace_inside(scene, {32, 32}, 16, std::nullopt, defect);
        const NoisyMean mean = mean_indirect(estimate, estimate.hit);
        const double direct = candela::mean(candela::Picture{{32, 32}, estimate.direct.pixels});
        walls.value += (mean.value + direct) / 6.0;
        walls.error = std::hypot(walls.error, mean.error / 6.0);
    }
    // The light of 1 cd emits 4π lm onto 24 m². Sums over pixels integrate its irradiance to 0.1 %.
    const double arriving = 4.0 * pi / 24.0 / (1.0 - albedo);
    return is_within(walls, albedo / pi * arriving, 1e-3);
}

bool parallel_discs(Defect defect) {
    const candela::Scene scene = two_discs();
    const tools::Picture expected = expected_disc(scene, disc_pixels);
    const Estimate estimate = trace_discs(scene, defect);
    const double ratio = noise_ratio(estimate, expected, estimate.hit);
    MESSAGE("squared error of the disc: ", ratio, " times its noise");
    // 12,900 pixels: the ratio of two sums of squares has a standard deviation of √(4 / 12900) = 2 %.
    const bool point_by_point = ratio < 1.1;
    // 128 × 128 pixels sample the disc to about 1e-4.
    return point_by_point &&
           is_within(mean_indirect(estimate, estimate.hit), upper_radiance(disc_to_disc()), 5e-4);
}

bool noise_of_discs() {
    const candela::Scene scene = two_discs();
    const Estimate estimate = trace_discs(scene, Defect::none);
    const double ratio = noise_ratio(estimate, expected_disc(scene, disc_pixels), estimate.hit);
    return std::abs(ratio - 1.0) < 0.1;
}

}  // namespace candela::reference
