// Clips of files, as the app plays them.

#include "sandbox/animation/clips.hpp"

#include <doctest/doctest.h>

#include <memory>

#include <candela/scene/components.hpp>
#include <candela/scene/scene_error.hpp>
#include "tests/throws.hpp"

namespace candela::sandbox {

TEST_SUITE("clips") {

namespace {

/// Moves along x by 1 m/s for two seconds.
std::shared_ptr<const AnimationClip> straight(const char* name) {
    AnimationClip clip;
    clip.name = name;
    clip.duration = 2.0F;
    clip.samplers = {{.interpolation = candela::Interpolation::linear,
                      .times = std::make_shared<const std::vector<float>>(std::vector{0.0F, 2.0F}),
                      .values = std::make_shared<const std::vector<float>>(
                          std::vector{0.0F, 0.0F, 0.0F, 2.0F, 0.0F, 0.0F})}};
    clip.channels = {{.target = 0, .property = AnimatedProperty::translation, .sampler = 0}};
    return std::make_shared<const AnimationClip>(std::move(clip));
}

struct Played {
    World world;
    Entity moved = world.create();
    Entity player = world.create();
    ClipPlayback playback;

    Played() {
        world.set(moved, Transform{});
        AnimationPlayer component;
        component.animations =
            std::make_shared<const Animations>(Animations{{straight("walk"), straight("")}, {moved}});
        world.set(player, std::move(component));
    }
    [[nodiscard]] float x() const { return world.get<Transform>(moved).translation.x; }
    [[nodiscard]] const AnimationPlayer& state() const { return world.get<AnimationPlayer>(player); }
    template <class Change>
    void change(Change change) {
        world.edit<AnimationPlayer>(player, change);
    }
};

}  // namespace

TEST_CASE("a clip moves on by the seconds that pass, and starts again at its end") {
    Played played;
    played.playback.advance(played.world, 0.5);
    CHECK(played.x() == 0.5F);
    played.playback.advance(played.world, 2.0);
    CHECK(played.x() == 0.5F);
    CHECK(plays_clips(played.world));
    CHECK(played.playback.faults().empty());
}

TEST_CASE("paused it stays, and another edit stays with it, and resumed it goes on from there") {
    Played played;
    played.playback.advance(played.world, 0.5);
    toggle_clips(played.world);
    CHECK_FALSE(plays_clips(played.world));
    played.world.set(played.moved, Transform{.translation = {7.0F, 0.0F, 0.0F}});
    played.playback.advance(played.world, 1.0);
    CHECK(played.x() == 7.0F);
    toggle_clips(played.world);
    played.playback.advance(played.world, 0.25);
    CHECK(played.x() == 0.75F);
}

TEST_CASE("a time can be sought while it is paused, and a step is one frame") {
    Played played;
    toggle_clips(played.world);
    played.playback.seek(played.world, played.player, 1.25);
    CHECK(played.x() == 1.25F);
    played.playback.step(played.world);
    CHECK(played.x() == doctest::Approx(1.25 + seconds_a_frame));
    CHECK_FALSE(plays_clips(played.world));
}

TEST_CASE("what has ended plays again from its start") {
    Played played;
    played.change([](AnimationPlayer& player) { player.looping = false; });
    played.playback.advance(played.world, 5.0);
    CHECK(played.x() == 2.0F);
    CHECK_FALSE(plays_clips(played.world));
    toggle_clips(played.world);
    played.playback.advance(played.world, 0.5);
    CHECK(played.x() == 0.5F);
}

TEST_CASE("a clip is chosen by its name or its index, and others are named in the message") {
    Played played;
    choose_clip(played.world, "1");
    CHECK(played.state().clip == 1);
    choose_clip(played.world, "walk");
    CHECK(played.state().clip == 0);
    for (const char* const wanted : {"2", "run", "-1"}) {
        CAPTURE(wanted);
        CHECK(throws<SceneError>([&] { choose_clip(played.world, wanted); },
                                 "the scene has 0 'walk', 1 'clip 1'"));
    }
    World empty;
    CHECK(throws<SceneError>([&] { choose_clip(empty, "walk"); }, "no clip 'walk'; the scene has none"));
}
}  // TEST_SUITE("clips")

}  // namespace candela::sandbox
