#include "sandbox/animation/playback.hpp"

#include <doctest/doctest.h>

#include <candela/scene/components.hpp>

namespace candela::sandbox {

TEST_SUITE("playback") {

namespace {

/// A lamp whose height in metres is the frame number.
class Played {
 public:
    explicit Played(bool loop) : lamp_(make_lamp()), animation_(make_script(loop), world_) {}

    /// Advances the playback; returns the frame that the window shows.
    float advance() {
        playback.advance(world_);
        return height();
    }
    [[nodiscard]] float height() const { return world_.get<Transform>(lamp_).translation.y; }
    void drag(float height) { world_.set(lamp_, Transform{.translation = {0.0F, height, 0.0F}}); }

 private:
    Entity make_lamp() {
        const Entity lamp = world_.create();
        world_.set(lamp, Name{"lamp"});
        return lamp;
    }
    static Script make_script(bool loop) {
        Script script;
        script.frames = 4;
        script.loop = loop;
        script.tracks = {{.node = "lamp", .translation = {{0, {0.0F, 0.0F, 0.0F}}, {4, {0.0F, 4.0F, 0.0F}}}}};
        return script;
    }

    World world_;
    Entity lamp_;
    Animation animation_;

 public:
    Playback playback{animation_};
};

}  // namespace

TEST_CASE("it advances one frame at a time, and pauses at the end") {
    Played played(false);
    for (const float frame : {0.0F, 1.0F, 2.0F, 3.0F}) {
        CHECK(played.playback.playing());
        CHECK(played.advance() == frame);
    }
    CHECK(played.advance() == 3.0F);
    CHECK_FALSE(played.playback.playing());
    CHECK(played.advance() == 3.0F);
}

TEST_CASE("a loop continues at the start") {
    Played played(true);
    for (int frame = 0; frame < 11; ++frame) CHECK(played.advance() == static_cast<float>(frame % 4));
    CHECK(played.playback.playing());
}

TEST_CASE("after a pause it continues where it was paused") {
    Played played(false);
    static_cast<void>(played.advance());
    static_cast<void>(played.advance());
    played.playback.toggle();
    CHECK(played.advance() == 1.0F);
    CHECK(played.advance() == 1.0F);
    played.playback.toggle();
    CHECK(played.advance() == 2.0F);
}

TEST_CASE("playing again after the end starts over") {
    Played played(false);
    for (int frame = 0; frame < 5; ++frame) static_cast<void>(played.advance());
    played.playback.toggle();
    CHECK(played.advance() == 0.0F);
    CHECK(played.advance() == 1.0F);
}

TEST_CASE("steps and jumps pause, and are shown in the next frame") {
    Played played(false);
    static_cast<void>(played.advance());
    played.playback.step();
    CHECK_FALSE(played.playback.playing());
    CHECK(played.advance() == 1.0F);
    played.playback.seek(3);
    CHECK(played.advance() == 3.0F);
    played.playback.step();
    CHECK(played.advance() == 0.0F);
    played.playback.seek(2);
    CHECK(played.advance() == 2.0F);
    CHECK(played.advance() == 2.0F);
}

TEST_CASE("a dragged light keeps its place only while the script is paused") {
    Played played(false);
    static_cast<void>(played.advance());
    played.drag(9.0F);
    CHECK(played.advance() == 1.0F);
    played.playback.toggle();
    played.drag(9.0F);
    CHECK(played.advance() == 9.0F);
    played.playback.toggle();
    CHECK(played.advance() == 2.0F);
    played.playback.toggle();
    played.drag(9.0F);
    played.playback.seek(2);
    CHECK(played.advance() == 2.0F);
}
}  // TEST_SUITE("playback")

}  // namespace candela::sandbox
