// How the quality of frames is chosen under a time budget, and the pictures that result.

#include "renderer/frame/frame_budget.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "tests/renderer/path_fixture.hpp"

using namespace candela;

namespace {

constexpr glm::uvec2 size{48, 32};

class FrameBudgetTests : public PathFixture {
 protected:
    /// Pass a budget that no frame can keep, or one that every frame keeps.
    void start(float budget_ms) {
        Configuration configuration = linear_configuration();
        configuration.frame_budget_ms = budget_ms;
        configure(configuration);
    }
    void move_camera() {
        scene.world.edit<Transform>(scene.camera, [](Transform& pose) { pose.translation.x += 0.01F; });
    }
    /// Renders frames of a moving camera until their times are known.
    Picture moving() {
        Picture picture;
        for (int i = 0; i < 3; ++i) {
            move_camera();
            picture = render(scene, size);
            static_cast<void>(renderer.take_frames(true));
        }
        return picture;
    }
    /// The same view, by a new renderer without a budget.
    Picture fresh_picture() {
        TestedRenderer fresh(context->get_proc());
        Configuration configuration = renderer.configuration();
        configuration.frame_budget_ms = 0.0F;
        REQUIRE(fresh.configure(configuration).empty());
        const RenderTarget target(device, size);
        fresh.render(scene.world, scene.camera, target.target());
        return target.read();
    }

    Scene scene = cornell_box();
};

}  // namespace

