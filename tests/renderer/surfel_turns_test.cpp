// While a picture is refined, the next set of surfels is made a part at a time, and takes its turn when it is
// complete.

#include <doctest/doctest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "renderer/passes/view/refinement.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("surfel turns") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};

Configuration refining() {
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 48;
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
    configuration.shadows.cube_resolution = 32;
    configuration.refinement = {.enabled = true, .frames = 64};
    return configuration;
}

class SurfelTurns : public RenderFixture {
 protected:
    /// One renderer makes its sets in parts, the other, `at_once_`, each in a frame.
    void configure_both(Configuration configuration) {
        configuration.vpls.updates = 1 << 16;  // more than there are, so that nothing waits for its light
        configure(configuration);
        configuration.vpls.updates = 0;
        REQUIRE(at_once_.configure(configuration).empty());
    }

    Picture at_once() {
        at_once_.render(scene_.world, scene_.camera, target_.target());
        return target_.read();
    }

    /// Whether the graph of the last frame has the pass.
    [[nodiscard]] bool has(std::string_view pass) const {
        const auto& passes = renderer.last_passes();
        return std::ranges::find(passes, pass, &PassRecord::name) != passes.end();
    }

    void move(Entity entity) {
        scene_.world.edit<Transform>(entity, [](Transform& pose) { pose.translation.x += 0.125F; });
    }

    Scene scene_ = cornell_box();
    TestedRenderer at_once_{context->get_proc()};
    RenderTarget target_{device, size};
};

}  // namespace

TEST_CASE_FIXTURE(SurfelTurns, "pictures are those of sets that are made at once, in the same frames") {
    Configuration configuration = refining();
    SUBCASE("depth maps") {}
    SUBCASE("rays") {
        configuration.visibility.method = VplVisibility::rays;
    }
    configure_both(configuration);
    for (std::uint32_t frame = 0; frame < 3 * frames_a_surfel_set + 2; ++frame) {
        CAPTURE(frame);
        CHECK(render(scene_, size) == at_once());
        CHECK(renderer.report().refined == frame + 1);
    }
}

TEST_CASE_FIXTURE(SurfelTurns, "a set is made in parts of equal size, and none at once") {
    configure_both(refining());
    static_cast<void>(render(scene_, size));
    CHECK(ran("vpl-maps"));
    std::uint32_t parts = 0;
    for (std::uint32_t set = 1; set < 2 * frames_a_surfel_set; ++set) {
        CAPTURE(set);
        static_cast<void>(render(scene_, size));
        CHECK_FALSE(ran("surfel-visibility"));
        // When a set takes its turn, the pass only finds that all its maps are there.
        CHECK(ran("vpl-maps") == (set == frames_a_surfel_set));
        parts += ran("vpl-maps (next set)") ? 1 : 0;
        CHECK(ran("vpl-maps (next set)") == ran("surfel-visibility (next set)"));
    }
    // One set from frame 1 on, the next one from that in which the first one takes its turn.
    CHECK(parts == 2 * (frames_a_surfel_set - 1));
}

TEST_CASE_FIXTURE(SurfelTurns,
                  "a set that is too large for so few frames takes its turn when it is complete") {
    Configuration configuration = refining();
    configuration.vpls.count = 3000;
    configuration.visibility.map_resolution = 8;
    configure_both(configuration);
    static_cast<void>(render(scene_, size));
    std::uint32_t parts = 0;
    do {
        static_cast<void>(render(scene_, size));
        CHECK(ran("vpl-maps (next set)"));
        ++parts;
    } while (!ran("vpl-maps") && parts < 100);
    // The last frame already makes a part of the set after it. A part has at most 256 surfels.
    CHECK(parts - 1 >= 3000 / 256);
    CHECK(parts - 1 <= 3500 / 256);
}

TEST_CASE_FIXTURE(SurfelTurns,
                  "whenever something moves, no frame makes a set, and the light is that of the last one") {
    configure_both(refining());
    static_cast<void>(render(scene_, size));
    std::uint32_t sets = 0;  // that have taken their turn
    for (std::uint32_t frames = 1; frames < 2 * frames_a_surfel_set + 2; frames += 3) {
        CAPTURE(frames);
        for (std::uint32_t frame = 0; frame < frames; ++frame) static_cast<void>(render(scene_, size));
        sets += frames / frames_a_surfel_set;
        Configuration of_set = refining();
        of_set.refinement.enabled = false;
        of_set.vpls.seed += sets;
        REQUIRE(at_once_.configure(of_set).empty());
        for (int step = 0; step < 2; ++step) {
            move(frames % 2 == 0 ? scene_.light : scene_.camera);
            at_once_.invalidate();
            CHECK(render(scene_, size) == at_once());
            CHECK_FALSE(ran("surfel-visibility"));
            CHECK_FALSE(ran("vpl-maps"));
            CHECK_FALSE(has("vpl-maps (next set)"));
        }
    }
    CHECK(sets > 2);
}

TEST_CASE_FIXTURE(SurfelTurns, "an object that moves is in the set that lights it, and in the next one") {
    configure_both(refining());
    const Entity object =
        add(scene_.world, at({0.2F, 0.4F, 0.3F}), MeshInstance{square(0.2F, diffuse(glm::vec3(0.7F)))});
    for (std::uint32_t frames = 1; frames < 2 * frames_a_surfel_set + 2; frames += 4) {
        CAPTURE(frames);
        move(object);
        for (std::uint32_t frame = 0; frame < frames; ++frame) CHECK(render(scene_, size) == at_once());
    }
}

TEST_CASE_FIXTURE(SurfelTurns, "memory does not grow with the sets") {
    configure_both(refining());
    const auto after = [&](std::uint32_t frames) {
        for (std::uint32_t frame = 0; frame < frames; ++frame) static_cast<void>(render(scene_, size));
        return renderer.report().memory;
    };
    // Both places have had a set by then.
    const MemoryUse early = after(2 * frames_a_surfel_set + 1);
    const MemoryUse late = after(6 * frames_a_surfel_set);
    // A buffer grows by half if a set has more points than all before it.
    CHECK(late.buffer_bytes <= early.buffer_bytes * 3 / 2);
    CHECK(late.texture_bytes == early.texture_bytes);
}

}  // TEST_SUITE("surfel turns")
