// Normal and occlusion textures against closed forms, and against surfaces without them.

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 few{9, 9};

std::shared_ptr<const Image> texel(glm::u8vec3 value) {
    return std::make_shared<const Image>(
        Image{.width = 1, .height = 1, .texels = {glm::u8vec4(value, 255)}, .encoding = Encoding::linear});
}

/// The normal that a texel stores: glTF 2.0, section 3.9.3.
glm::dvec3 normal_of(glm::u8vec3 value, double scale = 1.0) {
    return glm::normalize((glm::dvec3(value) / 255.0 * 2.0 - 1.0) * glm::dvec3(scale, scale, 1.0));
}

/// A square as `square`, with tangents: u grows along x, or along -x if it is mirrored.
std::shared_ptr<const Mesh> square_with_tangents(float half, std::shared_ptr<const Material> material,
                                                 bool mirrored = false) {
    Mesh mesh = *square(half, std::move(material));
    for (Vertex& vertex : mesh.primitives[0].vertices) {
        const int sign = mirrored ? -32767 : 32767;
        vertex.tangent = glm::i16vec4(sign, 0, 0, sign);
        if (mirrored) vertex.uv.x = 1.0F - vertex.uv.x;
    }
    return std::make_shared<const Mesh>(std::move(mesh));
}

std::shared_ptr<const Material> bumpy(glm::vec3 albedo, glm::u8vec3 normal, float scale = 1.0F) {
    Material material = *diffuse(albedo, true);
    material.normal_texture = texel(normal);
    material.normal_scale = scale;
    return std::make_shared<const Material>(std::move(material));
}

std::shared_ptr<const Material> occluded(glm::vec3 albedo, std::uint8_t open, float strength) {
    Material material = *diffuse(albedo);
    material.occlusion_texture = texel({open, 0, 0});
    material.occlusion_strength = strength;
    return std::make_shared<const Material>(std::move(material));
}

/// The ground, seen from 2 m above at 45°, with a tiny view.
Scene seen(std::shared_ptr<const Mesh> ground, const Transform& pose = {}) {
    Scene scene;
    add(scene.world, pose, MeshInstance{std::move(ground)});
    scene.camera = add(scene.world, looking({2, 2, 0}, {0, 0, 0}), Camera{.vertical_fov = 0.02F});
    return scene;
}

Environment sky_of(float radiance) {
    Environment sky;
    sky.radiance = glm::vec3(radiance);
    return sky;
}

double at_middle(const Picture& picture) {
    return static_cast<double>(picture.at(picture.size.x / 2, picture.size.y / 2).g);
}

}  // namespace

