// What the values of Show show: closed forms, and relations between them, on all shading paths.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <string_view>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("views of light and surfaces") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{48, 36};
// As for the closed forms: sums of floats, and albedos in half floats, whose error is up to 2⁻¹¹.
constexpr double tolerance = 0.005;

Configuration showing(Show show, ShadingPath path) {
    Configuration configuration = linear_configuration(path);
    configuration.show = show;
    configuration.vpls.count = 32;
    configuration.shadows = {.cube_resolution = 64, .map_resolution = 64, .budget_mib = 16};
    return configuration;
}

/// The ground with a point light of 3 cd.
Scene lit_ground(glm::vec3 light) {
    Scene scene = ground();
    scene.world.set(scene.light, at(light));
    scene.world.set(scene.light, PointLight{.intensity = 3.0F});
    return scene;
}

class ShowTests : public PathFixture {
 protected:
    Picture picture(const Scene& scene, const Configuration& configuration) {
        configure(configuration);
        renderer.invalidate();  // the scenes of a loop have the same address
        return render(scene, size);
    }

    [[nodiscard]] bool has_pass(std::string_view name) const {
        return std::ranges::any_of(renderer.last_passes(),
                                   [&](const PassRecord& pass) { return pass.name == name; });
    }
};

std::shared_ptr<const Material> glossy(float roughness, float metalness) {
    Material material;
    material.roughness = roughness;
    material.metalness = metalness;
    return std::make_shared<const Material>(std::move(material));
}

/// The same, with these values in the channels of a texture, and factors of a half.
std::shared_ptr<const Material> glossy_texture(std::uint8_t green, std::uint8_t blue) {
    Image image{.width = 1, .height = 1, .texels = {{0, green, blue, 0}}, .encoding = Encoding::linear};
    Material material = *glossy(0.5F, 0.5F);
    material.metal_roughness_texture = std::make_shared<const Image>(std::move(image));
    return std::make_shared<const Material>(std::move(material));
}

/// The picture times a factor.
Picture scaled(Picture picture, float factor) {
    for (glm::vec3& pixel : picture.pixels) pixel *= factor;
    return picture;
}

/// IEC 61966-2-1.
double srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// The normal of the wall of a box around the origin that the ray meets from inside, away from edges of the
/// box; null at edges.
glm::dvec3 inward_normal(const PixelRay& ray, double half) {
    const glm::dvec3 far_wall = glm::sign(ray.direction) * half;
    const glm::dvec3 along = (far_wall - ray.origin) / ray.direction;
    std::array<double, 3> sorted{along.x, along.y, along.z};
    std::ranges::sort(sorted);
    if (sorted[1] - sorted[0] < 1e-3) return glm::dvec3(0.0);
    glm::dvec3 normal(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        if (along[axis] == sorted[0]) normal[axis] = -glm::sign(ray.direction[axis]);
    }
    return normal;
}

}  // namespace

TEST_CASE_FIXTURE(ShowTests, "direct and indirect light add up to the total, of lights, lamps and skies") {
    for (const char* const name : {"cornell", "lamp", "court"}) {
        const Scene scene = shipped_scene(name);
        renderer.invalidate();
        const auto shown = [&](Show show, ShadingPath path) {
            configure(showing(show, path));
            return render(scene, size);
        };
        for (const ShadingPath path : {ShadingPath::forward, ShadingPath::deferred}) {
            CAPTURE(name);
            CAPTURE(to_string(path));
            const Picture direct = shown(Show::direct, path);
            const Picture indirect = shown(Show::indirect, path);
            const Picture total = shown(Show::total, path);
            Picture sum = direct;
            for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += indirect.pixels[i];
            // Sums of a few hundred floats in another order.
            CHECK(worst_error(sum, total, 1e-3 * mean(total)) < 1e-4);
            CHECK(mean(direct) > mean(indirect));
            CHECK(mean(indirect) > 0.005);
        }
    }
}

TEST_CASE_FIXTURE(ShowTests, "irradiance of a plane under a point light is I cosθ / r², shown as E/π") {
    const glm::vec3 light(0.4F, 1.0F, -0.2F);
    const Scene scene = lit_ground(light);
    const Picture expected = expected_picture(scene, size, {}, {0, 1, 0}, [&](glm::dvec3 at) {
        const glm::dvec3 to_light = glm::dvec3(light) - at;
        const double r = glm::length(to_light);
        return glm::dvec3(3.0 * to_light.y / (r * r * r) / pi);
    });
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        Configuration configuration = showing(Show::irradiance, path);
        configuration.indirect = false;
        CHECK(worst_error(picture(scene, configuration), expected, 1e-6) < tolerance);
    }
}

