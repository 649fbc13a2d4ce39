// Glossy surfaces against closed forms, against each other, and against what a mirror must show.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <vector>

#include <candela/scene/tangents.hpp>
#include "renderer/gpu/mirror_shares.hpp"
#include "tests/renderer/gloss.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("gloss") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;

double schlick(double facing, double grazing, double cosine) {
    return facing + (grazing - facing) * std::pow(1.0 - cosine, 5.0);
}

/// What a surface of these reflectances reflects, in the mirror direction alone, of light that is the same
/// from all sides: the integral over half vectors in polar coordinates, where the distribution of microfacets
/// is smooth if their tangent is taken in units of α.
double furnace(double cosine, double roughness, double facing, double grazing) {
    constexpr int steps = 400;
    const double alpha = roughness * roughness;
    const glm::dvec3 viewer(std::sqrt(1.0 - cosine * cosine), 0.0, cosine), normal(0, 0, 1);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        // With tan θ = α t and t² = u / (1 - u), the distribution times cos θ is even in u.
        const double u = (i + 0.5) / steps;
        const double tangent = alpha * std::sqrt(u / (1.0 - u));
        const double cos_half = 1.0 / std::sqrt(1.0 + tangent * tangent);
        for (int j = 0; j < steps; ++j) {
            const double angle = 2.0 * pi * (j + 0.5) / steps;
            const glm::dvec3 half(cos_half * tangent * std::cos(angle), cos_half * tangent * std::sin(angle),
                                  cos_half);
            const double to_half = glm::dot(viewer, half);
            const glm::dvec3 light = 2.0 * to_half * half - viewer;
            if (to_half <= 0.0 || light.z <= 0.0) continue;
            const double d =
                std::pow(alpha / (cos_half * cos_half * (alpha * alpha + tangent * tangent)), 2.0) / pi;
            const double brdf =
                facets_towards(light, viewer, normal, alpha) * schlick(facing, grazing, to_half);
            // dω of the light is 4 (v·h) dω of the half vector, whose density D cos θ is 1/steps².
            sum += brdf * light.z * 4.0 * to_half / (d * cos_half);
        }
    }
    return sum / (steps * steps);
}

/// Transform of a square that faces the origin from there.
Transform facing_origin(glm::vec3 from) {
    Transform pose = looking(from, {0, 0, 0}, {0, 0, 1});
    pose.rotation = pose.rotation * glm::angleAxis(-0.5F * std::numbers::pi_v<float>, glm::vec3(1, 0, 0));
    return pose;
}

/// Radiance towards `viewer` of a ground that reflects all light in the mirror direction, at the origin,
/// under a square of radiance 1 that faces it: the integral over the square.
double ground_under_square(const glm::dvec3& from, double half, const glm::dvec3& viewer, double alpha) {
    constexpr int steps = 64;
    const glm::dvec3 normal(0, 1, 0), front = -glm::normalize(from);
    const glm::dvec3 across = glm::normalize(glm::cross(front, glm::dvec3(0, 0, 1)));
    const glm::dvec3 along = glm::cross(front, across);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double x = half * (2.0 * (i + 0.5) / steps - 1.0);
            const double y = half * (2.0 * (j + 0.5) / steps - 1.0);
            const glm::dvec3 point = from + x * across + y * along;
            const glm::dvec3 light = glm::normalize(point);
            const double solid_angle = -glm::dot(front, light) / glm::dot(point, point);
            sum += facets_towards(light, viewer, normal, alpha) * light.y * solid_angle;
        }
    }
    return sum * 4.0 * half * half / (steps * steps);
}

glm::quat turned(float half_turns, glm::vec3 axis) {
    return glm::angleAxis(half_turns * std::numbers::pi_v<float>, axis);
}

/// Two coloured squares that stand on a ground, a point light, and a camera of which only the pose is
/// missing.
Scene things_on_ground() {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(4.0F, diffuse(glm::vec3(0.6F), true))});
    add(scene.world, Transform{.translation = {1, 0.4F, -0.5F}, .rotation = turned(0.5F, {0, 0, 1})},
        MeshInstance{square(0.4F, diffuse({0.7F, 0.3F, 0.1F}, true))});
    add(scene.world, Transform{.translation = {0.6F, 0.5F, 0.7F}, .rotation = turned(0.4F, {0, 0, 1})},
        MeshInstance{square(0.3F, diffuse({0.1F, 0.5F, 0.7F}, true))});
    scene.light = add(scene.world, at({0.2F, 2.5F, 0.4F}), PointLight{.intensity = 5.0F});
    scene.camera = add(scene.world, Camera{.vertical_fov = 0.5F});
    return scene;
}