TEST_SUITE("bumps") {
    TEST_CASE_FIXTURE(RenderFixture, "a point light on a ground with one tilted normal: Lambert's law") {
        const glm::u8vec3 stored(190, 150, 220);
        const glm::vec3 from(-1.0F, 2.0F, 0.7F);
        configure(direct_only());
        const auto expect = [&](std::shared_ptr<const Mesh> mesh, const Transform& pose, glm::dvec3 normal) {
            Scene scene = seen(std::move(mesh), pose);
            add(scene.world, at(from), PointLight{.intensity = 5.0F});
            const glm::dvec3 light = glm::normalize(glm::dvec3(from));
            const double irradiance =
                5.0 / glm::dot(glm::dvec3(from), glm::dvec3(from)) * glm::dot(normal, light);
            // The albedo is rounded to a half float: 5e-4.
            CHECK(at_middle(render(scene, few)) == doctest::Approx(0.5 / pi * irradiance).epsilon(0.001));
        };
        for (const float scale : {1.0F, 0.4F, 2.0F}) {
            CAPTURE(scale);
            const glm::dvec3 n = normal_of(stored, static_cast<double>(scale));
            const auto material = bumpy(glm::vec3(0.5F), stored, scale);
            // Green points to decreasing v, which is -z here.
            expect(square_with_tangents(1.0F, material), Transform{}, {n.x, n.z, -n.y});
            expect(square_with_tangents(1.0F, material, true), Transform{}, {-n.x, n.z, -n.y});
            // The instance is mirrored: so is the image on it.
            expect(square_with_tangents(1.0F, material), Transform{.scale = {-1, 1, 1}}, {-n.x, n.z, -n.y});
            // Seen from below, the whole frame of the tangent is turned round.
            expect(square_with_tangents(1.0F, material), Transform{.scale = {1, -1, 1}}, {-n.x, n.z, n.y});
        }
    }

    TEST_CASE_FIXTURE(RenderFixture, "a light below the ground does not shine on normals that face it") {
        configure(direct_only());
        Scene scene = seen(square_with_tangents(1.0F, bumpy(glm::vec3(0.5F), {10, 127, 160})));
        add(scene.world, at({-2.0F, -0.1F, 0.0F}), PointLight{.intensity = 5.0F, .casts_shadow = false});
        CHECK(at_middle(render(scene, few)) == 0.0);
    }

    TEST_CASE_FIXTURE(RenderFixture, "a tilted normal under a sky that is the same everywhere") {
        // The ground hides the lower half. Light from the hemisphere around n on a surface of normal m: the
        // share (1 + n·m)/2 of what n receives.
        for (const Interleave interleave : {Interleave::one, Interleave::four}) {
            CAPTURE(to_string(interleave));
            Configuration configuration = linear_configuration();
            configuration.interleave = interleave;
            configure(configuration);
            for (const glm::u8vec3 stored : {glm::u8vec3(200, 128, 210), glm::u8vec3(128, 230, 190)}) {
                Scene scene = seen(square_with_tangents(4.0F, bumpy(glm::vec3(0.5F), stored)));
                add(scene.world, sky_of(2.0F));
                const double tilted = 0.5 + 0.5 * normal_of(stored).z;
                REQUIRE(tilted < 0.92);
                // Patches of the sky near the horizon count as if they were 3° above it: LEAST_FACING. Their
                // sum is right to 1 %.
                CHECK(at_middle(render(scene, few)) == doctest::Approx(0.5 * 2.0 * tilted).epsilon(0.02));
            }
        }
    }

    TEST_CASE_FIXTURE(RenderFixture, "a tilted normal under a small lamp: the cosine") {
        configure(linear_configuration());
        const glm::u8vec3 stored(180, 128, 220);
        const glm::vec3 from(2.0F, 3.0F, 0.0F);
        const auto lit = [&](std::shared_ptr<const Mesh> ground) {
            Scene scene = seen(std::move(ground));
            Transform pose = looking(from, {0, 0, 0}, {0, 0, 1});
            pose.rotation =
                pose.rotation * glm::angleAxis(-0.5F * std::numbers::pi_v<float>, glm::vec3(1, 0, 0));
            add(scene.world, pose, MeshInstance{square(0.1F, emitter(glm::vec3(100.0F)))});
            return at_middle(render(scene, few));
        };
        const double flat = lit(square(1.0F, diffuse(glm::vec3(0.5F))));
        const double turned = lit(square_with_tangents(1.0F, bumpy(glm::vec3(0.5F), stored)));
        REQUIRE(flat > 0.0);
        const glm::dvec3 n = normal_of(stored), light = glm::normalize(glm::dvec3(from));
        const double expected = (n.x * light.x + n.z * light.y - n.y * light.z) / light.y;
        // The lamp is 0.2 m wide, 3.6 m away: directions differ by up to 0.03, and even out over its surfels.
        CHECK(turned / flat == doctest::Approx(expected).epsilon(0.01));
    }

    TEST_CASE_FIXTURE(RenderFixture,
                      "occlusion takes away light of the sky, and none of a lamp without extent") {
        const auto with = [&](std::shared_ptr<const Material> material, bool sky) {
            Scene scene = seen(square(4.0F, std::move(material)));
            if (sky) {
                add(scene.world, sky_of(2.0F));
            } else {
                add(scene.world, at({0, 3, 0}), PointLight{.intensity = 5.0F});
            }
            return at_middle(render(scene, few));
        };
        configure(linear_configuration());
        const auto open = diffuse(glm::vec3(0.5F));
        for (const float strength : {1.0F, 0.5F}) {
            const auto material = occluded(glm::vec3(0.5F), 51, strength);
            const double share = 1.0 - static_cast<double>(strength) * 0.8;
            CHECK(with(material, true) == doctest::Approx(share * with(open, true)).epsilon(1e-5));
            CHECK(with(material, false) == doctest::Approx(with(open, false)).epsilon(1e-6));
        }
    }

    TEST_CASE_FIXTURE(RenderFixture,
                      "surfaces without normal textures look the same beside one that has one") {
        configure(linear_configuration());
        // Outside the room, where it is not seen and reflects no light.
        const auto with = [&](const std::shared_ptr<const Material>& material) {
            Scene scene = cornell_box();
            add(scene.world, at({0, -3, 0}), MeshInstance{square_with_tangents(0.1F, material)});
            return render(scene, {32, 32});
        };
        const Picture plain = with(diffuse(glm::vec3(0.0F), true));
        CHECK(mean(plain) > 0.0);
        CHECK(with(bumpy(glm::vec3(0.0F), {200, 128, 200})) == plain);
    }

    TEST_CASE_FIXTURE(PathFixture, "paths agree on bumpy surfaces, also glossy ones, and panes") {
        Scene scene = cornell_box();
        Material rough = *bumpy(glm::vec3(0.5F), {180, 140, 220});
        rough.occlusion_texture = texel({100, 0, 0});
        const auto floor = std::make_shared<const Material>(rough);
        add(scene.world, at({0, 0.01F, 0}), MeshInstance{square_with_tangents(0.9F, floor)});
        Material pane = rough;
        pane.alpha_mode = AlphaMode::blend;
        pane.base_colour.a = 0.4F;
        const Transform pose{.translation = {0.3F, 0.8F, 0.5F},
                             .rotation = glm::angleAxis(1.3F, glm::vec3(1, 0, 0))};
        add(scene.world, pose,
            MeshInstance{square_with_tangents(0.3F, std::make_shared<const Material>(pane))});
        for (const bool glossy : {false, true}) {
            CAPTURE(glossy);
            if (glossy) {
                rough.specular = 1.0F;
                rough.roughness = 0.3F;
                add(scene.world, at({0.2F, 0.02F, 0.3F}),
                    MeshInstance{square_with_tangents(0.4F, std::make_shared<const Material>(rough))});
            }
            for (const Interleave interleave : {Interleave::one, Interleave::four}) {
                Configuration configuration = linear_configuration();
                configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
                configuration.interleave = interleave;
                check_paths(scene, {52, 36}, configuration);
            }
        }
    }
}
