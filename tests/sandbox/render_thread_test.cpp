#include "sandbox/window/render_thread.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <thread>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <candela/headless_context.hpp>
#include "renderer/facade/device_of.hpp"
#include "renderer/gl/texture.hpp"
#include "sandbox/editing/light_picking.hpp"
#include "sandbox/scene/scene.hpp"
#include "sandbox/window/frame_renderer.hpp"

namespace candela::sandbox {

TEST_SUITE("render thread") {

namespace {

using namespace std::chrono_literals;

class HeadlessThreadContext : public ThreadContext {
 public:
    void make_current() override { context_->make_current(); }
    void release() override { context_.reset(); }
    [[nodiscard]] gl::GetProc functions() const override { return context_->get_proc(); }

 private:
    std::unique_ptr<HeadlessContext> context_ = HeadlessContext::create(ContextKind::egl);
};

using Texels = std::vector<glm::vec4>;

/// A render thread without a window, and small requests for the shipped Cornell box.
struct Rendering {
    Scene scene = load_scene(shipped_file("scenes", "cornell.gltf"));
    Entity camera = choose_camera(scene.world, std::nullopt, 1.0F);
    RenderThread thread{std::make_unique<HeadlessThreadContext>(), {}, [] {}};

    [[nodiscard]] FrameRequest request() const {
        FrameRequest request;
        request.world = std::make_shared<const World>(scene.world);
        request.camera = camera;
        request.size = {24, 16};
        request.configuration.vpls.count = 16;
        return request;
    }
    RenderedFrame render(FrameRequest request) { return thread.wait_for(thread.submit(std::move(request))); }
    Texels read(const FinishedTexture& picture) {
        Texels texels;
        thread.run([&](Renderer& renderer) {
            texels = gl::read_texels(device_of(renderer).gl(), picture.texture, picture.size);
        });
        return texels;
    }
};

float brightest(const Texels& texels) {
    float most = 0.0F;
    for (const glm::vec4& texel : texels) most = std::max({most, texel.r, texel.g, texel.b});
    return most;
}

}  // namespace

TEST_CASE("two equal configurations differ nowhere, VPLs on paths differ from surfels") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    request.configuration.vpls.placement = VplPlacement::surfels;
    request.other = request.configuration;
    request.difference = 8.0F;
    const RenderedFrame equal = rendering.render(request);
    CHECK(equal.errors.empty());
    CHECK(brightest(rendering.read(equal.picture)) > 0.1F);
    CHECK(brightest(rendering.read(equal.difference.value())) == 0.0F);
    request.other->vpls.placement = VplPlacement::paths;
    const RenderedFrame unequal = rendering.render(request);
    CHECK(brightest(rendering.read(unequal.difference.value())) > 0.0F);
}

TEST_CASE("a faulty configuration is told and changes nothing") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    const RenderedFrame sound = rendering.render(request);
    CHECK(sound.settled);
    const Texels before = rendering.read(sound.picture);
    request.configuration.tone_map.exposure_ev = 3.0F;
    request.configuration.lists.tile_size = 17;
    const RenderedFrame faulty = rendering.render(request);
    REQUIRE(faulty.errors.size() == 1);
    CHECK(faulty.errors[0].find("lists.tile_size") != std::string::npos);
    CHECK(faulty.configuration == sound.configuration);
    CHECK(rendering.read(faulty.picture) == before);
    request.configuration.lists.tile_size = 32;
    const RenderedFrame brighter = rendering.render(request);
    CHECK(brighter.errors.empty());
    CHECK(rendering.read(brighter.picture) != before);
}

TEST_CASE("what the renderer throws is told, and the next request is rendered") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    request.camera = Entity{};
    const RenderedFrame blind = rendering.render(request);
    REQUIRE(blind.errors.size() == 1);
    CHECK(blind.settled);  // trying again would not help
    CHECK(rendering.render(rendering.request()).errors.empty());
}

TEST_CASE("a picture is refined until it is settled, but not while the thread is paused or held") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    request.configuration.refinement = {.enabled = true, .frames = 1U << 20U};
    SUBCASE("paused") {
        static_cast<void>(rendering.render(request));
        rendering.thread.pause(true);
    }
    SUBCASE("held") {
        static_cast<void>(rendering.render(request));
        rendering.thread.hold_refinement(true);
    }
    // A job runs between two frames: the frame that was on its way is done.
    rendering.thread.run([](Renderer&) {});
    static_cast<void>(rendering.thread.take());
    std::this_thread::sleep_for(100ms);
    CHECK_FALSE(rendering.thread.take());
    rendering.thread.pause(false);
    rendering.thread.hold_refinement(false);
    CHECK_FALSE(rendering.thread.wait_for(1).settled);
    request.configuration.refinement.frames = 2;
    RenderedFrame frame = rendering.render(request);
    while (!frame.settled) frame = rendering.thread.wait_for(frame.request);
    CHECK(frame.report->refined == 2);
}