/// A ground, seen in a mirror that is still missing: the camera looks at its place. `behind`: the camera is
/// where the mirror would show it.
Scene ground_for_mirror(std::shared_ptr<const Mesh> ground, const Transform& pose, bool behind) {
    Scene scene;
    add(scene.world, pose, MeshInstance{std::move(ground)});
    scene.light = add(scene.world, at({2.5F, 2.5F, 0.3F}), PointLight{.intensity = 5.0F});
    scene.camera = add(scene.world, looking({behind ? -2.3F : 0.3F, 1.6F, 0.1F}, {-1, 0.8F, 0}),
                       Camera{.vertical_fov = 0.5F});
    return scene;
}

/// A mirror that faces +X, at x = -1.
void add_mirror(Scene& scene) {
    add(scene.world, Transform{.translation = {-1, 1, 0}, .rotation = turned(-0.5F, {0, 0, 1})},
        MeshInstance{square(0.9F, metal(glm::vec3(1.0F), 0.0F))});
}

/// A ground of this material with tangents. `bent`: its normals turn from corner to corner.
std::shared_ptr<const Mesh> ground_of(Material material, bool bent, bool mirrored_uv) {
    Mesh mesh = *square(4.0F, std::make_shared<const Material>(std::move(material)));
    for (Vertex& vertex : mesh.primitives[0].vertices) {
        if (bent) vertex.normal = glm::normalize(vertex.position * 0.05F + glm::vec3(0, 1, 0));
        if (mirrored_uv) vertex.uv.x = 1.0F - vertex.uv.x;
    }
    derive_tangents(mesh.primitives[0]);
    return std::make_shared<const Mesh>(std::move(mesh));
}

/// Relative errors of a picture turned left to right, from the least to the greatest, where the right one has
/// at least this light.
std::vector<double> errors_in_mirror(const Picture& shown, const Picture& behind, double least) {
    std::vector<double> errors;
    for (std::uint32_t y = 0; y < behind.size.y; ++y) {
        for (std::uint32_t x = 0; x < behind.size.x; ++x) {
            const auto expected = static_cast<double>(behind.at(behind.size.x - 1 - x, y).g);
            if (expected < least) continue;
            errors.push_back(std::abs(static_cast<double>(shown.at(x, y).g) - expected) / expected);
        }
    }
    std::ranges::sort(errors);
    return errors;
}

}  // namespace

TEST_CASE("the table of mirror shares is the integral of the reflection") {
    // 1,024 samples an entry: their error is below 1 %.
    for (const float roughness : {0.05F, 0.2F, 0.4F, 0.6F, 0.8F, 1.0F}) {
        for (const float cosine : {0.1F, 0.3F, 0.6F, 1.0F}) {
            CAPTURE(roughness);
            CAPTURE(cosine);
            const glm::vec3 shares = mirror_shares(cosine, roughness);
            const auto c = static_cast<double>(cosine), r = static_cast<double>(roughness);
            CHECK(relative_error(static_cast<double>(shares.x + shares.y), furnace(c, r, 1.0, 1.0)) < 0.01);
            // Of all the light: where y is small, so is its part.
            CHECK(std::abs(static_cast<double>(shares.y) - furnace(c, r, 0.0, 1.0)) < 0.005);
        }
    }
}

TEST_CASE_FIXTURE(RenderFixture, "ground of metal or plastic under a light: the specification's formulas") {
    const glm::dvec3 viewer = glm::normalize(glm::dvec3(2, 2, 0)), normal(0, 1, 0);
    configure(linear_configuration());
    for (const float roughness : {0.1F, 0.3F, 0.6F, 1.0F}) {
        for (const glm::vec3 from :
             {glm::vec3(-2, 2.1F, 0.1F), glm::vec3(1, 3, -1), glm::vec3(-3, 0.6F, 0)}) {
            CAPTURE(roughness);
            CAPTURE(from.x);
            const auto expect = [&](const std::shared_ptr<const Material>& material, double facing,
                                    double grazing, double diffuse) {
                Scene scene = seen_ground(material);
                add(scene.world, at(from), PointLight{.intensity = 5.0F});
                const glm::dvec3 light = glm::normalize(glm::dvec3(from));
                const double irradiance = 5.0 / glm::dot(glm::dvec3(from), glm::dvec3(from)) * light.y;
                const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
                const double fresnel =
                    schlick(facing, grazing, glm::dot(viewer, glm::normalize(light + viewer)));
                const double expected = irradiance * (facets_towards(light, viewer, normal, alpha) * fresnel +
                                                      (1.0 - fresnel) * diffuse / pi);
                // The middle of the pixel is on the axis of the view up to rounding, which turns the half
                // vector by 1e-6: α is 1e-2 at least. Half floats of the material: 5e-4.
                CHECK(luminance_at_middle(render(scene, few)) == doctest::Approx(expected).epsilon(0.002));
            };
            expect(metal(glm::vec3(0.75F), roughness), 0.75, 1.0, 0.0);
            expect(plastic(glm::vec3(0.5F), roughness), 0.04, 1.0, 0.5);
        }
    }
}

