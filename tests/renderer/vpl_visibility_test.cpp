#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <string_view>

#include <candela/graph/execute.hpp>
#include "renderer/facade/device_of.hpp"
#include "renderer/passes/vpls/vpl_constants.hpp"
#include "tests/renderer/path_fixture.hpp"

using namespace candela;

namespace {

constexpr glm::uvec2 size{96, 72};
constexpr std::array<std::uint32_t, 5> resolutions{16, 32, 64, 128, 256};
constexpr std::array<float, 3> scales{0.01F, 1.0F, 1000.0F};

Configuration indirect_only(VplVisibility method, std::uint32_t resolution = 32) {
    Configuration configuration = linear_configuration();
    configuration.show = Show::indirect;
    configuration.shadows.enabled = false;
    configuration.vpls.placement = VplPlacement::paths;
    configuration.vpls.bounces = 1;
    configuration.visibility = {method, resolution};
    return configuration;
}

/// relMSE as in the study's measures: over all pixels, relative to |b|² + 0.01 · |mean of b|².
double relative_error(const Picture& a, const Picture& b) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& pixel : b.pixels) sum += pixel;
    const auto count = static_cast<double>(b.pixels.size());
    const double floor = 0.01 * glm::dot(sum, sum) / (count * count);
    double error = 0.0;
    for (std::size_t i = 0; i < b.pixels.size(); ++i) {
        const glm::dvec3 wanted(b.pixels[i]);
        const glm::dvec3 off = glm::dvec3(a.pixels[i]) - wanted;
        error += glm::dot(off, off) / (glm::dot(wanted, wanted) + floor);
    }
    return error / count;
}

/// A floor of 4 × 4 and, along its edge x = -2, a wall that is lit by a spot light. All lengths are
/// multiplied by `scale`. The VPLs are on the wall, and the floor does not occlude them. `cone` is that of
/// the light, in radians.
Scene lit_wall(float scale, float cone) {
    Scene scene;
    const auto material = diffuse(glm::vec3(0.5F), true);
    add(scene.world, Transform{}, MeshInstance{square(2.0F * scale, material)});
    const glm::quat upright = glm::angleAxis(-std::numbers::pi_v<float> / 2.0F, glm::vec3(0, 0, 1));
    add(scene.world, Transform{.translation = scale * glm::vec3(-2, 2, 0), .rotation = upright},
        MeshInstance{square(2.0F * scale, material)});
    scene.light =
        add(scene.world, looking(scale * glm::vec3(-0.5F, 1.2F, 0.3F), scale * glm::vec3(-2, 1, 0.1F)),
            SpotLight{.intensity = scale * scale, .inner_cone = 0.5F * cone, .outer_cone = cone});
    scene.camera = add(scene.world, looking(scale * glm::vec3(0.2F, 4.0F, 0.5F), {0, 0, 0}),
                       Camera{.vertical_fov = 0.75F, .near_plane = 0.01F * scale});
    return scene;
}

/// A floor of 2 m × 2 m around the origin, with waves along x of 5 cm, whose slopes are at most `steepness`.
std::shared_ptr<const Mesh> wavy_floor(float steepness, std::shared_ptr<const Material> material) {
    constexpr int waves = 40, steps = 8 * waves;
    Primitive primitive{.vertices = {}, .indices = {}, .material = std::move(material)};
    for (int i = 0; i <= steps; ++i) {
        const float phase = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / 8.0F;
        const float height = steepness * 0.05F / (2.0F * std::numbers::pi_v<float>)*std::sin(phase);
        const glm::vec3 normal = glm::normalize(glm::vec3(-steepness * std::cos(phase), 1.0F, 0.0F));
        const float x = 2.0F * static_cast<float>(i) / steps - 1.0F;
        for (const float z : {-1.0F, 1.0F}) {
            primitive.vertices.push_back(
                {.position = {x, height, z}, .normal = normal, .uv = glm::vec2(0.0F)});
        }
        const auto first = static_cast<std::uint32_t>(2 * i);
        if (i == steps) break;
        const std::array corners{first, first + 1, first + 3, first, first + 3, first + 2};
        primitive.indices.insert(primitive.indices.end(), corners.begin(), corners.end());
    }
    Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    return std::make_shared<const Mesh>(std::move(mesh));
}

/// A sheet that stands on the floor, in the plane x = 0.
struct Sheet {
    double height = 2.5;
    double half_width = 2.5;
};