TEST_CASE_FIXTURE(ShowTests, "direct irradiance is the total of the same scene in white") {
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        Configuration configuration = showing(Show::irradiance, path);
        configuration.indirect = false;
        const Picture irradiance = picture(furnace_box(0.3F), configuration);
        configuration.show = Show::total;
        const Picture white = picture(furnace_box(1.0F), configuration);
        CHECK(worst_error(irradiance, white, 1e-6) < tolerance);
        CHECK(mean(white) > 0.01);
    }
}

TEST_CASE_FIXTURE(ShowTests, "times the albedo, irradiance is the total, with VPLs however gathered") {
    const Scene scene = furnace_box(0.3F);
    for (const ShadingPath path : all_shading_paths) {
        for (const Interleave interleave : {Interleave::one, Interleave::four}) {
            for (const VplPlacement placement : {VplPlacement::paths, VplPlacement::surfels}) {
                CAPTURE(to_string(path));
                CAPTURE(to_string(interleave));
                CAPTURE(to_string(placement));
                Configuration configuration = showing(Show::irradiance, path);
                configuration.interleave = interleave;
                configuration.vpls.placement = placement;
                const Picture irradiance = picture(scene, configuration);
                configuration.show = Show::direct;
                const Picture direct = picture(scene, configuration);
                configuration.show = Show::total;
                const Picture total = picture(scene, configuration);
                CHECK(worst_error(scaled(irradiance, 0.3F), total, 1e-6) < tolerance);
                CHECK(mean(total) > 1.1 * mean(direct));
            }
        }
    }
}

TEST_CASE_FIXTURE(ShowTests, "irradiance includes the light of the sky, but not the view of it") {
    Scene scene = ground();
    scene.world.set(scene.camera, looking({0.0F, 1.0F, 3.0F}, {0.0F, 1.0F, 0.0F}));  // half sky
    add(scene.world, Environment{.radiance = glm::vec3(2.0F), .picture = nullptr});
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        const Picture irradiance = picture(scene, showing(Show::irradiance, path));
        const Picture total = picture(scene, showing(Show::total, path));
        // The sky fills the upper half of the picture; the albedo of the ground is 0.5.
        CHECK(irradiance.at(24, 35) == glm::vec3(0.0F));
        CHECK(total.at(24, 35).r == doctest::Approx(2.0));
        CHECK(irradiance.at(24, 2).r > 0.0F);
        CHECK(0.5F * irradiance.at(24, 2).r == doctest::Approx(total.at(24, 2).r).epsilon(tolerance));
    }
}

TEST_CASE_FIXTURE(ShowTests, "irradiance includes the light of emitters, but not what is seen of them") {
    Scene scene = furnace_box(0.5F);
    scene.world.remove<PointLight>(scene.light);
    // In the middle of the picture, facing the camera; nothing else lights it but the box's walls.
    scene.world.set(scene.camera, at({0.0F, 0.0F, 0.9F}));
    add(scene.world, looking({0.0F, 0.0F, -0.5F}, {0.0F, -1.0F, -0.5F}, {0.0F, 0.0F, 1.0F}),
        MeshInstance{square(0.2F, emitter(glm::vec3(50.0F)))});
    renderer.invalidate();
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        // The light of surfels is kept: placing those of emitters anew for each picture would take
        // seconds.
        configure(showing(Show::irradiance, path));
        const Picture irradiance = render(scene, size);
        configure(showing(Show::total, path));
        const Picture total = render(scene, size);
        CHECK(total.at(24, 18).r == doctest::Approx(50.0));  // black, apart from what it emits
        CHECK(irradiance.at(24, 18).r > 0.0F);
        CHECK(irradiance.at(24, 18).r < 25.0F);
        CHECK(0.5F * irradiance.at(2, 2).r == doctest::Approx(total.at(2, 2).r).epsilon(tolerance));
    }
}

TEST_CASE_FIXTURE(ShowTests, "albedo is the base colour, without light, exposure and tone curve") {
    const glm::vec3 left(0.8F, 0.25F, 0.0F);
    const glm::vec3 right(0.002F, 0.5F, 1.0F);
    Scene scene = ground();
    scene.world.set(scene.camera, looking({0.0F, 3.0F, 0.0F}, {0, 0, 0}, {0.0F, 0.0F, -1.0F}));
    add(scene.world, at({-0.6F, 0.5F, 0.0F}), MeshInstance{square(0.5F, diffuse(left))});
    add(scene.world, at({0.6F, 0.5F, 0.0F}), MeshInstance{square(0.5F, diffuse(right))});
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        Configuration configuration = showing(Show::albedo, path);
        configuration.tone_map.exposure_ev = 3.0F;
        const Picture linear = picture(scene, configuration);
        configuration.tone_map.enabled = true;
        const Picture encoded = picture(scene, configuration);
        for (int channel = 0; channel < 3; ++channel) {
            for (const auto& [x, albedo] : {std::pair(16U, left), std::pair(32U, right)}) {
                const double expected = static_cast<double>(albedo[channel]);
                CHECK(linear.at(x, 18)[channel] == doctest::Approx(expected).epsilon(tolerance));
                CHECK(encoded.at(x, 18)[channel] == doctest::Approx(srgb(expected)).epsilon(tolerance));
            }
        }
    }
}

