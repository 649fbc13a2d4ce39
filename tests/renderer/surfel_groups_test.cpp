// Groups of surfels, which far pixels see as one VPL.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/surfels/surfel_groups.hpp"
#include "tests/renderer/items_of_meshes.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/renderer/texels.hpp"
#include "tests/seed.hpp"

TEST_SUITE("surfels: groups") {

using namespace candela;

namespace {

/// A square of 2 m, of two triangles.
SceneSurfaces square_surfaces() {
    return surfaces_of({parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, diffuse(glm::vec3(0.5F)))});
}

/// disc_term of shaders/vpls/disc.glsl in double precision, for a receiver with one normal. See
/// shaders/README.md, "The sinking disc".
double disc_term(const glm::dvec3& centre, const glm::dvec3& normal, double radius2, const glm::dvec3& from,
                 const glm::dvec3& facing) {
    const glm::dvec3 to_disc = centre - from;
    const double height = -glm::dot(normal, to_disc);
    if (height < 0.0) return 0.0;
    const double tilt = 1.0 - std::max(-glm::dot(normal, facing), 0.0);
    const double depth = tilt * radius2 / std::sqrt(radius2 + glm::dot(to_disc, to_disc));
    const glm::dvec3 sunk = to_disc - depth * normal;
    const double distance2 = glm::dot(sunk, sunk);
    return std::max(glm::dot(facing, sunk), 0.0) * (height + depth) /
           (distance2 * (distance2 + (1.0 - tilt) * radius2));
}

double light_of(const gpu::LitSurfel& vpl, const glm::dvec3& from, const glm::dvec3& facing) {
    return static_cast<double>(vpl.flux.r) * disc_term(glm::dvec3(vpl.centre), glm::dvec3(vpl.normal),
                                                       static_cast<double>(vpl.radius2), from, facing);
}

double width_of(const gpu::LitSurfel& vpl) {
    return std::sqrt(static_cast<double>(vpl.width2));
}

/// The records of surfels, and those of the groups behind them.
struct Records {
    std::vector<gpu::LitSurfel> surfels, groups;
};

class GroupTests : public RenderFixture {
 protected:
    static constexpr glm::uvec2 size{24, 48};

    static Configuration groups(std::uint32_t count) {
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.interleave = Interleave::one;
        configuration.visibility.method = VplVisibility::none;
        configuration.vpls = {
            .placement = VplPlacement::surfels, .count = count, .bounces = 1, .seed = 0, .guided = false};
        return configuration;
    }

    FrameResults render_parts(const Scene& scene) {
        const RenderView view{
            .camera = scene.camera, .target = target.target(), .keep = {.indirect = true, .vpls = true}};
        renderer.render(scene.world, {&view, 1});
        return renderer.results();
    }

    Records read(const ResultBuffer& result) {
        GLint64 bytes = 0;
        gl.GetNamedBufferParameteri64v(result.buffer, GL_BUFFER_SIZE, &bytes);
        std::vector<gpu::LitSurfel> all(static_cast<std::size_t>(bytes) / sizeof(gpu::LitSurfel));
        gl.GetNamedBufferSubData(result.buffer, 0,
                                 static_cast<GLsizeiptr>(all.size() * sizeof(gpu::LitSurfel)), all.data());
        Records records;
        records.surfels.assign(all.begin(), all.begin() + result.count);
        // As many groups as have all surfels.
        std::uint32_t covered = 0;
        for (std::size_t i = result.count; i < all.size() && covered < result.count; ++i) {
            REQUIRE(all[i].first_point == covered);
            covered += all[i].point_count;
            records.groups.push_back(all[i]);
        }
        CHECK(covered == result.count);
        return records;
    }

    RenderTarget target{device, size};
    const gl::Functions& gl = device.gl();
};

const glm::dvec3 strip_middle(0.0, 0.35, 0.0);
constexpr glm::vec3 strip_half(0.2F, 1.0F, 0.8F);

/// Turns +y downwards, and a slope of 1 in 4 along z.
glm::quat strip_turn() {
    return glm::angleAxis(glm::pi<float>(), glm::vec3(1, 0, 0)) *
           glm::angleAxis(std::atan(0.25F), glm::vec3(1, 0, 0));
}

bool is_on_strip(const glm::dvec3& place) {
    const glm::vec3 off = glm::inverse(strip_turn()) * glm::vec3(place - strip_middle);
    // Pixels at its edge are not on it as a whole.
    return std::abs(off.x) < 0.9F * strip_half.x && std::abs(off.z) < 0.9F * strip_half.z;
}

/// A floor of 2 m in the sun, and a strip above it that faces it and rises from 0.15 m to 0.55 m. The camera
/// sees the strip from below.
Scene strip_over_floor() {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(1.0F, diffuse(glm::vec3(0.5F)))});
    add(scene.world,
        Transform{.translation = glm::vec3(strip_middle), .rotation = strip_turn(), .scale = strip_half},
        MeshInstance{square(1.0F, diffuse(glm::vec3(0.5F)))});
    scene.light = add(scene.world, looking({0.0F, 2.0F, 0.0F}, {0.5F, 0.0F, 0.1F}),
                      DirectionalLight{.illuminance = 10.0F});
    scene.camera = add(scene.world, looking({0.0F, 0.1F, 0.0F}, {0.0F, 0.35F, 0.0F}, {0, 0, 1}),
                       Camera{.projection = Camera::Projection::orthographic,
                              .half_height = 0.75F,
                              .near_plane = 0.001F,
                              .far_plane = 2.0F});
    return scene;
}

}  // namespace

