#include <doctest/doctest.h>

#include "sandbox/headless/headless.hpp"

namespace candela::sandbox {

TEST_SUITE("whole picture") {

namespace {

constexpr glm::ivec2 size(48, 36);

/// The picture that is written after some frames of a moving light under this budget.
std::vector<glm::vec3> written(float budget_ms) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    Scene scene = load_scene(shipped_file("scenes", "cornell.gltf"));
    const Entity camera = choose_camera(scene.world, std::nullopt, 4.0F / 3.0F);
    const Entity light = std::get<0>(*scene.world.view<PointLight>().begin());
    Renderer renderer(context->get_proc());
    Configuration configuration;
    configuration.vpls.count = 16;
    configuration.frame_budget_ms = budget_ms;
    REQUIRE(renderer.configure(configuration).empty());
    tools::Capture capture(renderer, context->get_proc(), size);
    for (int frame = 0; frame < 4; ++frame) {
        scene.world.edit<Transform>(light, [](Transform& pose) { pose.translation.x += 0.05F; });
        tools::CaptureReport ignored;
        static_cast<void>(capture.render(scene.world, camera, 1, ignored));
    }
    CHECK((renderer.quality().scale < 1.0F) == (budget_ms > 0.0F));
    return whole_picture(renderer, capture, scene.world, camera, 1).pixels;
}

}  // namespace

TEST_CASE("written pictures have full quality, however small the frame budget is") {
    const std::vector<glm::vec3> whole = written(0.0F);
    CHECK(whole.size() == 48 * 36);
    CHECK(written(0.001F) == whole);
}

TEST_CASE("a capture that is not to go on is the mean of the samples until then") {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    Scene scene = load_scene(shipped_file("scenes", "cornell.gltf"));
    const Entity camera = choose_camera(scene.world, std::nullopt, 4.0F / 3.0F);
    Renderer renderer(context->get_proc());
    Configuration configuration;
    configuration.vpls.count = 16;
    tools::CaptureReport ignored;
    SUBCASE("each with its place in the pixel") {
        configuration.refinement.enabled = false;
    }
    SUBCASE("as the renderer refines it") {
        configuration.refinement.enabled = true;
    }
    REQUIRE(renderer.configure(configuration).empty());
    tools::Capture capture(renderer, context->get_proc(), size);
    int left = 2;
    const tools::Picture stopped =
        capture.render(scene.world, camera, 1'000, ignored, [&] { return --left > 0; });
    CHECK(stopped.size == size);
    // The first two of an even number of samples are as far from the centre as both of two.
    renderer.invalidate();
    CHECK(capture.render(scene.world, camera, 2, ignored).pixels == stopped.pixels);
}
}  // TEST_SUITE("whole picture")

}  // namespace candela::sandbox
