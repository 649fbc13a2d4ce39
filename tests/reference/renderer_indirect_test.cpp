#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include <glm/geometric.hpp>

#include "tests/reference/pictures.hpp"
#include "tests/study/measures.hpp"

TEST_SUITE("reference: the renderer's indirect light") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{32, 32};
constexpr std::array<std::uint32_t, 4> vpl_counts{64, 256, 1024, 4096};
constexpr std::uint32_t seeds = 8;

/// Two squares of 2 m × 2 m that face each other, 1 m apart, and a light between them. What a VPL lights is
/// at least 1 m away, as its own plate is in its plane.
Scene facing_plates() {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(1.0F, diffuse({0.8F, 0.6F, 0.4F}))});
    const glm::quat upside_down = glm::angleAxis(3.14159265F, glm::vec3(1, 0, 0));
    add(scene.world, Transform{.translation = {0, 1, 0}, .rotation = upside_down},
        MeshInstance{square(1.0F, diffuse({0.5F, 0.6F, 0.7F}))});
    scene.light = add(scene.world, at({0.3F, 0.6F, -0.2F}), PointLight{});
    scene.camera =
        add(scene.world, looking({0, 0.9F, 0}, {0, 0, 0}, {0, 0, -1}), Camera{.vertical_fov = 1.4F});
    return scene;
}

/// A sphere of radius 2 m around its light, with the camera off the centre. The geometry term between any two
/// points of the sphere is the same, 1 / (4 R²), however near they are.
Scene furnace_sphere() {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{sphere_inwards(2.0F, 5, diffuse(glm::vec3(0.6F)))});
    scene.light = add(scene.world, Transform{}, PointLight{.intensity = 3.0F});
    scene.camera = add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
    return scene;
}

/// A room of 4 m × 2.5 m × 3 m as a scanner sees it: triangles of 7 cm without normals, whose corners are off
/// by normally distributed errors along each axis, of this standard deviation in metres. Lit by a lamp of 10
/// cd.
Scene scanned_room(float noise) {
    constexpr float step = 0.07F;
    const glm::vec3 lower(-2.0F, 0.0F, -1.5F), extent(4.0F, 2.5F, 3.0F);
    const glm::ivec3 steps = glm::round(extent / step);
    std::mt19937 engine(1);
    std::normal_distribution<float> error(0.0F, noise);
    std::map<std::array<int, 3>, glm::vec3> corners;
    const auto corner = [&](glm::ivec3 at) {
        const auto [found, is_new] = corners.try_emplace({at.x, at.y, at.z});
        if (is_new) {
            found->second = lower + extent * glm::vec3(at) / glm::vec3(steps) +
                            glm::vec3(error(engine), error(engine), error(engine));
        }
        return found->second;
    };
    Primitive primitive{.vertices = {}, .indices = {}, .material = diffuse(glm::vec3(0.7F))};
    const auto add_triangle = [&](const std::array<glm::vec3, 3>& at) {
        const glm::vec3 normal = glm::normalize(glm::cross(at[1] - at[0], at[2] - at[0]));
        for (const glm::vec3& position : at) {
            primitive.indices.push_back(static_cast<std::uint32_t>(primitive.vertices.size()));
            primitive.vertices.push_back({position, normal, {}});
        }
    };
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const int side : {0, steps[axis]}) {
            for (int i = 0; i < steps[u] * steps[v]; ++i) {
                glm::ivec3 at(0), along_u(0), along_v(0);
                at[axis] = side;
                at[u] = i % steps[u];
                at[v] = i / steps[u];
                along_u[side == 0 ? u : v] = 1;
                along_v[side == 0 ? v : u] = 1;
                const glm::vec3 a = corner(at), b = corner(at + along_u), c = corner(at + along_u + along_v),
                                d = corner(at + along_v);
                add_triangle({a, b, c});
                add_triangle({a, c, d});
            }
        }
    }
    Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});
    scene.light = add(scene.world, at({0.3F, 1.9F, 0.2F}), PointLight{.intensity = 10.0F});
    scene.camera =
        add(scene.world, looking({1.7F, 1.3F, 1.3F}, {0.0F, 1.2F, 0.0F}), Camera{.vertical_fov = 1.3F});
    return scene;
}

