#include <candela/tools/live_reference.hpp>

#include <doctest/doctest.h>
#include <cstdlib>
#include "sandbox/scene/scene.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <thread>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "tests/reference/pictures.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/study/measures.hpp"

TEST_SUITE("reference: live") {

using namespace candela;
using reference::Estimate;
using reference::Settings;
using tools::ReferencePicture;
using tools::ReferenceRequest;
using namespace std::chrono_literals;

namespace {

double seconds_of(const std::function<void()>& work) {
    const auto began = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

/// Processor time in seconds that all threads of this process use in a period.
double processor_time_in(std::chrono::milliseconds period) {
    const std::clock_t before = std::clock();
    std::this_thread::sleep_for(period);
    return static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
}

/// Whether the process uses next to no processor time within five seconds: threads may finish a pixel first,
/// which a sanitizer or other processes make slow. A thread that waits actively never lets this be true.
bool becomes_idle() {
    for (int attempt = 0; attempt < 25; ++attempt) {
        if (processor_time_in(200ms) < 0.01) return true;
    }
    return false;
}

/// A reference with all of its pictures since the last start.
class Live {
 public:
    void start(const Scene& scene, ReferenceRequest request) {
        request.world = std::make_shared<const World>(scene.world);
        request.camera = scene.camera;
        const std::lock_guard lock(mutex_);
        pictures_.clear();
        reference_->start(std::move(request));
    }
    void stop() { reference_->stop(); }
    [[nodiscard]] std::string fault() const { return reference_->fault(); }
    [[nodiscard]] bool has_picture() const { return reference_->newest().has_value(); }
    void destroy() { reference_.reset(); }

    /// Waits for at least as many pictures and returns all; fewer after two minutes.
    std::vector<ReferencePicture> wait_for_pictures(std::size_t count) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, 120s, [&] { return pictures_.size() >= count; });
        return pictures_;
    }
    std::string wait_for_fault() {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, 120s, [&] { return !fault().empty(); });
        return fault();
    }

 private:
    void take() {
        const std::lock_guard lock(mutex_);
        if (auto picture = reference_->newest()) pictures_.push_back(std::move(*picture));
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<ReferencePicture> pictures_;
    std::unique_ptr<tools::LiveReference> reference_ = tools::make_live_reference([this] { take(); });
};

// Before the first picture, the preview comes twice, the second time with more pixels.
constexpr std::size_t previews = 2;

/// All pictures of a reference; that of n samples is number `previews` + n / 2 - 1.
std::vector<ReferencePicture> refined(const Scene& scene, const ReferenceRequest& request) {
    Live live;
    live.start(scene, request);
    auto pictures = live.wait_for_pictures(previews + request.samples / 2);
    REQUIRE(pictures.size() == previews + request.samples / 2);
    return pictures;
}

const ReferencePicture& with_samples(const std::vector<ReferencePicture>& pictures, std::uint32_t samples) {
    const ReferencePicture& picture = pictures[previews + samples / 2 - 1];
    REQUIRE(picture.samples == samples);
    return picture;
}

/// The number of pixels for which `differ(i)` is true.
template <typename Differ>
std::size_t count_pixels(const tools::Picture& picture, Differ differ) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) count += differ(i) ? 1 : 0;
    return count;
}

Estimate traced(const Scene& scene, const Settings& settings) {
    return trace(reference::Scene(scene.world), scene.camera, settings);
}

/// A square of radiance 1, which reflects nothing, on black. Its sides are askew to the pixels.
Scene bright_square() {
    Scene scene;
    Material glow;
    glow.base_colour = glm::vec4(0, 0, 0, 1);
    glow.emissive = glm::vec3(1.0F);
    glow.double_sided = true;
    add(scene.world, Transform{.rotation = glm::angleAxis(0.3F, glm::vec3(0, 1, 0))},
        MeshInstance{square(1.0F, std::make_shared<const Material>(glow))});
    scene.camera = add(scene.world, looking({0, 3, 0}, {0, 0, 0}, {0, 0, -1}), Camera{.vertical_fov = 1.0F});
    return scene;
}

}  // namespace