TEST_CASE_FIXTURE(ShowTests, "normals of an axis-aligned box, and black where there is no surface") {
    Scene scene;
    constexpr float half = 1.0F;
    add(scene.world, Transform{}, MeshInstance{box_inwards(half, diffuse(glm::vec3(0.5F)))});
    const Transform pose = looking({0.3F, 0.2F, 0.6F}, {-0.4F, -0.5F, -0.7F});
    const Camera camera{.vertical_fov = 1.5F, .near_plane = 0.05F};
    scene.camera = add(scene.world, pose, camera);
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        for (const bool tone_map : {false, true}) {
            Configuration configuration = showing(Show::normals, path);
            configuration.tone_map = {.enabled = tone_map, .exposure_ev = -2.0F};
            const Picture normals = picture(scene, configuration);
            int compared = 0;
            double worst = 0.0;
            for (std::uint32_t y = 0; y < size.y; ++y) {
                for (std::uint32_t x = 0; x < size.x; ++x) {
                    const glm::dvec3 normal =
                        inward_normal(pixel_ray(camera, pose, size, x, y), static_cast<double>(half));
                    if (normal == glm::dvec3(0.0)) continue;
                    ++compared;
                    const glm::dvec3 error = glm::dvec3(normals.at(x, y)) - (0.5 * normal + 0.5);
                    worst = std::max(worst, glm::length(error));
                }
            }
            CHECK(compared > 1500);  // of 1728: all but those at edges
            CHECK(worst < 1e-5);     // floats
        }
    }
    scene.world.set(scene.camera, looking({0.0F, 0.0F, 5.0F}, {0.0F, 0.0F, 10.0F}));
    CHECK(mean(picture(scene, showing(Show::normals, ShadingPath::deferred))) == 0.0);
}

TEST_CASE_FIXTURE(ShowTests, "roughness and metalness of materials, as they are") {
    Scene scene = ground();
    scene.world.set(scene.camera, looking({0.0F, 3.0F, 0.0F}, {0, 0, 0}, {0.0F, 0.0F, -1.0F}));
    add(scene.world, at({-0.6F, 0.5F, 0.0F}), MeshInstance{square(0.5F, glossy(0.3F, 0.75F))});
    add(scene.world, at({0.6F, 0.5F, 0.0F}), MeshInstance{square(0.5F, glossy_texture(51, 204))});
    for (const ShadingPath path : all_shading_paths) {
        for (const bool tone_map : {false, true}) {
            CAPTURE(to_string(path));
            CAPTURE(tone_map);
            Configuration configuration = showing(Show::roughness, path);
            configuration.tone_map = {.enabled = tone_map, .exposure_ev = 2.0F};
            const Picture roughness = picture(scene, configuration);
            configuration.show = Show::metalness;
            const Picture metalness = picture(scene, configuration);
            const auto check_at = [&](std::uint32_t x, float rough, float metal) {
                // Half floats: 2⁻¹¹.
                CHECK(glm::distance(roughness.at(x, 18), glm::vec3(rough)) < 1e-3F);
                CHECK(glm::distance(metalness.at(x, 18), glm::vec3(metal)) < 1e-3F);
            };
            check_at(16, 0.3F, 0.75F);
            check_at(24, 1.0F, 0.0F);  // the Lambertian ground
            check_at(32, 0.5F * 51.0F / 255.0F, 0.5F * 204.0F / 255.0F);
        }
    }
}

TEST_CASE_FIXTURE(ShowTests, "without glossy surfaces all is rough, and nothing is metal") {
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        CHECK(mean(picture(ground(), showing(Show::roughness, path))) == 1.0);
        CHECK(mean(picture(ground(), showing(Show::metalness, path))) == 0.0);
    }
}

