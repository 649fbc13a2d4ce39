#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "renderer/passes/view/view_cull.hpp"
#include "tests/seed.hpp"

TEST_SUITE("view cull") {

using namespace candela;

namespace {

class Random {
 public:
    float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    glm::vec3 vector(float reach) {
        const float x = number(-reach, reach), y = number(-reach, reach);
        return {x, y, number(-reach, reach)};
    }
    glm::vec3 within(const Box& box) {
        const float x = number(box.lower.x, box.upper.x), y = number(box.lower.y, box.upper.y);
        return {x, y, number(box.lower.z, box.upper.z)};
    }
    Box box() {
        const glm::vec3 lower = vector(10.0F);
        return {lower, lower + glm::abs(vector(number(0.0F, 4.0F)))};
    }
    CameraView view() {
        Camera camera;
        camera.vertical_fov = number(0.1F, 2.5F);
        camera.near_plane = number(0.01F, 1.0F);
        camera.far_plane = number(0.0F, 1.0F) < 0.5F ? std::numeric_limits<float>::infinity() : 12.0F;
        if (number(0.0F, 1.0F) < 0.3F) {
            camera.projection = Camera::Projection::orthographic;
            camera.half_height = number(0.5F, 8.0F);
            camera.far_plane = 12.0F;
        }
        const glm::mat4 pose = glm::inverse(glm::lookAt(vector(5.0F), vector(5.0F), {0.1F, 1.0F, 0.2F}));
        return make_view(camera, pose, {160, 90});
    }

 private:
    std::mt19937 engine_{test_seed()};
};

bool is_in_view(const glm::vec4& clip) {
    return std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z >= 0.0F && clip.z <= clip.w;
}

/// Whether any of many random points in the box is in the view.
bool any_point_in_view(Random& random, const Box& box, const glm::mat4& clip_from_world) {
    for (int i = 0; i < 200; ++i) {
        if (is_in_view(clip_from_world * glm::vec4(random.within(box), 1.0F))) return true;
    }
    return false;
}

/// Looks along -z from the origin, 90° wide and high, from 1 to 10 metres.
CameraView straight_view() {
    Camera camera;
    camera.vertical_fov = 1.5707963F;
    camera.near_plane = 1.0F;
    camera.far_plane = 10.0F;
    return make_view(camera, glm::mat4(1.0F), {100, 100});
}

Box cube_at(glm::vec3 centre) {
    return {centre - 0.5F, centre + 0.5F};
}

}  // namespace

TEST_CASE("a box with a point in the view is never culled, and most other boxes are") {
    Random random;
    int hidden = 0;
    int culled = 0;
    for (int i = 0; i < 4000; ++i) {
        const Box box = random.box();
        const CameraView view = random.view();
        const bool outside = is_outside(box, view.clip_from_world);
        if (any_point_in_view(random, box, view.clip_from_world)) {
            CHECK_FALSE(outside);
        } else {
            ++hidden;
            culled += outside ? 1 : 0;
        }
    }
    // Near an edge of the view, an invisible box may not be completely outside of any single plane.
    CHECK(hidden > 1000);
    CHECK(culled > 0.9 * hidden);
}

TEST_CASE("boxes outside of any of the six planes are culled, boxes that cross one are not") {
    const glm::mat4 clip = straight_view().clip_from_world;
    for (const glm::vec3 outside : {glm::vec3(-6.1F, 0, -5),
                                    {6.1F, 0, -5},
                                    {0, -6.1F, -5},
                                    {0, 6.1F, -5},
                                    {0, 0, -0.4F},
                                    {0, 0, 5},
                                    {0, 0, -10.6F}}) {
        CAPTURE(outside.x);
        CAPTURE(outside.y);
        CAPTURE(outside.z);
        CHECK(is_outside(cube_at(outside), clip));
    }
    for (const glm::vec3 across : {glm::vec3(-5.4F, 0, -5),
                                   {5.4F, 0, -5},
                                   {0, -5.4F, -5},
                                   {0, 5.4F, -5},
                                   {0, 0, -0.6F},
                                   {0, 0, -10.4F}}) {
        CHECK_FALSE(is_outside(cube_at(across), clip));
    }
    CHECK_FALSE(is_outside({glm::vec3(-100.0F), glm::vec3(100.0F)}, clip));  // contains the eye
}

TEST_CASE("draws of items that are placed outside the view get no instances and are else unchanged") {
    SceneLayout layout;
    ScenePlacement placement;
    for (const float x : {0.0F, 50.0F, 1.0F}) {
        const auto item = static_cast<std::uint32_t>(placement.world.size());
        layout.drawables.push_back({item, nullptr, 0, cube_at(glm::vec3(0.0F))});
        layout.draws.push_back({36, 1, 10 * item, 0, item});
        placement.world.push_back(glm::translate(glm::mat4(1.0F), glm::vec3(x, 0.0F, -5.0F)));
    }
    const std::vector<gpu::DrawCommand> draws = visible_draws(layout, placement, straight_view());
    REQUIRE(draws.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(draws[i].instance_count == (i == 1 ? 0 : 1));
        CHECK(draws[i].first_index == layout.draws[i].first_index);
        CHECK(draws[i].base_instance == layout.draws[i].base_instance);
    }
}

}  // TEST_SUITE("view cull")