TEST_CASE("surfels of a branch follow each other, and up to 512 each has a branch of its own") {
    for (const std::uint32_t count : {100U, 512U, 513U, 4096U}) {
        CAPTURE(count);
        const SurfelSet set = SurfelPlacement(square_surfaces(), test_seed()).place({.reflecting = count});
        REQUIRE(set.branches.size() == set.surfels.size());
        std::vector<std::uint32_t> starts;
        for (std::size_t i = 0; i < set.branches.size(); ++i) {
            if (i == 0 || set.branches[i] != set.branches[i - 1]) starts.push_back(set.branches[i]);
        }
        CHECK(starts.size() == std::min<std::size_t>(set.surfels.size(), most_branches));
        std::ranges::sort(starts);
        CHECK(std::ranges::adjacent_find(starts) == starts.end());
        CHECK((surfels_a_group(count) == 1) == (count <= most_branches));
    }
}

TEST_CASE("branches have the area of their surfels, and about the width of a square of that area") {
    const SurfelSet set = SurfelPlacement(square_surfaces(), test_seed()).place({.reflecting = 8192});
    const SurfelSet branches = branches_of(set);
    CHECK(branches.points.size() == set.surfels.size());
    double area = 0.0;
    for (const gpu::Surfel& branch : branches.surfels) {
        area += static_cast<double>(branch.area);
        CHECK(branch.width2 >= branch.area);
        // Patches are cut where they are longest: none is much longer than twice its width. A rectangle
        // of a × 2a has the variance 5a²/12, that is 6/2 · 5/12 = 1.25 times that of a square.
        CHECK(branch.width2 < 2.5F * branch.area);
    }
    CHECK(area == doctest::Approx(4.0).epsilon(1e-4));
}

TEST_CASE("a place on a floor of 16 times the surfels sums at most three times the VPLs") {
    const SurfelSet set = SurfelPlacement(square_surfaces(), test_seed()).place({.reflecting = 8192});
    const SurfelSet branches = branches_of(set);
    // Seen from above the floor. About π · 3² = 28 groups of 16 are nearer than GROUP_FAR widths.
    for (const float x : {-0.9F, -0.3F, 0.0F, 0.5F}) {
        std::uint32_t summed = 0;
        for (const gpu::Surfel& branch : branches.surfels) {
            const float widths =
                glm::distance(branch.position, glm::vec3(x, 0.1F, 0.05F)) / std::sqrt(branch.width2);
            summed += (widths > GROUP_NEAR ? 1U : 0U) + (widths < GROUP_FAR ? branch.point_count : 0U);
        }
        CHECK(summed < 3 * most_branches);
    }
}