TEST_CASE_FIXTURE(RenderFixture, "under the same sky everywhere, metal shows the closed form") {
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    for (const float roughness : {0.0F, 0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F, 0.8F, 1.0F}) {
        CAPTURE(roughness);
        Scene scene = seen_ground(metal(glm::vec3(0.6F), roughness));
        Environment sky;
        sky.radiance = glm::vec3(2.0F);
        add(scene.world, sky);
        const double expected =
            2.0 * furnace(std::sqrt(0.5), std::max(static_cast<double>(roughness), 0.01), 0.6, 1.0);
        // Rays, or the irradiance of patches of the sky, whose sum is right to 1 %.
        CHECK(relative_error(luminance_at_middle(render(scene, few)), expected) < 0.01);
    }
}

TEST_CASE_FIXTURE(RenderFixture, "rough metal under a small lamp shows the integral over the lamp") {
    const glm::dvec3 viewer = glm::normalize(glm::dvec3(2, 2, 0));
    constexpr float half = 0.1F;
    configure(linear_configuration());
    for (const float roughness : {0.2F, 0.4F, 0.55F}) {
        CAPTURE(roughness);
        // Where mirrors would show it, and aside.
        for (const glm::vec3 from : {glm::vec3(-1.5F, 1.5F, 0), glm::vec3(-1, 2, 0.4F)}) {
            CAPTURE(from.x);
            Scene scene = seen_ground(metal(glm::vec3(1.0F), roughness));
            add(scene.world, facing_origin(from), MeshInstance{square(half, emitter(glm::vec3(10.0F)))});
            const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
            const double expected =
                10.0 * ground_under_square(glm::dvec3(from), static_cast<double>(half), viewer, alpha);
            // 64 surfels of 0.025 m, 2.1 m away, for each of which α² grows by 1.1e-5: at a roughness of
            // 0.2, a hundredth of it.
            CHECK(relative_error(luminance_at_middle(render(scene, few)), expected) < 0.02);
        }
    }
}

TEST_CASE_FIXTURE(RenderFixture, "what hides a lamp hides it in rough metal, too") {
    const glm::vec3 from(-1.5F, 1.5F, 0);
    configure(linear_configuration());
    // A black square half-way to the lamp, so much aside; it is as large as the lamp.
    const auto shown_behind = [&](float aside, float radiance = 10.0F) {
        Scene scene = seen_ground(metal(glm::vec3(1.0F), 0.4F));
        add(scene.world, facing_origin(from), MeshInstance{square(0.1F, emitter(glm::vec3(radiance)))});
        Transform pose = facing_origin(0.5F * from);
        pose.translation.z += aside;
        add(scene.world, pose, MeshInstance{square(0.1F, diffuse(glm::vec3(0.0F), true))});
        return luminance_at_middle(render(scene, {48, 48}));
    };
    const double open = shown_behind(1.0F);
    REQUIRE(open > 0.0);
    CHECK(shown_behind(0.0F) < 0.001 * open);
    // Half floats end at 65,504, and at 6e-8.
    for (const float radiance : {1e6F, 1e-9F}) {
        const double scale = static_cast<double>(radiance) / 10.0;
        CHECK(shown_behind(1.0F, radiance) == doctest::Approx(scale * open).epsilon(0.001));
        CHECK(shown_behind(0.0F, radiance) < 0.001 * scale * open);
    }
    // Its edge is in the middle of the lamp. A quarter of 25 rays tell how much is hidden: 0.2.
    CHECK(std::abs(shown_behind(0.1F) / open - 0.5) < 0.3);
}

