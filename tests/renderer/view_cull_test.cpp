#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "renderer/passes/view/seen_objects.hpp"
#include "renderer/passes/view/view.hpp"
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
        const bool outside = in_view(box, view.clip_from_world) == InView::outside;
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
        CHECK(in_view(cube_at(outside), clip) == InView::outside);
    }
    for (const glm::vec3 across : {glm::vec3(-5.4F, 0, -5),
                                   {5.4F, 0, -5},
                                   {0, -5.4F, -5},
                                   {0, 5.4F, -5},
                                   {0, 0, -0.6F},
                                   {0, 0, -10.4F}}) {
        CHECK(in_view(cube_at(across), clip) == InView::partly);
    }
    CHECK(in_view({glm::vec3(-100.0F), glm::vec3(100.0F)}, clip) == InView::partly);  // contains the eye
    CHECK(in_view(cube_at({0, 0, -5}), clip) == InView::inside);
}

namespace {

/// Objects of a few triangles each that lie anywhere, under a top that is kept.
class Objects {
 public:
    explicit Objects(Random& random) : random_(&random) {}

    void add() {
        objects_.emplace_back();
        move(size() - 1);
    }
    /// The last one takes its number.
    void remove(std::uint32_t object) {
        const std::uint32_t last = size() - 1;
        top.set(object, {});
        top.set(last, {});
        objects_[object] = objects_[last];
        objects_.pop_back();
        if (object < last) top.set(object, box_of(object));
    }
    void move(std::uint32_t object) {
        place(object);
        top.set(object, box_of(object));
    }
    void build_if_worn() {
        if (!top.is_worn()) return;
        std::vector<Box> boxes;
        for (std::uint32_t i = 0; i < size(); ++i) boxes.push_back(box_of(i));
        top.build(boxes);
        ++built;
    }

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(objects_.size()); }
    [[nodiscard]] const std::vector<Triangle>& triangles(std::uint32_t object) const {
        return objects_[object];
    }

    KeptTop top;
    int built = 0;

 private:
    void place(std::uint32_t object) {
        std::vector<Triangle>& changed = objects_[object];
        const glm::vec3 centre = random_->vector(12.0F);
        changed.resize(6);
        for (Triangle& t : changed) {
            t = {centre + random_->vector(1.0F), centre + random_->vector(1.0F),
                 centre + random_->vector(1.0F)};
        }
    }
    [[nodiscard]] Box box_of(std::uint32_t object) const {
        Box box;
        for (const Triangle& t : objects_[object]) box.grow(bounds(t));
        return box;
    }

    Random* random_;
    std::vector<std::vector<Triangle>> objects_;
};

bool has_corner_in_view(const std::vector<Triangle>& triangles, const glm::mat4& clip_from_world) {
    return std::ranges::any_of(triangles, [&](const Triangle& t) {
        return is_in_view(clip_from_world * glm::vec4(t.a, 1.0F)) ||
               is_in_view(clip_from_world * glm::vec4(t.b, 1.0F)) ||
               is_in_view(clip_from_world * glm::vec4(t.c, 1.0F));
    });
}

bool is_surely_outside(const std::vector<Triangle>& triangles, const glm::mat4& clip_from_world) {
    Box box;
    for (const Triangle& t : triangles) box.grow(bounds(t));
    return in_view(box, clip_from_world) == InView::outside;
}

}  // namespace

TEST_CASE("what a kept view sees follows the camera and the objects, and says what has changed") {
    Random random;
    Objects objects(random);
    SeenObjects kept;
    std::vector<bool> told;  // by object: whether it is seen, by what `update` has returned
    CameraView view = random.view();
    for (int frame = 0; frame < 400; ++frame) {
        const float choice = objects.size() < 100 ? 0.9F : random.number(0.0F, 1.0F);
        const auto any =
            static_cast<std::uint32_t>(random.number(0.0F, 0.999F) * static_cast<float>(objects.size()));
        if (choice < 0.3F) view = random.view();
        if (choice > 0.2F && choice < 0.8F) objects.move(any);
        if (choice > 0.8F) objects.add();
        if (choice > 0.95F && objects.size() > 1) objects.remove(any);
        objects.build_if_worn();

        told.resize(std::max<std::size_t>(told.size(), objects.size()));
        for (const std::uint32_t i : kept.update(objects.top, objects.size(), view.clip_from_world)) {
            told[i] = !told[i];
        }
        std::size_t missed = 0, needless = 0, untold = 0;
        for (std::size_t i = objects.size(); i < told.size(); ++i) untold += told[i] ? 1 : 0;
        for (std::uint32_t i = 0; i < objects.size(); ++i) {
            const auto& triangles = objects.triangles(i);
            missed += !kept.sees(i) && has_corner_in_view(triangles, view.clip_from_world) ? 1 : 0;
            needless += kept.sees(i) && is_surely_outside(triangles, view.clip_from_world) ? 1 : 0;
            untold += told[i] != kept.sees(i) ? 1 : 0;
        }
        CHECK(missed == 0);
        CHECK(needless == 0);
        CHECK(untold == 0);
    }
    CHECK(objects.built < 40);  // in most frames the view had to follow what came, went and moved
}

}  // TEST_SUITE("view cull")
