// With a limit on what is traced in a frame: no frame traces more, what waits is traced in the next frames,
// and then all is as if it had been traced at once.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("surfel updates") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};

class SurfelUpdates : public RenderFixture {
 protected:
    SurfelUpdates() {
        for (const auto& [entity, name] : scene_.world.view<Name>()) {
            if (name.value == "tall block") block_ = entity;
        }
        configuration_.show = Show::indirect;
        configuration_.vpls = {
            .placement = VplPlacement::surfels, .count = 32, .updates = 5, .guided = false};
        configuration_.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
        configuration_.shadows.cube_resolution = 32;
    }

    void move_block(float by) {
        scene_.world.edit<Transform>(block_, [&](Transform& pose) { pose.translation.x += by; });
    }

    std::uint32_t waiting() { return renderer.report().vpls->waiting; }

    /// Frames until nothing waits, of which the first one shows what has changed.
    std::vector<Picture> frames_until_settled() {
        std::vector<Picture> frames;
        do {
            frames.push_back(render(scene_, size));
            REQUIRE(frames.size() < 1000);
            CHECK(renderer.settled() == (waiting() == 0));
        } while (!renderer.settled());
        return frames;
    }

    Scene scene_ = cornell_box();
    Entity block_;
    Configuration configuration_ = linear_configuration();
};

}  // namespace

TEST_CASE_FIXTURE(SurfelUpdates, "each frame traces as many surfels as it may, until none waits") {
    configure(configuration_);
    static_cast<void>(render(scene_, size));
    std::uint32_t before = waiting();
    CHECK(before + configuration_.vpls.updates >= configuration_.vpls.count);
    while (before > 0) {
        static_cast<void>(render(scene_, size));
        CHECK(waiting() == before - std::min(before, configuration_.vpls.updates));
        before = waiting();
    }
    CHECK(render(scene_, size) == from_scratch(scene_, size));
    CHECK_FALSE(ran("surfel-visibility"));
    CHECK_FALSE(ran("vpl-maps"));
}

TEST_CASE_FIXTURE(SurfelUpdates, "a limit that nothing reaches changes no frame") {
    configuration_.vpls.updates = 1000;
    configure(configuration_);
    for (int step = 0; step < 3; ++step) {
        CHECK(render(scene_, size) == from_scratch(scene_, size));
        CHECK(renderer.settled());
        move_block(-0.1F);
    }
}

TEST_CASE_FIXTURE(SurfelUpdates, "after a movement the picture becomes that of a new renderer") {
    for (const VplVisibility method : {VplVisibility::maps, VplVisibility::rays}) {
        CAPTURE(to_string(method));
        configuration_.visibility.method = method;
        configure(configuration_);
        static_cast<void>(settled_picture(scene_, size));
        // What waits is overtaken by the next movement.
        for (int step = 0; step < 4; ++step) {
            move_block(0.07F);
            static_cast<void>(render(scene_, size));
            CHECK_FALSE(renderer.settled());
        }
        CHECK(frames_until_settled().back() == from_scratch(scene_, size));
    }
}

// Meanwhile, others have been traced that saw it elsewhere.
TEST_CASE_FIXTURE(SurfelUpdates, "what moves away and comes back is traced again") {
    configure(configuration_);
    static_cast<void>(settled_picture(scene_, size));
    const Transform before = scene_.world.get<Transform>(block_);
    move_block(0.3F);
    for (int frame = 0; frame < 3; ++frame) static_cast<void>(render(scene_, size));
    CHECK_FALSE(renderer.settled());
    scene_.world.set(block_, before);
    CHECK(frames_until_settled().back() == from_scratch(scene_, size));
}

// With one bounce, the light of a surfel does not depend on others. Those that wait send none, and the
// others as much as in the end: light only grows, and in no pixel above that of the whole.
TEST_CASE_FIXTURE(SurfelUpdates, "in the first frames, surfels that were not traced send no light") {
    configuration_.vpls.bounces = 1;
    configure(configuration_);
    const std::vector<Picture> frames = frames_until_settled();
    CHECK(frames.size() * configuration_.vpls.updates >= configuration_.vpls.count);
    // Of sums in another order.
    constexpr float rounding = 1e-5F;
    for (std::size_t i = 1; i < frames.size(); ++i) {
        for (std::size_t p = 0; p < frames[i].pixels.size(); ++p) {
            const glm::vec3 less = frames[i - 1].pixels[p] - frames[i].pixels[p];
            CHECK(std::max({less.r, less.g, less.b}) < rounding);
        }
    }
    CHECK(mean(frames.front()) < 0.9 * mean(frames.back()));
    CHECK(frames.back() == from_scratch(scene_, size));
}

TEST_CASE_FIXTURE(SurfelUpdates, "what moves all the time keeps its light, and all get their turn") {
    configure(configuration_);
    const double settled = mean(settled_picture(scene_, size));
    for (int step = 0; step < 40; ++step) {
        move_block(step % 2 == 0 ? 0.01F : -0.01F);
        // No surfel goes dark while it waits. A tenth: far more than the step changes.
        CHECK(mean(render(scene_, size)) == doctest::Approx(settled).epsilon(0.1));
    }
    CHECK(frames_until_settled().back() == from_scratch(scene_, size));
}

TEST_CASE_FIXTURE(SurfelUpdates, "frames are averaged once nothing waits") {
    configuration_.refinement = {.enabled = true, .frames = 4};
    configure(configuration_);
    do {
        static_cast<void>(render(scene_, size));
        CHECK(renderer.report().refined == 1);
    } while (waiting() > 0);
    const Picture shown = settled_picture(scene_, size);
    CHECK(renderer.report().refined == 4);
    configuration_.vpls.updates = 0;
    TestedRenderer fresh(context->get_proc());
    REQUIRE(fresh.configure(configuration_).empty());
    const RenderTarget target(device, size);
    do fresh.render(scene_.world, scene_.camera, target.target());
    while (!fresh.settled());
    CHECK(shown == target.read());
}

}  // TEST_SUITE("surfel updates")