TEST_CASE_FIXTURE(PathFixture, "paths agree on glossy surfaces, also behind panes") {
    Scene scene = cornell_box();
    Material floor = *plastic(glm::vec3(0.5F), 0.2F);
    add(scene.world, at({0, 0.01F, 0}), MeshInstance{square(0.9F, std::make_shared<const Material>(floor))});
    add(scene.world,
        Transform{.translation = {-0.3F, 1.0F, 0.2F}, .rotation = glm::angleAxis(1.0F, glm::vec3(1, 0, 0))},
        MeshInstance{square(0.3F, metal({0.9F, 0.7F, 0.3F}, 0.5F))});
    Material pane = *plastic({0.4F, 0.6F, 0.9F}, 0.1F);
    pane.alpha_mode = AlphaMode::blend;
    pane.base_colour.a = 0.4F;
    pane.double_sided = true;
    add(scene.world,
        Transform{.translation = {0.3F, 0.8F, 0.5F}, .rotation = glm::angleAxis(1.3F, glm::vec3(1, 0, 0))},
        MeshInstance{square(0.3F, std::make_shared<const Material>(pane))});
    for (const Interleave interleave : {Interleave::one, Interleave::four}) {
        Configuration configuration = linear_configuration();
        configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
        configuration.interleave = interleave;
        check_paths(scene, {52, 36}, configuration);
    }
}

TEST_CASE_FIXTURE(RenderFixture, "a flat mirror shows what is seen from behind it") {
    // The camera and its image in the mirror, at x = -1, look at the same things; the picture is turned
    // left to right. Direct light, as surfels would be placed differently.
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    Scene scene = things_on_ground();
    const Entity mirror =
        add(scene.world, Transform{.translation = {-1, 1, 0}, .rotation = turned(-0.5F, {0, 0, 1})},
            MeshInstance{square(0.9F, metal(glm::vec3(1.0F), 0.0F))});
    scene.world.set(scene.camera, looking({0.3F, 1.0F, 0.1F}, {-1, 0.9F, 0}));
    const Picture shown = render(scene, {48, 48});
    scene.world.destroy(mirror);
    scene.world.set(scene.camera, looking({-2.3F, 1.0F, 0.1F}, {-1, 0.9F, 0}));
    const Picture behind = render(scene, {48, 48});
    REQUIRE(mean(behind) > 0.01);
    std::vector<double> errors;
    for (std::uint32_t y = 0; y < 48; ++y) {
        for (std::uint32_t x = 0; x < 48; ++x) {
            const auto expected = static_cast<double>(behind.at(47 - x, y).g);
            // Where nothing is seen, the light has the faint edge of its highlight.
            if (expected < 0.01) continue;
            errors.push_back(std::abs(static_cast<double>(shown.at(x, y).g) - expected) / (expected + 0.001));
        }
    }
    REQUIRE(errors.size() > 500);
    std::ranges::sort(errors);
    // The reflectance is 1 up to the table of shares, 1e-3, and a ray is off by 1e-5 of its length. At
    // edges, rays and triangles may find different surfaces.
    CHECK(errors[errors.size() * 3 / 4] < 0.005);
}

TEST_CASE_FIXTURE(RenderFixture, "a mirror shows highlights and bumps as they are seen from behind it") {
    // Nothing else is there that the ground could reflect: what it reflects of other surfaces is the same
    // mean in mirrors, but found by rays where it is seen itself.
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    const auto expect = [&](const std::shared_ptr<const Mesh>& ground, const Transform& pose = {}) {
        Scene seen_in_mirror = ground_for_mirror(ground, pose, false);
        add_mirror(seen_in_mirror);
        const Picture shown = render(seen_in_mirror, {48, 48});
        renderer.invalidate();
        const Picture behind = render(ground_for_mirror(ground, pose, true), {48, 48});
        renderer.invalidate();
        const double middle = mean(behind);
        REQUIRE(middle > 0.01);
        // The reflectance is 1 up to the table of shares, 1e-3; roughness is a half float, 5e-4, and
        // normals of the ray's triangle have 16 bits.
        const std::vector<double> all = errors_in_mirror(shown, behind, 0.1 * middle);
        REQUIRE(all.size() > 1000);
        CHECK(all[all.size() * 9 / 10] < 0.005);
        const std::vector<double> bright = errors_in_mirror(shown, behind, 1.5 * middle);
        REQUIRE(bright.size() > 20);
        CHECK(bright[bright.size() * 9 / 10] < 0.01);
    };
    const Transform mirrored{.scale = {-1, 1, 1}};
    for (const auto& made : {metal({0.9F, 0.8F, 0.7F}, 0.5F), plastic(glm::vec3(0.2F), 0.3F)}) {
        CAPTURE(made->roughness);
        Material material = *made;
        expect(ground_of(material, true, false));
        // Without bent normals, as rays do not interpolate the tangents of corners. One texel has no
        // bilinear weights, which drivers round.
        material.normal_texture = std::make_shared<const Image>(
            Image{.width = 1, .height = 1, .texels = {{140, 134, 250, 255}}, .encoding = Encoding::linear});
        material.normal_scale = 1.2F;
        expect(ground_of(material, false, false));
        expect(ground_of(material, false, true));
        expect(ground_of(material, false, false), mirrored);
    }
}

}  // TEST_SUITE("gloss")
