// Frames that the host does not want any more before they are complete.

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <candela/scene/components.hpp>
#include "renderer/facade/device_of.hpp"
#include "shaders/bindings.glsl"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("abandoned frames") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};

class AbandonedFrames : public RenderFixture {
 protected:
    /// Both renderers take this configuration.
    void configure_both(const Configuration& configuration) {
        configure(configuration);
        REQUIRE(patient.configure(configuration).empty());
    }

    /// Abandons a frame when it is asked for after this many times: before a pass, or between parts of one.
    /// Returns whether it was complete before that.
    bool abandon(int times) {
        const RenderView view{.camera = scene.camera, .target = target.target()};
        return renderer.render(scene.world, {&view, 1}, {.wanted = [&times] { return times-- > 0; }});
    }

    Picture complete() {
        const RenderView view{.camera = scene.camera, .target = target.target()};
        CHECK(renderer.render(scene.world, {&view, 1}));
        return target.read();
    }

    /// A frame of the renderer that never abandons any.
    Picture expected() {
        patient.render(scene.world, scene.camera, other_target.target());
        return other_target.read();
    }

    [[nodiscard]] int passes_run() const {
        return static_cast<int>(std::ranges::count_if(renderer.last_passes(), &PassRecord::ran));
    }

    /// Something else for each number: the light, an object, the camera, or nothing.
    void change(int number) {
        const float step = number / 4 % 2 == 0 ? 0.05F : -0.05F;
        const auto move = [&](Entity entity) {
            scene.world.edit<Transform>(entity, [&](Transform& pose) { pose.translation.x += step; });
        };
        switch (number % 4) {
            case 0:
                return move(scene.light);
            case 1:
                return move(object);
            case 2:
                return move(scene.camera);
            default:
                return;
        }
    }

    Scene scene = cornell_box();
    Entity object =
        add(scene.world, at({0.2F, 0.4F, 0.3F}), MeshInstance{square(0.2F, diffuse(glm::vec3(0.7F)))});
    TestedRenderer patient{context->get_proc()};
    RenderTarget target{device, size};
    RenderTarget other_target{device, size};
};

Configuration small_configuration() {
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 48;
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
    return configuration;
}

}  // namespace

TEST_CASE_FIXTURE(AbandonedFrames, "a frame that is abandoned after any pass goes on in the next call") {
    configure_both(small_configuration());
    CHECK(complete() == expected());
    int passes = 0;
    for (int kind = 0; kind < 4; ++kind) {
        CAPTURE(kind);
        for (bool ended = false; !ended; ++passes) {
            const int after = passes;
            CAPTURE(after);
            change(kind + 4 * (after % 2));
            const Picture before = target.read();
            ended = abandon(after);
            if (!ended) {
                CHECK(passes_run() <= after);
                CHECK(target.read() == before);
                CHECK_FALSE(renderer.settled());
            }
            CHECK(complete() == expected());
            CHECK(renderer.settled());
        }
        CHECK(passes > 1);
        passes = 0;
    }
}

TEST_CASE_FIXTURE(AbandonedFrames, "the host is also asked between rows of blocks of pixels, or of points") {
    configure_both(small_configuration());
    const RenderTarget tall(device, {16, 3 * PIXEL_BLOCK});
    const RenderView view{.camera = scene.camera, .target = tall.target()};
    int asked = 0;
    const auto count = [&] {
        asked = 0;
        CHECK(renderer.render(scene.world, {&view, 1}, {.wanted = [&asked] { return ++asked > 0; }}));
        return asked - passes_run();
    };
    // Deferred shading; so few VPLs are not gathered before. And the points of surfels, in five to eight
    // parts, which are of as many groups of points each.
    const int parts = count() - 3;
    CHECK(parts >= 5);
    CHECK(parts <= 8);
    change(2);
    CHECK(count() == 3);  // the camera leaves the surfels' light as it is
}

TEST_CASE_FIXTURE(AbandonedFrames, "what changes before the frame goes on is in its picture") {
    configure_both(small_configuration());
    static_cast<void>(complete());
    int number = 0;
    for (int passes = 0; passes < 40; passes += 3) {
        CAPTURE(passes);
        change(number++);
        static_cast<void>(abandon(passes));
        change(number++);
        static_cast<void>(abandon(passes / 2));
        change(number++);
        CHECK(complete() == expected());
    }
}

TEST_CASE_FIXTURE(AbandonedFrames, "refinement and waiting surfels go on as if nothing had been abandoned") {
    Configuration configuration = small_configuration();
    configuration.refinement = {.enabled = true, .frames = 12};
    configuration.vpls.updates = 16;
    configure_both(configuration);
    CHECK(complete() == expected());
    for (int passes = 0; passes < 30; ++passes) {
        CAPTURE(passes);
        if (passes % 10 == 0) change(passes / 10);
        for (const int after : {passes, 2}) {
            if (abandon(after)) static_cast<void>(expected());
        }
        CHECK(complete() == expected());
        CHECK(renderer.report().refined == patient.report().refined);
        CHECK(renderer.settled() == patient.settled());
    }
}

TEST_CASE_FIXTURE(AbandonedFrames,
                  "each view is as it was or complete, and times are those of complete frames") {
    configure_both(small_configuration());
    const std::vector<RenderView> views{{.camera = scene.camera, .target = target.target()},
                                        {.camera = scene.camera, .target = other_target.target()}};
    renderer.render(scene.world, views);
    static_cast<void>(renderer.take_frames(true));
    const Picture old = target.read();
    change(0);
    std::vector<Picture> firsts;
    std::vector<Picture> seconds;
    int abandoned = 0;
    for (bool ended = false; !ended;) {
        int passes = abandoned;  // what writes a target runs in each call
        ended = renderer.render(scene.world, views, {.wanted = [&passes] { return passes-- > 0; }});
        abandoned += ended ? 0 : 1;
        firsts.push_back(target.read());
        seconds.push_back(other_target.read());
    }
    CHECK(abandoned > 5);
    const Picture now = firsts.back();
    CHECK(now != old);
    CHECK(seconds.back() == now);
    for (const std::vector<Picture>& pictures : {firsts, seconds}) {
        CHECK(std::ranges::all_of(pictures,
                                  [&](const Picture& picture) { return picture == old || picture == now; }));
    }
    CHECK(seconds.front() == old);
    CHECK(renderer.take_frames(true).size() == 1);
    const RenderTarget usual(device, size);
    patient.render(scene.world, scene.camera, usual.target());
    CHECK(now == usual.read());
}

TEST_CASE_FIXTURE(AbandonedFrames, "another configuration after an abandoned frame gives its usual picture") {
    Configuration configuration = small_configuration();
    configuration.refinement = {.enabled = true, .frames = 12};
    for (int passes = 0; passes < 20; ++passes) {
        CAPTURE(passes);
        configuration.tone_map.exposure_ev = static_cast<float>(passes % 3);
        configure_both(configuration);
        static_cast<void>(complete());
        static_cast<void>(complete());
        static_cast<void>(abandon(passes));
        configuration.path = passes % 2 == 0 ? ShadingPath::forward : ShadingPath::deferred;
        configure_both(configuration);
        renderer.invalidate();  // both start over
        patient.invalidate();
        CHECK(complete() == expected());
    }
}

}  // TEST_SUITE("abandoned frames")
