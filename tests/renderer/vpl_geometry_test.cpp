#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("geometry term") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{32, 64};
constexpr float albedo = 0.5F;

/// A floor of 2 m × 2 m at y = 0 in the sun, and an upright wall of the same size, at a distance of `gap`
/// from the floor's edge x = 1. The sun's rays are parallel to the wall and do not light it. The camera faces
/// the middle of the wall; the height of the picture is that of the wall. `foot` is the height of the wall's
/// lower edge. Everything is rotated by `turn`.
Scene sunlit_floor(float gap, float foot, glm::quat turn) {
    Scene scene;
    const auto turned = [&](const Transform& pose) {
        return Transform{.translation = turn * pose.translation, .rotation = turn * pose.rotation};
    };
    const auto material = diffuse(glm::vec3(albedo), true);
    const glm::quat upright = glm::angleAxis(std::numbers::pi_v<float> / 2.0F, glm::vec3(0, 0, 1));
    const float middle = 1.0F + foot;
    add(scene.world, turned({}), MeshInstance{square(1.0F, material)});
    add(scene.world, turned({.translation = {1.0F + gap, middle, 0.0F}, .rotation = upright}),
        MeshInstance{square(1.0F, material)});
    scene.light = add(scene.world, turned(looking({0, 2, 0}, {0, 0, 0}, {1, 0, 0})), DirectionalLight{});
    scene.camera =
        add(scene.world, turned(looking({-2.0F, middle, 0.0F}, {0.0F, middle, 0.0F})),
            Camera{.projection = Camera::Projection::orthographic, .half_height = 1.0F, .far_plane = 10.0F});
    return scene;
}

/// Aligned with the world's axes and rotated, because edges are searched along these axes.
const std::array<glm::quat, 3> turns{glm::quat(1, 0, 0, 0), glm::angleAxis(0.6F, glm::vec3(0, 1, 0)),
                                     glm::angleAxis(0.9F, glm::normalize(glm::vec3(1, 2, 3)))};

/// The form factor from a point on a wall, `height` above the floor, to the floor, which is 2 · 1 m wide and
/// extends from the wall to `depth`. Twice the configuration factor of Howell et al., "Thermal Radiation Heat
/// Transfer", from an element to a perpendicular rectangle with a corner below it.
double floor_factor(double height, double depth) {
    const double slant = std::hypot(height, depth);
    return (std::atan(1.0 / height) - height / slant * std::atan(1.0 / slant)) / pi;
}

class VplGeometry : public RenderFixture {
 protected:
    /// The mean radiance of the middle pixels of each row, from one bounce of light, bottom row first.
    std::vector<double> rows(const Scene& scene) {
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.vpls = {.placement = VplPlacement::paths, .count = 4096, .bounces = 1, .seed = 0};
        configure(configuration);
        renderer.invalidate();  // the scenes of a loop have the same address
        const Picture picture = render(scene, size);
        std::vector<double> means(size.y, 0.0);
        for (std::uint32_t y = 0; y < size.y; ++y) {
            for (std::uint32_t x = size.x / 2 - 4; x < size.x / 2 + 4; ++x) {
                means[y] += static_cast<double>(picture.at(x, y).r) / 8.0;
            }
        }
        return means;
    }
};

}  // namespace

// VPLs represent discs with a radius R of 0.05 m here: R² = 4A / (π N), with 8 m² and 4096 VPLs.
constexpr double radius = 0.05;
constexpr double scatter = 0.02;  // of the VPLs: more than 1/√N, as the sun's footprint wastes some

TEST_CASE_FIXTURE(VplGeometry, "a wall that stands on a lit floor is lit down to the floor") {
    for (const glm::quat& turn : turns) {
        CAPTURE(glm::degrees(glm::angle(turn)));
        const std::vector<double> found = rows(sunlit_floor(0.0F, 0.0F, turn));
        for (std::uint32_t y = 0; y < size.y; ++y) {
            const double height = 2.0 * (y + 0.5) / size.y;
            const double exact = albedo * albedo / pi * floor_factor(height, 2.0);
            CAPTURE(height);
            // A disc alone would remove all light towards the foot. The loss fades as R over the height.
            CHECK(found[y] > exact * (1.0 - std::min(0.3, 0.2 * radius / height) - scatter));
            CHECK(found[y] < exact * (1.0 + scatter));
        }
    }
}

TEST_CASE_FIXTURE(VplGeometry, "the light of a wall beyond the edge of a lit floor starts at zero") {
    const double gap = 2.0 * radius;
    for (const glm::quat& turn : turns) {
        CAPTURE(glm::degrees(glm::angle(turn)));
        const std::vector<double> found = rows(sunlit_floor(static_cast<float>(gap), -1.0F, turn));
        const double peak = *std::ranges::max_element(found);
        for (std::uint32_t y = 0; y < size.y; ++y) {
            const double height = 2.0 * (y + 0.5) / size.y - 1.0;
            const double factor = floor_factor(height, 2.0 + gap) - floor_factor(height, gap);
            const double exact = height < 0.0 ? 0.0 : albedo * albedo / pi * factor;
            CAPTURE(height);
            // Discs two radii away are slightly blurred, and VPLs are noisy. If the floor were assumed to
            // extend to the wall, the lowest rows would be off by an eighth of the peak or more.
            CHECK(std::abs(found[y] - exact) < 0.07 * peak);
        }
    }
}

TEST_CASE_FIXTURE(VplGeometry, "no pixel on the edge between two walls is dark") {
    // The camera looks straight into a box: the edges between walls run at 45 degrees, through pixel
    // centres.
    const Scene scene = shipped_scene("furnace");
    Configuration configuration = linear_configuration();
    configuration.show = Show::indirect;
    configuration.vpls.placement = VplPlacement::paths;
    // With more VPLs the discs are so small that the pixel in a corner is deep inside them.
    configuration.vpls.count = 256;
    const auto picture = [&](VplVisibility method) {
        configuration.visibility.method = method;
        configure(configuration);
        return render(scene, {96, 96});
    };
    const Picture open = picture(VplVisibility::none);
    // All walls are lit equally, except for the light that is removed near VPLs, mostly in the corners of
    // the box.
    CHECK(static_cast<double>(std::ranges::min_element(open.pixels, {}, &glm::vec3::r)->r) >
          0.5 * mean(open));
    CHECK(worst_error(picture(VplVisibility::rays), open, 0.0) < 1e-4);  // sums in another order
    // Half of the texels that a look-up in a map reads may be of the other wall.
    const Picture mapped = picture(VplVisibility::maps);
    for (std::size_t i = 0; i < open.pixels.size(); ++i) {
        CHECK(mapped.pixels[i].r > 0.5F * open.pixels[i].r);
    }
}

}  // TEST_SUITE("geometry term")
