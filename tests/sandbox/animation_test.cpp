#include "sandbox/animation/animation.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

TEST_SUITE("animation") {

namespace {

constexpr glm::vec3 up{0.0F, 1.0F, 0.0F};

glm::quat turned(float degrees) {
    return glm::angleAxis(glm::radians(degrees), up);
}

/// The angle in degrees around +Y by which a rotation turns +X, in (-180, 180].
float heading(const glm::quat& rotation) {
    const glm::vec3 x = rotation * glm::vec3(1.0F, 0.0F, 0.0F);
    return glm::degrees(std::atan2(-x.z, x.x));
}

/// A few roundings of an angle in radians, after a sine and an arc tangent.
constexpr float degree_tolerance = 1e-3F;

Track moving(Interpolation interpolation) {
    return {.node = "lamp",
            .interpolation = interpolation,
            .translation = {{10, {1.0F, 2.0F, 3.0F}}, {20, {3.0F, 2.0F, -1.0F}}, {24, {3.0F, 0.0F, -1.0F}}}};
}

Track turning(float from, float to) {
    return {.node = "door", .rotation = {{0, turned(from)}, {10, turned(to)}}};
}

float heading_at(const Track& track, int frame) {
    return heading(*pose_at(track, frame).rotation);
}

/// A lamp on an arm, a mesh, a directional light and a camera.
struct Stage {
    World world;
    Entity arm = add("arm");
    Entity lamp = add("lamp");
    Entity sun = add("sun");
    Entity camera = add("camera");

    Stage() {
        world.set(lamp, Transform{.translation = {0.0F, 1.0F, 0.0F}, .parent = arm});
        world.set(lamp, PointLight{.intensity = 7.0F});
        world.set(sun, DirectionalLight{.illuminance = 3.0F});
        world.set(camera, Camera{});
    }

 private:
    Entity add(const char* name) {
        const Entity entity = world.create();
        world.set(entity, Name{name});
        world.set(entity, Transform{});
        return entity;
    }
};

/// Animates everything at once, each value with its own keys.
Script everything(bool loop) {
    Script script;
    script.path = "all.json";
    script.frames = 12;
    script.loop = loop;
    script.tracks = {{.node = "arm",
                      .interpolation = Interpolation::smooth,
                      .translation = {{0, {0.0F, 0.0F, 0.0F}}, {11, {1.0F, 2.0F, 3.0F}}},
                      .rotation = {{2, turned(0.0F)}, {9, turned(100.0F)}},
                      .scale = {{3, glm::vec3(1.0F)}, {4, glm::vec3(2.0F)}}},
                     {.node = "lamp",
                      .intensity = {{0, 1.0F}, {8, 5.0F}},
                      .colour = {{1, {1.0F, 0.0F, 0.0F}}, {7, {0.0F, 0.0F, 1.0F}}},
                      .enabled = {{0, true}, {4, false}, {6, true}}},
                     {.node = "sun", .enabled = {{0, false}, {5, true}}},
                     {.node = "camera",
                      .interpolation = Interpolation::step,
                      .translation = {{0, {0.0F, 0.0F, 4.0F}}, {6, {0.0F, 1.0F, 4.0F}}}}};
    return script;
}

void check_equal(const Stage& a, const Stage& b) {
    for (const Entity entity : {a.arm, a.lamp, a.sun, a.camera}) {
        CHECK(a.world.get<Transform>(entity) == b.world.get<Transform>(entity));
    }
    CHECK(a.world.get<PointLight>(a.lamp) == b.world.get<PointLight>(b.lamp));
    CHECK(a.world.get<DirectionalLight>(a.sun) == b.world.get<DirectionalLight>(b.sun));
}

std::string error_of(const std::vector<Track>& tracks, const World& world) {
    Script script;
    script.path = "some.json";
    script.tracks = tracks;
    try {
        const Animation animation(script, world);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "none";
}

}  // namespace

TEST_CASE("at a key the value is exactly that of the key, with every interpolation") {
    for (const auto interpolation : {Interpolation::linear, Interpolation::step, Interpolation::smooth}) {
        const Track track = moving(interpolation);
        for (const auto& key : track.translation) {
            CHECK(pose_at(track, key.frame).translation == key.value);
        }
    }
    const Track door = turning(0.1F, 123.4F);
    for (const auto& key : door.rotation) CHECK(pose_at(door, key.frame).rotation == key.value);
}

TEST_CASE("before the first key and after the last one a value is constant") {
    const Track track = moving(Interpolation::linear);
    for (const int frame : {0, 9, 10}) CHECK(pose_at(track, frame).translation == glm::vec3(1, 2, 3));
    for (const int frame : {24, 25, 1000000}) {
        CHECK(pose_at(track, frame).translation == glm::vec3(3, 0, -1));
    }
}

TEST_CASE("between keys values are interpolated linearly, in steps, or smoothly") {
    // The values of the keys and the fractions 1/2 and 1/4 between them are exact in binary.
    CHECK(pose_at(moving(Interpolation::linear), 15).translation == glm::vec3(2, 2, 1));
    CHECK(pose_at(moving(Interpolation::linear), 21).translation == glm::vec3(3, 1.5, -1));
    for (const int frame : {11, 15, 19}) {
        CHECK(pose_at(moving(Interpolation::step), frame).translation == glm::vec3(1, 2, 3));
    }
    // 3t² - 2t³: 1/2 at t = 1/2, 5/32 at t = 1/4.
    CHECK(pose_at(moving(Interpolation::smooth), 15).translation == glm::vec3(2, 2, 1));
    CHECK(pose_at(moving(Interpolation::smooth), 21).translation ==
          glm::vec3(3.0F, 2.0F - 2.0F * 5.0F / 32.0F, -1.0F));
}

TEST_CASE("between equal keys a value is constant, bit for bit") {
    const glm::vec3 thirds(1.0F / 3.0F, 1.6F, -0.1F);
    const Track track{.node = "lamp",
                      .translation = {{0, thirds}, {7, thirds}},
                      .rotation = {{0, turned(40.0F)}, {7, turned(40.0F)}},
                      .intensity = {{0, 0.7F}, {7, 0.7F}}};
    for (int frame = 0; frame < 7; ++frame) CHECK(pose_at(track, frame) == pose_at(track, 0));
}

TEST_CASE("values without keys are not animated") {
    CHECK(pose_at(Track{.node = "lamp"}, 3) == Pose{});
    const Pose pose = pose_at(moving(Interpolation::linear), 3);
    CHECK_FALSE((pose.rotation || pose.scale || pose.intensity || pose.colour || pose.enabled));
}

TEST_CASE("a light is switched in a step, even with smooth interpolation") {
    const Track track{.node = "lamp",
                      .interpolation = Interpolation::smooth,
                      .intensity = {{0, 0.0F}, {8, 4.0F}},
                      .enabled = {{2, false}, {6, true}}};
    CHECK(pose_at(track, 0).enabled == false);
    CHECK(pose_at(track, 5).enabled == false);
    CHECK(pose_at(track, 6).enabled == true);
    CHECK(pose_at(track, 4).intensity == 2.0F);
}

TEST_CASE("rotations have a constant speed around the axis and take the shorter way") {
    const Track ahead = turning(0.0F, 90.0F);
    for (int frame = 0; frame <= 10; ++frame) {
        CHECK(heading_at(ahead, frame) == doctest::Approx(9.0 * frame).epsilon(degree_tolerance));
        CHECK(glm::length(*pose_at(ahead, frame).rotation) == doctest::Approx(1.0).epsilon(1e-6));
    }
    // From 170 to -170 degrees is 20 degrees forwards, not 340 backwards.
    CHECK(std::abs(heading_at(turning(170.0F, 190.0F), 5)) ==
          doctest::Approx(180.0).epsilon(degree_tolerance));
    CHECK(heading_at(turning(0.0F, 270.0F), 5) == doctest::Approx(-45.0).epsilon(degree_tolerance));
}

TEST_CASE("a quaternion and its negative are interpolated as the same rotation") {
    Track track = turning(20.0F, 80.0F);
    track.rotation[1].value = -track.rotation[1].value;
    CHECK(heading_at(track, 5) == doctest::Approx(50.0).epsilon(degree_tolerance));
}

TEST_CASE("after the script's frames a run repeats the last frame, or loops") {
    Script script;
    script.frames = 4;
    for (const int frame : {0, 1, 3}) CHECK(frame_of(script, frame) == frame);
    for (const int frame : {4, 5, 400}) CHECK(frame_of(script, frame) == 3);
    script.loop = true;
    for (const int frame : {0, 1, 3}) CHECK(frame_of(script, frame) == frame);
    CHECK(frame_of(script, 4) == 0);
    CHECK(frame_of(script, 11) == 3);
}

TEST_CASE("values are written to components, and values without keys are not changed") {
    Stage stage;
    Script script = everything(false);
    script.tracks[0].translation.clear();
    script.tracks[1].translation = {{0, {0.0F, 2.0F, 0.0F}}};
    const Animation animation(script, stage.world);
    animation.apply(stage.world, 11);
    const auto& arm = stage.world.get<Transform>(stage.arm);
    CHECK(arm.translation == glm::vec3(0.0F));
    CHECK(arm.rotation == turned(100.0F));
    CHECK(arm.scale == glm::vec3(2.0F));
    const auto& lamp = stage.world.get<Transform>(stage.lamp);
    CHECK(lamp.parent == stage.arm);
    CHECK(lamp.translation == glm::vec3(0.0F, 2.0F, 0.0F));
    // The arm scales its children by 2.
    CHECK(glm::vec3(world_matrix(stage.world, stage.lamp)[3]) == glm::vec3(0.0F, 4.0F, 0.0F));
    const auto& light = stage.world.get<PointLight>(stage.lamp);
    CHECK(light == PointLight{.colour = {0.0F, 0.0F, 1.0F}, .intensity = 5.0F});
    CHECK(stage.world.get<Transform>(stage.camera).translation == glm::vec3(0.0F, 1.0F, 4.0F));
}

TEST_CASE("a light that is off emits nothing, and gets its intensity back") {
    Stage stage;
    const Animation animation(everything(false), stage.world);
    const auto lamp = [&] { return stage.world.get<PointLight>(stage.lamp).intensity; };
    const auto sun = [&] { return stage.world.get<DirectionalLight>(stage.sun).illuminance; };
    animation.apply(stage.world, 4);
    CHECK(lamp() == 0.0F);
    CHECK(sun() == 0.0F);
    animation.apply(stage.world, 6);
    CHECK(lamp() == 4.0F);  // from its keys: 1 + 4 · 6/8
    CHECK(sun() == 3.0F);   // its initial value
}

TEST_CASE("a frame is the same if it is played, jumped to, or jumped back to") {
    for (const bool loop : {false, true}) {
        Stage played;
        const Animation animation(everything(loop), played.world);
        for (int frame = 0; frame < 30; ++frame) {
            animation.apply(played.world, frame);
            Stage sought;
            animation.apply(sought.world, frame);
            check_equal(played, sought);
            Stage back;
            animation.apply(back.world, 29);
            animation.apply(back.world, frame);
            check_equal(back, sought);
        }
    }
}

TEST_CASE("a frame in which nothing moves changes no component") {
    Stage stage;
    const Animation animation(everything(false), stage.world);
    animation.apply(stage.world, 11);
    const Tick transforms = stage.world.revision<Transform>();
    const Tick lights = stage.world.revision<PointLight>();
    animation.apply(stage.world, 12);
    CHECK(stage.world.revision<Transform>() == transforms);
    CHECK(stage.world.revision<PointLight>() == lights);
    animation.apply(stage.world, 10);
    CHECK(stage.world.revision<Transform>() > transforms);
}

TEST_CASE("what is below a moving node moves, and nothing else does") {
    Stage stage;
    Track arm{.node = "arm"};
    arm.translation = {{0, {0.0F, 0.0F, 0.0F}}, {9, {1.0F, 0.0F, 0.0F}}};
    Script script;
    script.frames = 10;
    script.tracks = {arm};
    const Animation animation(script, stage.world);
    CHECK(animation.moves(stage.world, stage.arm));
    CHECK(animation.moves(stage.world, stage.lamp));
    CHECK(!animation.moves(stage.world, stage.sun));
    CHECK(!animation.moves(stage.world, stage.world.create()));
}

TEST_CASE("errors name nodes that are missing, ambiguous, or not lights") {
    Stage stage;
    CHECK(error_of({{.node = "lamp"}}, stage.world) == "none");
    CHECK(error_of({{.node = "lamp"}, {.node = "lump"}}, stage.world) ==
          "some.json: tracks[1].node: 'lump' is no node of the scene");
    CHECK(error_of({{.node = "arm", .intensity = {{0, 1.0F}}}}, stage.world) ==
          "some.json: tracks[0].intensity: 'arm' is no light");
    CHECK(error_of({{.node = "arm", .colour = {{0, up}}}}, stage.world) ==
          "some.json: tracks[0].colour: 'arm' is no light");
    CHECK(error_of({{.node = "arm", .enabled = {{0, true}}}}, stage.world) ==
          "some.json: tracks[0].enabled: 'arm' is no light");
    stage.world.set(stage.sun, Name{"lamp"});
    CHECK(error_of({{.node = "lamp"}}, stage.world) ==
          "some.json: tracks[0].node: 'lamp' is the name of 2 nodes");
}
}  // TEST_SUITE("animation")

}  // namespace candela::sandbox