TEST_SUITE("frame budget") {
    TEST_CASE("a frame's cost is split by what it depends on") {
        const FrameReport frame{.index = 0,
                                .cpu_ms = 20.0,
                                .gpu_ms = 30.0,
                                .passes = {{"vpl-maps", true, 0.1, 5.0},
                                           {"vpl-gather", true, 0.1, 12.0},
                                           {"deferred", true, 0.1, 6.0},
                                           {"vpl-reconstruct", true, 0.1, 3.0},
                                           {"gbuffer", false, 0.0, 0.0}}};
        const FrameCost cost = cost_of(frame);
        CHECK(cost.gather == 12.0);
        CHECK(cost.pixels == 9.0);
        CHECK(cost.rest == 9.0);
    }

    TEST_CASE_FIXTURE(FrameBudgetTests, "the passes that the budget names exist in the graphs") {
        std::string graphs;
        Configuration configuration = linear_configuration();
        configuration.refinement.enabled = true;
        configuration.interleave = Interleave::eight;
        for (const ShadingPath path : all_shading_paths) {
            configuration.path = path;
            configure(configuration);
            graphs += renderer.describe(GraphFormat::json);
        }
        const RenderTarget target(device, {8, 8});
        const gl::Texture texture(device, "host's", {.size = {8, 8}, .format = Format::rgba32f});
        const RenderView view{
            .camera = scene.camera,
            .target = target.target(),
            .surfaces =
                HostSurfaces{.depth = texture.name(), .normal = texture.name(), .albedo = texture.name()}};
        renderer.render(scene.world, {&view, 1});
        graphs += renderer.describe(GraphFormat::json);
        CHECK(graphs.find("\"vpl-gather\"") != std::string::npos);
        for (const std::string_view name : pixel_passes()) {
            CHECK_MESSAGE(graphs.find(fmt::format("\"{}\"", name)) != std::string::npos, name);
        }
    }

    TEST_CASE("the predicted time scales with the pixels, and with the VPLs per pixel") {
        const FrameCost cost{.gather = 16.0, .pixels = 8.0, .rest = 5.0};
        CHECK(expected_ms(cost, {1.0F, 4}, {1.0F, 4}) == 29.0);
        CHECK(expected_ms(cost, {1.0F, 4}, {1.0F, 8}) == 5.0 + 8.0 + 4.0);
        CHECK(expected_ms(cost, {1.0F, 4}, {0.5F, 8}) == 5.0 + 2.0 + 1.0);
        CHECK(expected_ms(cost, {0.5F, 8}, {1.0F, 4}) == 5.0 + 32.0 + 256.0);
    }

    TEST_CASE("the best quality that keeps to the budget is chosen") {
        const FrameCost cost{.gather = 160.0, .pixels = 80.0, .rest = 10.0};
        const Quality whole{1.0F, 1};
        CHECK(choose_quality(cost, whole, 1, 1000.0) == whole);
        CHECK(choose_quality(cost, whole, 1, 120.0) == Quality{1.0F, 8});  // 92.5 ms
        CHECK(choose_quality(cost, whole, 1, 100.0) == Quality{0.8F, 8});  // 92.5 ms leave too little margin
        CHECK(choose_quality(cost, whole, 1, 40.0) == Quality{0.5F, 8});
        CHECK(choose_quality(cost, whole, 1, 11.0) == Quality{0.25F, 8});  // no quality does
        // If frames are interleaved anyway, more interleaving gains nothing.
        CHECK(choose_quality(cost, {1.0F, 8}, 8, 1000.0) == whole);
        CHECK(choose_quality(cost, {1.0F, 8}, 8, 150.0).scale < 1.0F);
    }

    TEST_CASE("a better quality that would be left again at once is not chosen") {
        // Judging by the cost at half the sides, 65 % would fit, but with little margin.
        const FrameCost cost{.gather = 0.0, .pixels = 48.0, .rest = 0.0};
        CHECK(expected_ms(cost, {0.5F, 8}, {0.65F, 8}) == doctest::Approx(81.12));
        CHECK(choose_quality(cost, {0.5F, 8}, 1, 100.0) == Quality{0.5F, 8});
        CHECK(choose_quality(cost, {0.5F, 8}, 1, 120.0) == Quality{0.65F, 8});
        // Once at 65 %, it stays there.
        const FrameCost there{.gather = 0.0, .pixels = 81.12, .rest = 0.0};
        CHECK(choose_quality(there, {0.65F, 8}, 1, 100.0) == Quality{0.65F, 8});
    }

    TEST_CASE("at least one pixel is rendered") {
        CHECK(rendered_size({1280, 720}, {0.375F, 8}) == glm::uvec2(480, 270));
        CHECK(rendered_size({1, 2}, {0.25F, 8}) == glm::uvec2(1, 1));
        CHECK(rendered_size({511, 513}, {}) == glm::uvec2(511, 513));
    }

    TEST_CASE_FIXTURE(FrameBudgetTests,
                      "frames have a lower quality while something moves, and full quality at rest") {
        start(1e-3F);
        const Picture coarse = moving();
        CHECK(renderer.report().rendered_size == size / 4U);
        CHECK(renderer.report().vpls->interleave == 8);
        CHECK(is_sane(coarse));
        const Picture whole = fresh_picture();
        CHECK(coarse != whole);
        CHECK(mean(coarse) == doctest::Approx(mean(whole)).epsilon(0.05));

        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        CHECK(render(scene, size) == whole);
        CHECK(renderer.report().rendered_size == size);
        move_camera();
        static_cast<void>(render(scene, size));
        CHECK(renderer.report().rendered_size == size / 4U);
    }

    TEST_CASE_FIXTURE(FrameBudgetTests, "with a large budget, or without one, every frame has full quality") {
        for (const float budget : {1e6F, 0.0F}) {
            CAPTURE(budget);
            start(budget);
            const Picture picture = moving();
            CHECK(renderer.report().rendered_size == size);
            CHECK(picture == fresh_picture());
        }
    }

    TEST_CASE_FIXTURE(FrameBudgetTests, "refinement continues at rest, at full quality") {
        start(1e-3F);
        Configuration configuration = renderer.configuration();
        configuration.refinement = {.enabled = true, .frames = 4};
        configure(configuration);
        static_cast<void>(moving());
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        for (int i = 0; i < 6; ++i) static_cast<void>(render(scene, size));
        CHECK(renderer.report().refined == 4);
        CHECK(renderer.report().rendered_size == size);
    }
}