TEST_CASE_FIXTURE(ShowTests, "a double-sided surface has the normal of the side that is seen") {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(9.0F, diffuse(glm::vec3(0.5F), true))});
    for (const float height : {1.0F, -1.0F}) {
        scene.camera =
            add(scene.world, looking({0.0F, height, 0.0F}, {0, 0, 0}, {0.0F, 0.0F, -1.0F}), Camera{});
        for (const ShadingPath path : all_shading_paths) {
            CAPTURE(to_string(path));
            const glm::vec3 normal = picture(scene, showing(Show::normals, path)).at(24, 18);
            CHECK(glm::distance(normal, glm::vec3(0.5F, 0.5F + 0.5F * height, 0.5F)) < 1e-5F);
        }
    }
}

TEST_CASE_FIXTURE(ShowTests, "blended surfaces are mixed with what is behind them") {
    Material pane = *glossy(0.2F, 0.5F);
    pane.base_colour = {0.9F, 0.1F, 0.5F, 0.25F};
    pane.alpha_mode = AlphaMode::blend;
    Scene scene = lit_ground({0.4F, 1.0F, -0.2F});
    scene.world.set(scene.camera, looking({0.0F, 3.0F, 0.0F}, {0, 0, 0}, {0.0F, 0.0F, -1.0F}));
    add(scene.world, at({0.0F, 0.5F, 0.0F}),
        MeshInstance{square(0.5F, std::make_shared<const Material>(std::move(pane)))});
    // Over the ground's albedo of 0.5.
    const glm::vec3 expected = 0.25F * glm::vec3(0.9F, 0.1F, 0.5F) + 0.75F * glm::vec3(0.5F);
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        const glm::vec3 albedo = picture(scene, showing(Show::albedo, path)).at(24, 18);
        CHECK(glm::distance(albedo, expected) < 1e-3F);  // half floats
        // Both face upwards.
        const glm::vec3 normal = picture(scene, showing(Show::normals, path)).at(24, 18);
        CHECK(glm::distance(normal, glm::vec3(0.5F, 1.0F, 0.5F)) < 1e-5F);
        // Over the ground's roughness of 1.
        const glm::vec3 roughness = picture(scene, showing(Show::roughness, path)).at(24, 18);
        CHECK(glm::distance(roughness, glm::vec3(0.25F * 0.2F + 0.75F)) < 1e-3F);
        const glm::vec3 metalness = picture(scene, showing(Show::metalness, path)).at(24, 18);
        CHECK(glm::distance(metalness, glm::vec3(0.25F * 0.5F)) < 1e-3F);
    }
}

TEST_CASE_FIXTURE(ShowTests, "what surfaces are needs neither shadow maps, VPLs, light lists nor rays") {
    Scene scene = cornell_box();
    add(scene.world, at({0, 0.01F, 0}), MeshInstance{square(0.9F, glossy(0.1F, 1.0F))});
    add(scene.world, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
    add(scene.world, looking({0, 5, 0}, {0, 0, 0}, {0, 0, -1}), DirectionalLight{});
    for (const ShadingPath path : all_shading_paths) {
        for (const Show show : {Show::albedo, Show::normals, Show::roughness, Show::metalness}) {
            CAPTURE(to_string(path));
            CAPTURE(to_string(show));
            CHECK(mean(picture(scene, showing(show, path))) > 0.05);
            for (const std::string_view pass :
                 {"shadow-maps", "light-upload", "surfels", "surfel-light", "vpl-gather", "light-tiles",
                  "light-clusters", "mirror-rays", "mirror-resolve", "emission", "background"}) {
                CAPTURE(pass);
                CHECK_FALSE(has_pass(pass));
            }
            const Report report = renderer.report();
            CHECK(report.lights.count == 2);
            CHECK(report.lights.shadow_views == 0);
            CHECK_FALSE(report.vpls);
        }
    }
}

TEST_CASE_FIXTURE(ShowTests, "refinement averages whatever is shown") {
    const Scene scene = cornell_box();
    for (const Show show : {Show::irradiance, Show::albedo, Show::normals}) {
        CAPTURE(to_string(show));
        Configuration configuration = showing(show, ShadingPath::deferred);
        const Picture first = picture(scene, configuration);
        configuration.refinement = {.enabled = true, .frames = 4};
        Picture refined = picture(scene, configuration);
        CHECK(worst_error(refined, first, 1e-6) < 1e-4);  // sums in another order
        for (int frame = 1; frame < 4; ++frame) refined = render(scene, size);
        CHECK(renderer.report().refined == 4);
        CHECK(is_sane(refined));
        CHECK(worst_error(refined, first, 1e-6) > 0.01);  // edges are smoothed
        // The samples of a pixel are symmetric around its centre, so edges move by less than a pixel.
        CHECK(mean(refined) == doctest::Approx(mean(first)).epsilon(0.02));
    }
}

}  // TEST_SUITE("views of light and surfaces")