TEST_CASE("a picture is the mean of two seeds, each of which the tracer traces at once") {
    const char* name = "cornell";
    SUBCASE("lights") {}
    SUBCASE("blended surfaces and many lights") {
        name = "glass";
    }
    SUBCASE("surfaces that emit light") {
        name = "neon";
    }
    SUBCASE("a sky") {
        name = "court";
    }
    const Scene scene = shipped_scene(name);
    const glm::uvec2 size(20, 16);
    const auto pictures = refined(scene, {.size = size, .samples = 12});
    const Estimate even = traced(scene, {.size = size, .samples = 6, .seed = 0});
    const Estimate odd = traced(scene, {.size = size, .samples = 6, .seed = 1});
    const tools::Picture a = total(even);
    const tools::Picture b = total(odd);
    const ReferencePicture& last = pictures.back();
    CHECK(last.samples == 12);
    CHECK(last.hit == even.hit);
    CHECK(count_pixels(a, [&](std::size_t i) {
              // Running means of floats round a few times per pass.
              const glm::vec3 mean = 0.5F * (a.pixels[i] + b.pixels[i]);
              const glm::vec3 tolerance = 1e-5F * (mean + glm::max(a.pixels[i], b.pixels[i]));
              return glm::any(glm::greaterThan(glm::abs(last.radiance.pixels[i] - mean), tolerance));
          }) == 0);
}

TEST_CASE("each picture depends only on its number of samples") {
    const Scene scene = shipped_scene("glass");
    const auto once = refined(scene, {.size = {24, 20}, .antialiased = true, .threads = 1, .samples = 10});
    for (const unsigned threads : {0U, 3U}) {
        const auto again =
            refined(scene, {.size = {24, 20}, .antialiased = true, .threads = threads, .samples = 10});
        for (std::size_t i = 0; i < once.size(); ++i) {
            CHECK(again[i].samples == once[i].samples);
            CHECK(again[i].radiance.pixels == once[i].radiance.pixels);
            CHECK(again[i].hit == once[i].hit);
            CHECK(again[i].noise == once[i].noise);
        }
    }
}

TEST_CASE("previews come first, at the size of the picture") {
    Scene scene = bright_square();
    // The square is at the lower left.
    scene.world.set(scene.camera, looking({0.7F, 3, -0.5F}, {0.7F, 0, -0.5F}, {0, 0, -1}));
    const auto pictures = refined(scene, {.size = {63, 41}, .samples = 4});
    const tools::Picture& last = pictures.back().radiance;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        CAPTURE(i);
        const tools::Picture& picture = pictures[i].radiance;
        CHECK((pictures[i].samples == 0) == (i < previews));
        CHECK(picture.size == glm::ivec2(63, 41));
        REQUIRE(picture.pixels.size() == last.pixels.size());
        // The outline of the square is up to 120 pixels long, and a pixel of a preview may reach over it
        // by its width, 4 pixels.
        CHECK(count_pixels(last, [&](std::size_t p) { return picture.pixels[p] != last.pixels[p]; }) < 480);
    }
    CHECK(std::ranges::count(last.pixels, glm::vec3(1.0F)) > 500);
}