/// The slope of the least-squares line through the logarithms.
template <std::size_t N>
double log_slope(const std::array<std::uint32_t, N>& x, const std::array<double, N>& y) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < N; ++i) {
        const double u = std::log(x[i]);
        const double v = std::log(y[i]);
        sx += u;
        sy += v;
        sxx += u * u;
        sxy += u * v;
    }
    return (N * sxy - sx * sy) / (N * sxx - sx * sx);
}

class RendererIndirect : public RenderFixture {
 protected:
    double rel_mse(const Scene& scene, const reference::Estimate& truth, const VplSettings& vpls,
                   float bound) {
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.vpls = vpls;
        configuration.geometry_bound = bound;
        configure(configuration);
        return study::measure(reference::flipped(render(scene, size)), truth.indirect, truth.hit).rel_mse;
    }

    /// The relMSE, averaged over seeds, must fall at least as 1 / N^0.9, whether VPLs are points or represent
    /// discs that shrink as their number grows. Renderer and reference use the same number of bounces.
    void check_convergence(const Scene& scene, std::uint32_t bounces, std::uint32_t samples) {
        CAPTURE(bounces);
        const reference::Estimate truth = trace(reference::Scene(scene.world), scene.camera,
                                                {.size = size, .samples = samples, .bounces = bounces});
        const double noise = study::measure(truth.halves[0], truth.halves[1], truth.hit).rel_mse / 4.0;
        renderer.invalidate();
        for (const float bound : {std::numeric_limits<float>::infinity(), 1.0F}) {
            CAPTURE(bound);
            std::array<double, vpl_counts.size()> errors{};
            for (std::size_t i = 0; i < errors.size(); ++i) {
                for (std::uint32_t seed = 0; seed < seeds; ++seed) {
                    errors[i] +=
                        rel_mse(scene, truth, {VplPlacement::paths, vpl_counts[i], bounces, seed}, bound) /
                        seeds;
                }
                MESSAGE(vpl_counts[i], " VPLs: relMSE ", errors[i], ", of which the reference's noise ",
                        noise);
            }
            // The reference's noise is part of each error, which can only make the slope less steep.
            CHECK(noise < 0.5 * errors.back());
            // An error of 1e-6 is what is left where drivers round corners to 1/256 of a pixel.
            CHECK((log_slope(vpl_counts, errors) <= -0.9 || errors.back() < 1e-6));
            MESSAGE("slope ", log_slope(vpl_counts, errors));
        }
    }
};

}  // namespace

TEST_CASE_FIXTURE(RendererIndirect, "between two facing plates it converges to the reference") {
    check_convergence(facing_plates(), 1, 4096);
    check_convergence(facing_plates(), 2, 4096);
}

TEST_CASE_FIXTURE(RendererIndirect, "in a sphere lit from its centre it converges to the reference") {
    check_convergence(furnace_sphere(), 1, 512);
}

TEST_CASE_FIXTURE(RendererIndirect, "a room of rough walls, as scanners see it, has its light") {
    for (const float noise : {0.01F, 0.02F, 0.03F}) {
        CAPTURE(noise);
        const Scene scene = scanned_room(noise);
        const reference::Estimate truth =
            trace(reference::Scene(scene.world), scene.camera, {.size = size, .samples = 256});
        const reference::NoisyMean wanted = reference::mean_indirect(truth, truth.hit);
        REQUIRE(wanted.error < 0.005 * wanted.value);
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.vpls = {.placement = VplPlacement::surfels, .count = 512, .bounces = 64};
        configuration.visibility = {VplVisibility::maps, 48};
        configure(configuration);
        // What only some texels of a map see between bumps counts as hidden: the more, the higher they are.
        const double error = mean(render(scene, size)) / wanted.value - 1.0;
        CHECK(std::abs(error) < (noise > 0.02F ? 0.1 : 0.05));
    }
}

}  // TEST_SUITE("reference: the renderer's indirect light")
