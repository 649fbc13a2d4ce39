#include "sandbox/animation/drag_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <candela/scene/components.hpp>
#include "sandbox/animation/animation_script.hpp"
#include "sandbox/animation/script_writer.hpp"
#include "tests/seed.hpp"

namespace candela::sandbox {

TEST_SUITE("drag recorder") {

namespace {

/// A lamp below a parent, which is not moved.
struct Room {
    World world;
    Entity parent = world.create();
    Entity lamp = world.create();
    Room() {
        world.set(parent, Name{"parent"});
        world.set(parent, Transform{.translation = {5.0F, 0.0F, 0.0F}, .scale = glm::vec3(3.0F)});
        world.set(lamp, Name{"lamp"});
        world.set(lamp, Transform{.parent = parent});
        world.set(lamp, PointLight{});
    }
    void move(glm::vec3 to) {
        world.edit<Transform>(lamp, [&](Transform& transform) { transform.translation = to; });
    }
};

/// The script as the app plays it: written, read, and applied to a scene in which the lamp has not moved.
class Played {
 public:
    explicit Played(const DragRecorder& recorder)
        : animation_(read_script(write_script(recorder.finish())), room_.world) {}

    [[nodiscard]] int frames() const { return animation_.script().frames; }
    [[nodiscard]] const Track& track() const { return animation_.script().tracks.at(0); }
    const Transform& transform(int frame) {
        animation_.apply(room_.world, frame);
        return room_.world.get<Transform>(room_.lamp);
    }
    const PointLight& light(int frame) {
        animation_.apply(room_.world, frame);
        return room_.world.get<PointLight>(room_.lamp);
    }

 private:
    Room room_;
    Animation animation_;
};

std::string error_of_recording(const World& world, Entity entity) {
    try {
        const DragRecorder recorder(world, entity);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "none";
}

// Rounding of positions of a few metres, and of the angles between unit quaternions.
constexpr float rounding = 1e-5F;

}  // namespace

TEST_CASE("the script moves the lamp as it was moved, in every frame") {
    Room room;
    DragRecorder recorder(room.world, room.lamp);
    const auto at = [](double seconds) {
        return glm::vec3(std::sin(0.5 * seconds), 0.2 * seconds * seconds, std::cos(0.7 * seconds));
    };
    constexpr int records = 240;  // of a window with 120 frames per second, four of them per frame
    for (int i = 0; i <= records; ++i) {
        room.move(at(i / 120.0));
        recorder.record(room.world, 1000.0 + i / 120.0);
    }
    Played played(recorder);
    CHECK(played.frames() == 61);
    for (int frame = 0; frame < played.frames(); ++frame) {
        const Transform& transform = played.transform(frame);
        CHECK(glm::distance(transform.translation, at(frame / 30.0)) <
              DragRecorder::Tolerance().distance + rounding);
        CHECK(transform.parent == room.parent);
    }
    CHECK(played.track().translation.size() < 61);
    CHECK(played.track().rotation.empty());
    CHECK(played.track().intensity.empty());
}

TEST_CASE("steady motion needs two keys, a bend a third") {
    Room room;
    DragRecorder recorder(room.world, room.lamp);
    for (int frame = 0; frame <= 60; ++frame) {
        const float forward = 0.1F * float(std::min(frame, 40));
        room.move({forward, 0.0F, 0.1F * float(std::max(frame - 40, 0))});
        recorder.record(room.world, frame / 30.0);
    }
    const Track track = recorder.finish().tracks.at(0);
    REQUIRE(track.translation.size() == 3);
    CHECK(track.translation[0] == Key<glm::vec3>{0, {0, 0, 0}});
    CHECK(track.translation[1].frame == 40);
    CHECK(track.translation[2].frame == 60);
}

TEST_CASE("rotation, scale and light are recorded") {
    Room room;
    DragRecorder recorder(room.world, room.lamp);
    const auto turned = [](int frame) {
        return glm::angleAxis(0.004F * float(frame * frame), glm::vec3(0.0F, 1.0F, 0.0F));
    };
    const auto strength = [](int frame) { return 1000.0F * std::exp(-0.1F * float(frame)); };
    for (int frame = 0; frame <= 50; ++frame) {
        room.world.edit<Transform>(room.lamp, [&](Transform& transform) {
            transform.rotation = turned(frame);
            transform.scale = glm::vec3(1.0F, 2.0F, 1.0F + 0.1F * float(frame));
        });
        room.world.set(room.lamp, PointLight{.colour = {1.0F, 0.02F * float(frame), 0.0F},
                                             .intensity = strength(frame)});
        recorder.record(room.world, frame / 30.0);
    }
    Played played(recorder);
    const DragRecorder::Tolerance tolerance;
    for (int frame = 0; frame <= 50; ++frame) {
        const Transform& transform = played.transform(frame);
        // The chord of half the angle between unit quaternions.
        const float chord = glm::length(transform.rotation - turned(frame));
        CHECK(2.0F * chord < tolerance.angle + rounding);
        CHECK(std::abs(transform.scale.z - 1.0F - 0.1F * float(frame)) < tolerance.part * 6.4F + rounding);
        CHECK(std::abs(played.light(frame).intensity - strength(frame)) < tolerance.part * 1000.0F + 1e-3F);
        CHECK(std::abs(played.light(frame).colour.g - 0.02F * float(frame)) < 1.5F * tolerance.part);
    }
    CHECK(played.track().translation.empty());
    CHECK(played.track().intensity.size() > 3);
    CHECK(played.track().intensity.size() < 50);
}

TEST_CASE("the lamp waits where it waited, and moves slowly where records are rare") {
    Room room;
    DragRecorder recorder(room.world, room.lamp);
    recorder.record(room.world, 0.0);
    room.move({1.0F, 0.0F, 0.0F});
    recorder.record(room.world, 2.0);  // nothing came for two seconds: it stood still
    room.move({2.0F, 0.0F, 0.0F});
    recorder.record(room.world, 2.2);  // a slow window: it moved all the time
    Played played(recorder);
    CHECK(played.frames() == 67);
    CHECK(played.transform(59).translation.x == 0.0F);
    CHECK(played.transform(60).translation.x == doctest::Approx(1.0F));
    CHECK(played.transform(63).translation.x == doctest::Approx(1.5F));
    CHECK(played.transform(66).translation.x == doctest::Approx(2.0F));
}

TEST_CASE("random walks are kept, whatever the tolerance and the times" * doctest::test_suite("random")) {
    std::mt19937 random(test_seed(17));
    std::uniform_real_distribution<float> step(-0.02F, 0.02F);
    for (const float distance : {0.0F, 1e-3F, 0.05F}) {
        Room room;
        DragRecorder recorder(room.world, room.lamp, {.distance = distance});
        std::vector<glm::vec3> walk{glm::vec3(0.0F)};
        for (int frame = 0; frame < 300; ++frame) {
            recorder.record(room.world, -5.0 + frame / 30.0);
            if (frame % 3 == 0) recorder.record(room.world, -100.0);  // a clock that is set back
            walk.push_back(walk.back() + glm::vec3(step(random), step(random), step(random)));
            room.move(walk.back());
        }
        Played played(recorder);
        REQUIRE(played.frames() == 300);
        float farthest = 0.0F;
        for (int frame = 0; frame < 300; ++frame) {
            farthest = std::max(farthest, glm::distance(played.transform(frame).translation,
                                                        walk[static_cast<std::size_t>(frame)]));
        }
        CHECK(farthest <= distance + rounding);
    }
}

TEST_CASE("without motion or records the script is valid and animates nothing") {
    Room room;
    const DragRecorder none(room.world, room.lamp);
    DragRecorder still(room.world, room.lamp);
    still.record(room.world, 0.0);
    still.record(room.world, 1.0);
    for (const DragRecorder& recorder : {none, still}) {
        const Script script = read_script(write_script(recorder.finish()));
        REQUIRE(script.tracks.size() == 1);
        CHECK(script.tracks[0].translation.empty());
    }
}

TEST_CASE("what a script could not name is not recorded") {
    Room room;
    CHECK(error_of_recording(room.world, room.lamp) == "none");
    room.world.set(room.parent, Name{"lamp"});
    CHECK(error_of_recording(room.world, room.lamp) ==
          "'lamp' is the name of 2 objects: a script could not tell which of them moves");
    room.world.set(room.lamp, Name{""});
    CHECK(error_of_recording(room.world, room.lamp) ==
          "entity \"\" has no name: a script could not name what moves");
    room.world.remove<Name>(room.lamp);
    CHECK(error_of_recording(room.world, room.lamp) ==
          "entity 1 has no name: a script could not name what moves");
}
}  // TEST_SUITE("drag recorder")

}  // namespace candela::sandbox