TEST_CASE("the estimated noise is the error over a reference with little noise") {
    const char* name = "cornell";
    SUBCASE("of indirect light") {}
    SUBCASE("of the direct light of surfaces") {
        name = "neon";
    }
    const Scene scene = shipped_scene(name);
    const glm::uvec2 size(48, 36);
    const tools::Picture truth = total(traced(scene, {.size = size, .samples = 1024, .seed = 9}));
    const auto pictures = refined(scene, {.size = size, .samples = 64});
    CHECK_FALSE(with_samples(pictures, 2).noise);
    for (const std::uint32_t samples : {4U, 6U, 16U, 32U, 64U}) {
        const ReferencePicture& picture = with_samples(pictures, samples);
        REQUIRE(picture.noise);
        const double error = relative_mse(picture.radiance, truth, picture.hit);
        MESSAGE(name, ", ", samples, " samples: noise ", *picture.noise, ", error ", error);
        // A few pixels with bright paths have most of the error, hence the margin. Where both halves have
        // missed such paths, or one has found one and thereby raised the mean that the noise is divided
        // by, the noise is underestimated, which matters in noisy pictures.
        CHECK(*picture.noise < 1.5 * error);
        CHECK(*picture.noise > error / (*picture.noise < 0.05 ? 1.5 : 4.0));
    }
}

TEST_CASE("the error falls as the number of samples grows") {
    const Scene scene = cornell_box();
    const glm::uvec2 size(48, 48);
    const tools::Picture truth = total(traced(scene, {.size = size, .samples = 1024, .seed = 9}));
    const auto pictures = refined(scene, {.size = size, .samples = 64});
    const auto error = [&](std::uint32_t samples) {
        const ReferencePicture& picture = with_samples(pictures, samples);
        return relative_mse(picture.radiance, truth, picture.hit);
    };
    // 16 times as many samples have a sixteenth of the error, if not some bright paths have most of it.
    CHECK(error(64) < error(4) / 8.0);
}

TEST_CASE("antialiased, a pixel is the mean over its area, otherwise what is at its centre") {
    const Scene scene = bright_square();
    const glm::uvec2 size(16, 16);
    constexpr int fine = 16;
    const Estimate points =
        traced(scene, {.size = size * static_cast<unsigned>(fine), .samples = 2, .bounces = 0});
    const tools::Picture areas = study::scaled_down(points.direct, fine);
    const ReferencePicture smooth =
        refined(scene, {.size = size, .antialiased = true, .samples = 256}).back();
    const ReferencePicture centres = refined(scene, {.size = size, .samples = 4}).back();
    int partial = 0;
    for (std::size_t i = 0; i < areas.pixels.size(); ++i) {
        const float area = areas.pixels[i].r;
        partial += area > 0.1F && area < 0.9F ? 1 : 0;
        // 128 well spread points: those near an edge, about √128 of them, are on either side by chance.
        CHECK(std::abs(smooth.radiance.pixels[i].r - area) < 0.05F);
        CHECK((smooth.hit[i] != 0) == (smooth.radiance.pixels[i].r > 0.0F));
        CHECK((centres.radiance.pixels[i].r == 0.0F || centres.radiance.pixels[i].r == 1.0F));
    }
    CHECK(partial > 10);
}

TEST_CASE_FIXTURE(RenderFixture,
                  "the renderer shows the antialiased picture if it refines, otherwise the other") {
    Scene scene = bright_square();
    scene.world.set(scene.camera, looking({0.7F, 3, -0.5F}, {0.7F, 0, -0.5F}, {0, 0, -1}));
    const glm::uvec2 size(40, 32);
    const tools::Picture smooth =
        refined(scene, {.size = size, .antialiased = true, .samples = 256}).back().radiance;
    const tools::Picture centres = refined(scene, {.size = size, .samples = 4}).back().radiance;
    // The renderer shows the square's albedo of 1 in place of its radiance, which is also 1: placing VPLs
    // on what emits light takes longer than all else here.
    const Scene bright = scene;
    for (const auto& [entity, instance] : bright.world.view<MeshInstance>()) {
        scene.world.set(entity, MeshInstance{square(1.0F, diffuse(glm::vec3(1.0F), true))});
    }
    Configuration configuration = linear_configuration();
    configuration.show = Show::albedo;
    configure(configuration);
    const tools::Picture frame = reference::flipped(render(scene, size));
    constexpr std::uint32_t frames = 64;
    configuration.refinement = {.enabled = true, .frames = frames};
    configure(configuration);
    for (std::uint32_t i = 1; i < frames; ++i) (void)render(scene, size);
    const tools::Picture mean = reference::flipped(render(scene, size));
    // Away from the edges both are the same, so that all of the error is at edges. A pixel's share of an
    // edge is right to about 0.05 (see above), which counts most where a dark pixel has a small share.
    CHECK(relative_mse(frame, centres) == 0.0);
    CHECK(relative_mse(mean, smooth) < 0.01);
    CHECK(relative_mse(frame, smooth) > 0.02);
    CHECK(relative_mse(mean, centres) > 0.1);
}