/// Whether the sheet crosses the line from `from` (x < 0) along `direction` before `reach`. A line that
/// crosses the plane below the foot of the sheet counts as blocked, so that the shadow begins at the foot.
bool crosses(const Sheet& sheet, double scale, glm::dvec3 from, glm::dvec3 direction, double reach) {
    const double t = -from.x / direction.x;
    const glm::dvec3 at = (from + t * direction) / scale;
    return direction.x > 0.0 && t < reach && at.y < sheet.height && std::abs(at.z) < sheet.half_width;
}

/// The largest angle under which the diagonal of a texel is seen. A texel of 2 / resolution along both sides
/// of the square has a diagonal of √2 · 2 / resolution on the octahedron, which is at distance 1/s, with
/// s = |x| + |y| + z of the direction.
double texel_angle(std::uint32_t resolution, glm::dvec3 local) {
    const double s = std::abs(local.x) + std::abs(local.y) + local.z;
    return std::asin(std::min(1.0, 2.0 * std::numbers::sqrt2 * s / resolution));
}

class VplVisibilityTests : public PathFixture {
 protected:
    Picture picture(const Scene& scene, const Configuration& configuration) {
        configure(configuration);
        renderer.invalidate();
        return render(scene, size);
    }

    /// Checks the shadow of a sheet in the light of one VPL. A pixel must be exact if all lines within the
    /// angle `astray` of its line to the VPL are blocked, or if none of them is.
    void check_sheet(Configuration configuration, float scale, double texels) {
        Scene scene = lit_wall(scale, 0.002F);
        const Sheet sheet;
        const glm::quat upright = glm::angleAxis(std::numbers::pi_v<float> / 2.0F, glm::vec3(0, 0, 1));
        add(scene.world, Transform{.rotation = upright},
            MeshInstance{square(static_cast<float>(sheet.half_width) * scale, diffuse(glm::vec3(0), true))});
        configuration.vpls.count = 1;
        const std::uint32_t resolution = configuration.visibility.map_resolution;
        const Picture shadowed = picture(scene, configuration);
        configuration.visibility.method = VplVisibility::none;
        const Picture lit = picture(scene, configuration);
        const glm::dvec3 vpl = static_cast<double>(scale) * glm::dvec3(-2, 1, 0.1);  // the target of the cone
        const auto& camera = scene.world.get<Camera>(scene.camera);
        const auto& pose = scene.world.get<Transform>(scene.camera);
        std::size_t dark = 0, bright = 0, wrong = 0;
        for (std::uint32_t i = 0; i < size.x * size.y; ++i) {
            const PixelRay view = pixel_ray(camera, pose, size, i % size.x, i / size.x);
            const glm::dvec3 point = view.origin - view.origin.y / view.direction.y * view.direction;
            const glm::dvec3 on_sheet =
                (view.origin - view.origin.x / view.direction.x * view.direction) / double(scale);
            const bool sees_sheet = view.origin.x * view.direction.x < 0.0 && on_sheet.y > 0.0 &&
                                    on_sheet.y < sheet.height && std::abs(on_sheet.z) < sheet.half_width;
            if (lit.pixels[i].r == 0.0F || sees_sheet) continue;
            const double reach = glm::distance(point, vpl);
            const glm::dvec3 ray = (point - vpl) / reach;
            const double astray = texels * texel_angle(resolution, {ray.y, ray.z, ray.x});
            const glm::dvec3 u = glm::normalize(glm::cross(ray, glm::dvec3(0, 1, 0)));
            const glm::dvec3 v = glm::cross(ray, u);
            std::size_t hits = 0;
            constexpr int around = 16;
            for (int k = 0; k < around; ++k) {
                const double turn = 2.0 * std::numbers::pi * k / around;
                const glm::dvec3 side = std::cos(turn) * u + std::sin(turn) * v;
                hits +=
                    crosses(sheet, scale, vpl, ray + std::tan(std::min(astray, 1.5)) * side, reach) ? 1 : 0;
            }
            const bool centre = crosses(sheet, scale, vpl, ray, reach);
            const float visible = shadowed.pixels[i].r / lit.pixels[i].r;
            if (hits == around && centre) {
                ++dark;
                wrong += visible == 0.0F ? 0 : 1;
            } else if (hits == 0 && !centre) {
                ++bright;
                wrong += visible >= 0.99F ? 0 : 1;
            }
        }
        CAPTURE(resolution);
        CAPTURE(scale);
        CHECK(dark > 40);
        CHECK(bright > 200);
        CHECK(wrong == 0);
    }
};

/// The two rooms with the door between them closed.
Scene closed_rooms() {
    Scene scene = shipped_scene("two-rooms");
    Entity door;
    for (const auto& [entity, name] : scene.world.view<Name>()) {
        if (name.value == "door") door = entity;
    }
    Transform pose = scene.world.get<Transform>(door);
    pose.rotation = glm::quat(1, 0, 0, 0);
    scene.world.set(door, pose);
    return scene;
}

}  // namespace