TEST_CASE("a frame that is given up leaves no trace in the pictures after it") {
    const std::unique_ptr<HeadlessContext> context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    Scene scene = load_scene(shipped_file("scenes", "cornell.gltf"));
    FrameRequest request;
    request.camera = choose_camera(scene.world, std::nullopt, 1.0F);
    request.world = std::make_shared<const World>(scene.world);
    request.size = {24, 16};
    request.configuration.vpls.count = 16;
    const auto read = [](FrameRenderer& frames, const RenderedFrame& frame) {
        return gl::read_texels(device_of(frames.renderer()).gl(), frame.picture.texture, frame.picture.size);
    };
    FrameRenderer frames(context->get_proc(), {});
    frames.begin(request, 1);
    // Each time, one pass more is done before it is given up.
    int given_up = 0;
    std::optional<RenderedFrame> frame;
    for (int passes = 0; !frame; ++passes) {
        int left = passes;
        frame = frames.render(0, false, [&] { return left-- > 0; });
        if (!frame) ++given_up;
        CHECK(frames.refines() == frame.has_value());
        CHECK(frames.settled() == frame.has_value());
    }
    CHECK(given_up > 3);
    FrameRenderer others(context->get_proc(), {});
    others.begin(request, 1);
    const auto at_once = others.render(0, false, [] { return true; });
    CHECK(read(frames, *frame) == read(others, at_once.value()));
}

TEST_CASE("a first picture that had to be quick is followed by the whole one") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    request.size = {1280, 720};
    const RenderedFrame first = rendering.render(request);
    CHECK(first.picture.size == glm::uvec2(640, 360));  // no picture before it tells how long one takes
    CHECK(first.quality.scale == 0.5F);
    CHECK_FALSE(first.settled);
    const RenderedFrame second = rendering.thread.wait_for(first.request);
    CHECK(second.picture.size == request.size);
    CHECK(second.settled);
    request.size = {24, 16};
    static_cast<void>(rendering.render(request));
    request.size = {1280, 720};
    request.whole = true;
    CHECK(rendering.render(request).picture.size == request.size);
}

TEST_CASE("a frame that only refines is given up when it is held") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    request.size = {400, 300};
    request.configuration.vpls.count = 512;
    request.configuration.refinement = {.enabled = true, .frames = 1U << 20U};
    static_cast<void>(rendering.render(request));
    // A frame that is in its last pass is finished, so this is tried a few times.
    int given_up = 0;
    for (int attempt = 0; attempt < 5; ++attempt) {
        rendering.thread.hold_refinement(false);
        static_cast<void>(rendering.thread.wait_for(1));
        while (rendering.thread.stage() != RenderStage::rendering) std::this_thread::sleep_for(1ms);
        static_cast<void>(rendering.thread.take());
        rendering.thread.hold_refinement(true);
        rendering.thread.run([](Renderer&) {});
        if (!rendering.thread.take()) ++given_up;
    }
    CHECK(given_up > 0);
    // Refinement goes on with what it has.
    rendering.thread.hold_refinement(false);
    RenderedFrame frame = rendering.thread.wait_for(1);
    while (frame.report->refined < 6) frame = rendering.thread.wait_for(1);
}

TEST_CASE("within a budget, surfels are traced frame by frame until the picture is settled") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    request.configuration.vpls.count = 64;
    const RenderedFrame at_once = rendering.render(request);
    CHECK(at_once.settled);
    const Texels whole = rendering.read(at_once.picture);
    request.update_budget_ms = 1e-3;
    RenderedFrame frame = rendering.render(request);
    CHECK_FALSE(frame.settled);
    CHECK(frame.configuration == request.configuration);
    while (!frame.settled) frame = rendering.thread.wait_for(frame.request);
    CHECK(frame.report->vpls->waiting == 0);
    CHECK(rendering.read(frame.picture) == whole);
}

TEST_CASE("refinement ends at the wanted noise, and begins again when something has moved") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    request.configuration.refinement = {.enabled = true, .frames = 1U << 20U};
    request.noise_limit = 0.02;
    const auto settle = [&] {
        RenderedFrame frame = rendering.render(request);
        CHECK_FALSE(frame.settled);
        while (!frame.settled) frame = rendering.thread.wait_for(frame.request);
        return frame;
    };
    const RenderedFrame rough = settle();
    REQUIRE(rough.noise);
    CHECK(*rough.noise <= 0.02);
    CHECK(rough.report->refined >= 32);
    CHECK(rough.report->refined < 1U << 20U);
    request.noise_limit = 0.5 * *rough.noise;
    const RenderedFrame fine = settle();
    CHECK(*fine.noise <= request.noise_limit);
    CHECK(fine.report->refined > rough.report->refined);
    rendering.scene.world.edit<Transform>(light_markers(rendering.scene.world).front().entity,
                                          [](Transform& transform) { transform.translation.x += 0.1F; });
    request.world = rendering.request().world;
    const RenderedFrame moved = settle();
    CHECK(*moved.noise <= request.noise_limit);
}

TEST_CASE("a pixel of the picture is told by its radiance and by its colour") {
    Rendering rendering;
    FrameRequest request = rendering.request();
    CHECK_FALSE(rendering.render(request).probed);
    request.configuration.tone_map.enabled = false;
    request.probe = glm::uvec2(7, 3);
    const RenderedFrame frame = rendering.render(request);
    REQUIRE(frame.probed);
    CHECK(frame.probed->at == glm::uvec2(7, 3));
    const glm::vec3 shown(rendering.read(frame.picture)[3 * request.size.x + 7]);
    CHECK(frame.probed->colour == shown);
    // Without a tone map the picture has the radiance, rounded to 8 bits.
    CHECK(glm::all(
        glm::lessThan(glm::abs(glm::min(frame.probed->radiance, 1.0F) - shown), glm::vec3(0.51F / 255.0F))));
    request.probe = glm::uvec2(999, 999);
    CHECK(rendering.render(request).probed->at == request.size - 1U);
}
}  // TEST_SUITE("render thread")

}  // namespace candela::sandbox