TEST_CASE("another start shows another world, and its pictures only") {
    const Scene large = shipped_scene("glass");
    const Scene scene = cornell_box();
    const ReferenceRequest request{.size = {24, 24}, .samples = 8};
    const auto expected = refined(scene, request);
    Live live;
    live.start(large, {.size = {1024, 1024}});
    (void)live.wait_for_pictures(1);
    // The start does not wait: a pass of the large picture takes seconds. Other processes may delay the
    // call.
    CHECK(seconds_of([&] { live.start(scene, request); }) < 0.5);
    const auto pictures = live.wait_for_pictures(expected.size());
    REQUIRE(pictures.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(pictures[i].radiance.pixels == expected[i].radiance.pixels);
    }
}

TEST_CASE("after a stop there is no picture, and stopping takes no time") {
    const Scene scene = shipped_scene("glass");
    Live live;
    live.start(scene, {.size = {1024, 1024}});
    (void)live.wait_for_pictures(1);
    CHECK(seconds_of([&] { live.stop(); }) < 0.5);
    const std::size_t before = live.wait_for_pictures(0).size();
    std::this_thread::sleep_for(100ms);
    CHECK(live.wait_for_pictures(0).size() == before);
    CHECK_FALSE(live.has_picture());
    // The end waits for the pixels that are being traced, not for the pass.
    live.start(scene, {.size = {1024, 1024}});
    (void)live.wait_for_pictures(1);
    CHECK(seconds_of([&] { live.destroy(); }) < 0.5);
}

TEST_CASE("a finished reference, and a stopped one, use no processor time") {
    Live live;
    live.start(cornell_box(), {.size = {16, 16}, .samples = 4});
    REQUIRE(live.wait_for_pictures(previews + 2).size() == previews + 2);
    CHECK(becomes_idle());
    live.start(shipped_scene("glass"), {.size = {1024, 1024}});
    (void)live.wait_for_pictures(1);
    CHECK(processor_time_in(200ms) > 0.0);
    live.stop();
    CHECK(becomes_idle());
}

TEST_CASE("a request that cannot be traced has a fault, until the next start") {
    Scene scene = cornell_box();
    Live live;
    scene.camera = scene.light;
    live.start(scene, {.size = {8, 8}, .samples = 4});
    CHECK(live.wait_for_fault() == "the reference's scene has no such camera");
    CHECK_FALSE(live.has_picture());
    live.start(cornell_box(), {.size = {0, 8}, .samples = 4});
    CHECK(live.wait_for_fault() == "the reference's picture has no pixels");
    live.start(cornell_box(), {.size = {8, 8}, .samples = 4});
    CHECK(live.wait_for_pictures(previews + 2).size() == previews + 2);
    CHECK(live.fault().empty());
}

TEST_CASE("a world without surfaces is its sky, whose noise cannot be told") {
    Scene scene;
    scene.camera = add(scene.world, Transform{}, Camera{});
    const ReferencePicture picture = refined(scene, {.size = {8, 8}, .samples = 4}).back();
    CHECK(std::ranges::count(picture.hit, 1) == 0);
    CHECK_FALSE(picture.noise);
}

}  // TEST_SUITE("reference: live")