TEST_SUITE("VPL visibility") {
TEST_CASE_FIXTURE(VplVisibilityTests, "an unoccluded plane is not darkened") {
    for (const float scale : scales) {
        const Scene scene = lit_wall(scale, 0.4F);
        Configuration configuration = indirect_only(VplVisibility::none);
        configuration.vpls.count = 64;
        const Picture lit = picture(scene, configuration);
        REQUIRE(mean(lit) > 1e-4);
        configuration.visibility.method = VplVisibility::maps;
        for (const std::uint32_t resolution : resolutions) {
            CAPTURE(scale);
            CAPTURE(resolution);
            configuration.visibility.map_resolution = resolution;
            // No pixel differs by more than 1 %.
            CHECK(worst_error(picture(scene, configuration), lit, 1e-12) < 0.01);
        }
        configuration.visibility.method = VplVisibility::rays;
        CHECK(picture(scene, configuration) == lit);
    }
}

TEST_CASE_FIXTURE(VplVisibilityTests,
                  "a floor with waves that are narrower than texels does not darken itself") {
    Scene scene = lit_wall(1.0F, 0.4F);
    // Rays, too, meet waves of these slopes only where light is grazing. Without slack, 7 % and more are
    // missing.
    add(scene.world, at({0, 0.01F, 0}), MeshInstance{wavy_floor(0.4F, diffuse(glm::vec3(0.5F)))});
    Configuration configuration = indirect_only(VplVisibility::rays);
    configuration.vpls.count = 64;
    const double lit = mean(picture(scene, configuration));
    configuration.visibility.method = VplVisibility::maps;
    for (const std::uint32_t resolution : {16U, 32U, 48U, 64U}) {
        CAPTURE(resolution);
        configuration.visibility.map_resolution = resolution;
        CHECK(std::abs(mean(picture(scene, configuration)) / lit - 1.0) < 0.02);
    }
}

TEST_CASE_FIXTURE(VplVisibilityTests, "smooth normals do not darken the inside of a sphere") {
    Scene scene;
    // Facets of 8°: shading normals differ by up to 5° from the normals of facets.
    add(scene.world, Transform{}, MeshInstance{sphere_inwards(2.0F, 3, diffuse(glm::vec3(0.5F)))});
    add(scene.world, at({0.5F, 0.3F, 0.2F}), PointLight{});
    scene.camera = add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
    Configuration configuration = indirect_only(VplVisibility::none);
    configuration.vpls.count = 12;  // few, so that missing one of them makes a large difference
    const Picture lit = picture(scene, configuration);
    configuration.visibility.method = VplVisibility::maps;
    for (const std::uint32_t resolution : resolutions) {
        configuration.visibility.map_resolution = resolution;
        CAPTURE(resolution);
        CHECK(worst_error(picture(scene, configuration), lit, 1e-12) < 0.01);
    }
}

TEST_CASE_FIXTURE(VplVisibilityTests,
                  "the shadow of a sheet is at the right place and begins at its lower edge") {
    for (const float scale : scales) {
        for (const std::uint32_t resolution : resolutions) {
            check_sheet(indirect_only(VplVisibility::maps, resolution), scale, 2.0);
        }
        // Rays are exact except for the offsets of their ends: here a hundredth of a texel's diagonal.
        check_sheet(indirect_only(VplVisibility::rays), scale, 0.01);
    }
}

TEST_CASE_FIXTURE(VplVisibilityTests, "depth maps approach the result of rays as their resolution grows") {
    const Scene scene = cornell_box();
    Configuration configuration = indirect_only(VplVisibility::rays);
    configuration.vpls.count = 96;
    configuration.vpls.bounces = 3;
    const Picture exact = picture(scene, configuration);
    configuration.visibility.method = VplVisibility::none;
    const double without = relative_error(picture(scene, configuration), exact);
    configuration.visibility.method = VplVisibility::maps;
    double coarser = without;
    for (const std::uint32_t resolution : {16U, 64U, 256U}) {
        CAPTURE(resolution);
        configuration.visibility.map_resolution = resolution;
        const double error = relative_error(picture(scene, configuration), exact);
        CHECK(error < 0.7 * coarser);  // noise alone would reduce it less
        coarser = error;
    }
    // 256 texels per side: 16 slots per layer, and so 6 layers. A texel is 1/100 rad, a blurred edge 2 cm
    // wide.
    CHECK(coarser < 0.02);
}

TEST_CASE_FIXTURE(VplVisibilityTests, "no light passes a closed door") {
    Scene scene = closed_rooms();
    const Entity dark = scene.camera;
    const Entity lit =
        add(scene.world, looking({-0.3F, 1.7F, 1.7F}, {-2.5F, 0.85F, -0.4F}), Camera{.vertical_fov = 1.2F});
    for (const VplVisibility method : {VplVisibility::maps, VplVisibility::rays}) {
        CAPTURE(to_string(method));
        Configuration configuration = indirect_only(method, 64);
        configuration.vpls.bounces = 3;
        scene.camera = lit;
        const double bright = mean(picture(scene, configuration));
        scene.camera = dark;
        CHECK(mean(picture(scene, configuration)) < 1e-4 * bright);
        CHECK(bright > 0.1);
    }
}

TEST_CASE_FIXTURE(VplVisibilityTests, "a closed convex box has no shadows") {
    const Scene scene = furnace_box(0.5F);
    Configuration configuration = indirect_only(VplVisibility::none);
    configuration.vpls.bounces = 16;
    const Picture lit = picture(scene, configuration);
    configuration.visibility.method = VplVisibility::rays;
    CHECK(relative_error(picture(scene, configuration), lit) < 1e-6);
    // No wall is behind another, but slopes of planes are rounded: by up to a 512th, so that a few pixels
    // where walls meet are hidden in some of the VPLs.
    for (const std::uint32_t resolution : {8U, 32U, 33U, 128U}) {
        CAPTURE(resolution);
        configuration.visibility = {VplVisibility::maps, resolution};
        CHECK(relative_error(picture(scene, configuration), lit) < 1e-5);
    }
}

TEST_CASE_FIXTURE(VplVisibilityTests,
                  "switching the method leaks no objects and does not change later pictures") {
    const Scene scene = cornell_box();
    const auto round = [&] {
        Picture last;
        for (const VplVisibility method : {VplVisibility::maps, VplVisibility::rays, VplVisibility::none}) {
            configure(indirect_only(method));
            last = render(scene, size);
        }
        return last;
    };
    configure(indirect_only(VplVisibility::none));
    const Picture before = render(scene, size);
    CHECK(round() == before);
    const gl::ObjectCounts once = device_of(renderer).live();
    CHECK(round() == before);
    CHECK(device_of(renderer).live() == once);
}

TEST_CASE_FIXTURE(VplVisibilityTests,
                  "depth maps are drawn if the VPLs change, but not if the camera moves") {
    Scene scene = cornell_box();
    configure(indirect_only(VplVisibility::maps));
    const Picture first = render(scene, size);
    CHECK(ran("vpl-maps"));
    Transform pose = scene.world.get<Transform>(scene.camera);
    pose.translation.x += 0.1F;
    scene.world.set(scene.camera, pose);
    CHECK(render(scene, size) != first);
    CHECK_FALSE(ran("vpl-maps"));
    scene.world.set(scene.light, at({0.3F, 1.5F, 0.0F}));
    const Picture moved = render(scene, size);
    CHECK(ran("vpl-maps"));
    renderer.invalidate();
    CHECK(render(scene, size) == moved);
}

}  // TEST_SUITE("VPL visibility")

