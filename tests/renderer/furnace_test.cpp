#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("furnace") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{32, 32};
constexpr float infinity = std::numeric_limits<float>::infinity();

/// A light of 3 cd at the centre of a sphere of radius 2 m, and a camera inside, off the centre.
///
/// With 20,480 facets, the error of the facets is small: their corners are at most 2.2° apart, so their
/// centres are nearer to the light by 1 - cos 1.3° = 0.03 % and up to 0.06 % brighter. What remains is the
/// error of VPLs on neighbouring facets, whose true normals differ from the pixel's by as much as their
/// distance: a share of the flux that falls with the number of VPLs.
Scene furnace_sphere(float albedo) {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{sphere_inwards(2.0F, 5, diffuse(glm::vec3(albedo)))});
    scene.light = add(scene.world, Transform{}, PointLight{.intensity = 3.0F});
    scene.camera = add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
    return scene;
}

/// With this many bounces, the light left after them is far below the tolerances: ρ⁶⁴ = 6·10⁻⁷ for ρ = 0.8.
Configuration furnace_configuration(std::uint32_t vpls) {
    Configuration configuration = linear_configuration();
    configuration.vpls.placement = VplPlacement::paths;
    configuration.vpls.count = vpls;
    configuration.vpls.bounces = 64;
    return configuration;
}

class Furnace : public RenderFixture {
 protected:
    /// The worst pixel of the sphere's picture, compared with radiance ρ/π · I/R² · 1/(1 - ρ).
    double sphere_error(const Scene& scene, double albedo, std::uint32_t vpls, float bound) {
        Configuration configuration = furnace_configuration(vpls);
        configuration.geometry_bound = bound;
        configure(configuration);
        const double radiance = albedo / pi * 3.0 / 4.0 / (1.0 - albedo);
        const Picture expected{size, std::vector(size.x * size.y, glm::vec3(static_cast<float>(radiance)))};
        return worst_error(render(scene, size), expected, 1e-6);
    }

    /// The flux that arrives at the six walls of `furnace_box`, of the light that the configuration shows.
    double arriving(Scene& scene, double albedo) {
        const double pixel_area = 4.0 / (size.x * size.y);
        double flux = 0.0;
        for (const glm::vec3 wall : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),
                                     glm::vec3(0, -1, 0), glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
            const glm::vec3 up(0, wall.y == 0.0F, wall.y != 0.0F);
            scene.world.set(scene.camera, looking({0, 0, 0}, wall, up));
            flux += mean(render(scene, size)) * pi / albedo * size.x * size.y * pixel_area;
        }
        return flux;
    }
};

}  // namespace

TEST_CASE_FIXTURE(Furnace, "a sphere lit from its centre is equally bright everywhere") {
    for (const double albedo : {0.5, 0.8}) {
        CAPTURE(albedo);
        const Scene scene = furnace_sphere(static_cast<float>(albedo));
        renderer.invalidate();
        // From any point of the sphere, every VPL has the same geometry term: VPLs that are points have
        // only the noise of facets and of where paths end. Bounded ones lose the light of nearby
        // surfaces, less with more VPLs.
        const double points = sphere_error(scene, albedo, 1024, infinity);
        const double few = sphere_error(scene, albedo, 128, 1.0F);
        const double many = sphere_error(scene, albedo, 1024, 1.0F);
        const double more = sphere_error(scene, albedo, 4096, 1.0F);
        CHECK(points < 0.02);
        CHECK(many < few);
        CHECK(more < many);
        CHECK(more < 0.02);
    }
}

TEST_CASE_FIXTURE(Furnace, "the walls of a closed box receive the emitted flux times 1 / (1 - albedo)") {
    for (const double albedo : {0.5, 0.8}) {
        CAPTURE(albedo);
        Scene scene = furnace_box(static_cast<float>(albedo));
        scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                             .half_height = 1.0F,
                                             .near_plane = 0.0F,
                                             .far_plane = 4.0F});
        renderer.invalidate();
        Configuration configuration = furnace_configuration(1024);
        configuration.show = Show::direct;
        configure(configuration);
        const double direct = arriving(scene, albedo);
        // A light of 1 cd emits 4π lm. Sums over pixels integrate its smooth irradiance to 0.1 %.
        CHECK(std::abs(direct / (4.0 * pi) - 1.0) < 1e-3);
        const auto error = [&](std::uint32_t vpls, float bound) {
            configuration = furnace_configuration(vpls);
            configuration.geometry_bound = bound;
            configuration.show = Show::indirect;
            configure(configuration);
            return arriving(scene, albedo) / direct / (albedo / (1.0 - albedo)) - 1.0;
        };
        // VPLs that are points lose nothing. Bounded ones lose in proportion to their R, which is
        // proportional to 1/√N: half as much with four times as many VPLs, within the noise.
        const double points = error(1024, infinity);
        const double few = error(1024, 1.0F);
        const double many = error(4096, 1.0F);
        const double most = error(16384, 1.0F);
        CHECK(std::abs(points) < 0.03);
        CHECK(std::abs(many / few - 0.5) < 0.1);
        CHECK(std::abs(most / many - 0.5) < 0.1);
        CHECK(std::abs(most) < 0.03);
    }
}

}  // TEST_SUITE("furnace")