TEST_CASE_FIXTURE(GroupTests, "a group has the flux and the area of its surfels, and is where they are") {
    Configuration configuration = groups(2048);
    configuration.vpls.bounces = 4;
    configure(configuration);
    const Scene scene = cornell_box();
    const FrameResults results = render_parts(scene);
    const Records records = read(results.lit_surfels);
    CHECK(records.groups.size() < records.surfels.size() / 2);
    for (const gpu::LitSurfel& group : records.groups) {
        glm::dvec3 flux(0.0);
        double area = 0.0, apart = 1e9;
        for (std::uint32_t i = group.first_point; i < group.first_point + group.point_count; ++i) {
            const gpu::LitSurfel& surfel = records.surfels[i];
            flux += glm::dvec3(surfel.flux);
            area += static_cast<double>(surfel.area);
            const auto off = static_cast<double>(glm::distance(surfel.position, group.position));
            apart = std::min(apart, off);
            CHECK(off <= static_cast<double>(group.reach) * (1.0 + 1e-5));
            // Parts of a cell have normals whose cosine is at least 0.7.
            CHECK(glm::dot(surfel.normal, group.normal) >= 0.7F - 1e-5F);
        }
        CHECK(apart == 0.0);
        CHECK(static_cast<double>(group.area) == doctest::Approx(area).epsilon(1e-4));
        for (int channel = 0; channel < 3; ++channel) {
            CHECK(static_cast<double>(group.flux[channel]) == doctest::Approx(flux[channel]).epsilon(1e-4));
        }
    }
}

TEST_CASE_FIXTURE(GroupTests, "near and far from groups a pixel receives the light of their surfels") {
    const Scene scene = strip_over_floor();
    configure(groups(2048));
    const FrameResults results = render_parts(scene);
    const Records records = read(results.lit_surfels);
    const std::vector<glm::vec4> indirect = texels(gl, results.indirect);
    const Transform pose = scene.world.get<Transform>(scene.camera);
    const Camera camera = scene.world.get<Camera>(scene.camera);
    const glm::dvec3 facing(strip_turn() * glm::vec3(0, 1, 0));
    std::size_t seen = 0, of_wholes = 0, of_each = 0;
    for (std::uint32_t y = 0; y < size.y; ++y) {
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const PixelRay ray = pixel_ray(camera, pose, size, x, y);
            const double t = glm::dot(strip_middle - ray.origin, facing) / glm::dot(ray.direction, facing);
            const glm::dvec3 from = ray.origin + t * ray.direction;
            if (!is_on_strip(from)) continue;
            double exact = 0.0, blended = 0.0, bound = 0.0;
            for (const gpu::LitSurfel& group : records.groups) {
                double each = 0.0;
                for (std::uint32_t i = 0; i < group.point_count; ++i) {
                    each += light_of(records.surfels[group.first_point + i], from, facing);
                }
                const double widths = glm::distance(from, glm::dvec3(group.position)) / width_of(group);
                const double u = std::clamp((widths - GROUP_NEAR) / (GROUP_FAR - GROUP_NEAR), 0.0, 1.0);
                const double whole = group.point_count == 1 ? 0.0 : u * u * (3.0 - 2.0 * u);
                exact += each;
                // shaders/README.md, "Groups of surfels": at GROUP_NEAR the error is at most 6.5 % of the
                // light that a facing receiver straight ahead has, and it falls with the square of the
                // distance.
                bound += whole * 0.065 * std::pow(GROUP_NEAR / widths, 2.0) *
                         static_cast<double>(group.flux.r) /
                         std::pow(glm::distance(from, glm::dvec3(group.position)), 2.0);
                blended += (1.0 - whole) * each + whole * light_of(group, from, facing);
                of_wholes += whole == 1.0 ? 1 : 0;
                of_each += whole < 1.0 ? 1 : 0;
            }
            if (exact < 0.05) continue;
            ++seen;
            const auto found = static_cast<double>(indirect[y * size.x + x].r);
            // Surfels nearer than three
            // times their own width are summed point by point: on the axis of a square cell at that
            // distance, its disc differs by less than 1 %, and by less over many.
            CHECK(found == doctest::Approx(blended).epsilon(0.01));
            CHECK(std::abs(found - exact) < bound + 0.01 * exact);
        }
    }
    CHECK(seen > 50);
    CHECK(of_wholes > 0);
    CHECK(of_each > 0);
}

}  // TEST_SUITE("surfels: groups")