TEST_SUITE("VPL atlas") {
TEST_CASE("tiles fit into the limits of the driver") {
    const gl::Limits limits{.texture_size = 16384, .texture_layers = 2048};
    for (const std::uint32_t resolution : {8U, 33U, 64U, 200U, 1024U}) {
        for (const std::uint32_t maps : {1U, 2U, 257U, 16384U}) {
            CAPTURE(resolution);
            CAPTURE(maps);
            const VplAtlas atlas = plan_vpl_atlas(resolution, maps, limits);
            const std::uint32_t room = atlas.tiles * atlas.tiles;
            CHECK(atlas.tiles * resolution <= atlas.side);
            CHECK(atlas.side <= limits.texture_size);
            CHECK(atlas.layers <= limits.texture_layers);
            CHECK(room * atlas.layers >= maps);
            CHECK(room * (atlas.layers - 1) < maps);
        }
    }
}

TEST_CASE("maps that do not fit into the limits are refused") {
    const gl::Limits limits{.texture_size = 1024, .texture_layers = 256};
    CHECK_THROWS_WITH_AS(static_cast<void>(plan_vpl_atlas(2048, 1, limits)),
                         "depth maps of VPLs of 2048 texels a side: the driver allows 1024", gl::GlError);
    CHECK_THROWS_WITH_AS(
        static_cast<void>(plan_vpl_atlas(256, 16384, limits)),
        "depth maps of 16384 VPLs, 256 texels a side, fill 1024 layers; the driver allows 256", gl::GlError);
}

}  // TEST_SUITE("VPL atlas")
