// Frames with different VPLs are averaged while nothing moves.

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "renderer/passes/view/refinement.hpp"
#include "renderer/passes/view/view.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("refinement") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};

Configuration refining(std::uint32_t frames, ShadingPath path = ShadingPath::deferred) {
    Configuration configuration = linear_configuration(path);
    configuration.vpls.count = 16;
    configuration.refinement = {.enabled = true, .frames = frames};
    return configuration;
}

class RefinementTests : public RenderFixture {
 protected:
    /// The scene without refinement, rendered from scratch.
    Picture unrefined(Configuration configuration, glm::uvec2 of_size = size,
                      glm::vec2 jitter = glm::vec2(0.0F)) {
        configuration.refinement.enabled = false;
        REQUIRE(plain_.configure(configuration).empty());
        plain_.invalidate();
        const RenderTarget target(device, of_size);
        plain_.render(scene.world, scene.camera, target.target(), jitter);
        return target.read();
    }

    /// Renders this many frames; returns the last one.
    Picture refined(std::uint32_t frames) {
        Picture picture;
        for (std::uint32_t i = 0; i < frames; ++i) {
            picture = render(scene, size);
        }
        return picture;
    }

    [[nodiscard]] std::vector<std::string> passes_that_ran() const {
        std::vector<std::string> names;
        for (const PassRecord& pass : renderer.last_passes()) {
            if (pass.ran) names.emplace_back(pass.name);
        }
        return names;
    }

    void move(Entity entity) {
        scene.world.edit<Transform>(entity, [](Transform& pose) { pose.translation.x += 0.125F; });
    }

    Scene scene = cornell_box();

 private:
    Renderer plain_{context->get_proc(), {.debug_output = true}};
};

/// The mean of pictures, in double precision.
Picture average(const std::vector<Picture>& pictures) {
    Picture mean{pictures.front().size, {}};
    for (std::size_t i = 0; i < pictures.front().pixels.size(); ++i) {
        glm::dvec3 sum(0.0);
        for (const Picture& picture : pictures) {
            sum += picture.pixels[i];
        }
        mean.pixels.emplace_back(sum / static_cast<double>(pictures.size()));
    }
    return mean;
}

}  // namespace

TEST_CASE_FIXTURE(RefinementTests,
                  "the result is the mean of pictures rendered with each seed and pixel sample") {
    constexpr std::uint32_t sets = frames_a_surfel_set + 2;
    Configuration configuration = refining(sets);
    std::uint32_t frames_a_seed = 1;
    SUBCASE("VPLs on paths, one frame per seed") {
        configuration.vpls.placement = VplPlacement::paths;
    }
    SUBCASE("surfels, several frames per seed") {
        frames_a_seed = frames_a_surfel_set;
    }
    configure(configuration);
    std::vector<Picture> pictures;
    for (std::uint32_t set = 0; set < sets; ++set) {
        Configuration of_set = configuration;
        of_set.vpls.seed += set / frames_a_seed;
        pictures.push_back(unrefined(of_set, size, pixel_sample(set)));
        const Picture mean = render(scene, size);
        CAPTURE(set);
        CHECK(renderer.report().refined == set + 1);
        CHECK(is_sane(mean));
        if (set == 0) CHECK(mean == pictures.front());
        // A step rounds three times, each time by at most 2⁻²⁴ of the largest value of the sets, which is
        // within an order of magnitude of the mean; 30 roundings are 1.8e-6 of it.
        const Picture expected = average(pictures);
        CHECK(worst_error(mean, expected, 1e-2 * candela::mean(expected)) < 2e-5);
    }
    CHECK(pictures[frames_a_seed] != pictures[0]);
}

TEST_CASE_FIXTURE(RefinementTests, "the error decreases as sets of VPLs accumulate") {
    // The reference uses other seeds. Another number of VPLs would have another bound on the geometry
    // term.
    const auto start_at = [&](std::uint32_t seed, std::uint32_t frames) {
        Configuration configuration = refining(frames);
        configuration.vpls.placement = VplPlacement::paths;
        configuration.vpls.seed = seed;
        configure(configuration);
    };
    start_at(1'000'000, 256);
    const Picture reference = refined(256);
    // The error of a single sequence of sets varies much: whole walls are too bright or too dark at once.
    glm::dvec3 error(0.0);  // after 1, 8 and 64 sets, summed over four sequences
    for (const std::uint32_t seed : {0U, 1000U, 2000U, 3000U}) {
        start_at(seed, 64);
        error.x += relative_mean_square(refined(1), reference);
        error.y += relative_mean_square(refined(7), reference);
        error.z += relative_mean_square(refined(56), reference);
    }
    CAPTURE(error.x);
    CAPTURE(error.y);
    CAPTURE(error.z);
    // Independent sets divide the error by 8 each time; the error of the reference adds a quarter of the
    // last one. The rest of the tolerance is for random variation.
    CHECK(error.y < error.x / 3.0);
    CHECK(error.z < error.y / 3.0);
    CHECK(error.z > 0.0);
}

TEST_CASE_FIXTURE(RefinementTests, "a still picture becomes antialiased, with and without indirect light") {
    // 64 samples per pixel on a grid, from a picture with 64 times as many pixels.
    const auto supersampled = [&](const Configuration& configuration) {
        constexpr std::uint32_t factor = 8;
        const Picture fine = unrefined(configuration, factor * size);
        Picture mean{size, std::vector<glm::vec3>(static_cast<std::size_t>(size.x) * size.y)};
        for (std::size_t i = 0; i < fine.pixels.size(); ++i) {
            const std::size_t x = i % fine.size.x / factor;
            const std::size_t y = i / fine.size.x / factor;
            mean.pixels[y * size.x + x] += fine.pixels[i] / static_cast<float>(factor * factor);
        }
        return mean;
    };
    for (const bool indirect : {false, true}) {
        CAPTURE(indirect);
        Configuration configuration = refining(64);
        configuration.indirect = indirect;
        configuration.show = Show::direct;
        configure(configuration);
        const Picture expected = supersampled(configuration);
        const double stepped = relative_mean_square(refined(1), expected);
        // At an edge, the error of one sample has a variance of up to 1/4. The 64 well-distributed
        // samples of either picture have the variance of about 16 independent ones or less, 1/64.
        CHECK(relative_mean_square(refined(63), expected) < stepped / 16.0);
        CHECK(renderer.report().refined == 64);
    }
}

TEST_CASE_FIXTURE(RefinementTests, "after any movement the next frame is the unrefined one, bit for bit") {
    for (const ShadingPath path : {ShadingPath::forward_plus, ShadingPath::clustered_deferred}) {
        CAPTURE(to_string(path));
        Configuration configuration = refining(16, path);
        configuration.vpls.placement = VplPlacement::paths;
        configure(configuration);
        const Entity block = [&] {
            Entity last{};
            for (const auto& [entity, mesh] : scene.world.view<MeshInstance>()) last = entity;
            return last;
        }();
        for (const Entity moved : {scene.light, scene.camera, block}) {
            const Picture before = refined(4);
            CHECK(renderer.report().refined >= 4);
            move(moved);
            const Picture after = render(scene, size);
            CHECK(after == unrefined(configuration));
            CHECK(after != before);
            CHECK(renderer.report().refined == 1);
        }
        static_cast<void>(refined(4));
        scene.world.edit<PointLight>(scene.light, [](PointLight& light) { light.intensity *= 1.5F; });
        CHECK(render(scene, size) == unrefined(configuration));
    }
}

TEST_CASE_FIXTURE(RefinementTests, "the set of surfels is kept when a light or the camera moves") {
    Configuration configuration = refining(16);
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
    configure(configuration);
    static_cast<void>(refined(frames_a_surfel_set + 2));
    for (const Entity moved : {scene.light, scene.camera}) {
        move(moved);
        Configuration of_set = configuration;
        of_set.vpls.seed += 1;
        CHECK(render(scene, size) == unrefined(of_set));
        CHECK(renderer.report().refined == 1);
        for (const std::string& pass : passes_that_ran()) {
            CHECK((pass != "surfel-visibility" && pass != "vpl-maps"));
        }
    }
    // From here the mean continues, and switches to another set on schedule.
    static_cast<void>(refined(frames_a_surfel_set - 1));
    CHECK_FALSE(ran("vpl-maps"));
    static_cast<void>(refined(1));
    CHECK(ran("vpl-maps"));
    CHECK(renderer.report().refined == frames_a_surfel_set + 1);
}

TEST_CASE_FIXTURE(RefinementTests,
                  "it stops after the configured number of frames, and then only tone mapping runs") {
    configure(refining(5));
    const Picture stands = refined(5);
    CHECK(ran("accumulate"));
    CHECK(renderer.report().refined == 5);
    for (int i = 0; i < 3; ++i) {
        CHECK(render(scene, size) == stands);
        CHECK(passes_that_ran() == std::vector<std::string>{"tone-map"});
    }
    CHECK(renderer.report().refined == 5);
}

TEST_CASE_FIXTURE(RefinementTests, "setting a component to an equal value does not restart refinement") {
    configure(refining(16));
    static_cast<void>(refined(3));
    scene.world.set(scene.light, Transform(scene.world.get<Transform>(scene.light)));
    static_cast<void>(render(scene, size));
    CHECK(renderer.report().refined == 4);
}

TEST_CASE_FIXTURE(RefinementTests,
                  "passes of the scene, the requested view and shadows do not run between sets") {
    Configuration configuration = refining(16);
    configuration.vpls.placement = VplPlacement::paths;
    configure(configuration);
    static_cast<void>(refined(3));
    for (const char* pass : {"scene-gather", "scene-upload", "instance-upload", "bvh", "lights", "view",
                             "shadow-plan", "shadow-maps", "light-upload"}) {
        CAPTURE(pass);
        CHECK_FALSE(ran(pass));
    }
    CHECK(ran("vpl-trace"));
}

TEST_CASE_FIXTURE(RefinementTests,
                  "resizing, another path and invalidate() restart it, exposure and frame budget do not") {
    Configuration configuration = refining(16);
    configure(configuration);
    static_cast<void>(refined(4));
    configuration.path = ShadingPath::forward;
    configure(configuration);
    CHECK(render(scene, size) == unrefined(configuration));

    static_cast<void>(refined(4));
    constexpr glm::uvec2 larger = 2U * size;
    CHECK(render(scene, larger) == unrefined(configuration, larger));
    CHECK(render(scene, size) == unrefined(configuration));

    static_cast<void>(refined(4));
    renderer.invalidate();
    CHECK(render(scene, size) == unrefined(configuration));

    static_cast<void>(refined(4));
    CHECK(renderer.report().refined == 5);
    configuration.tone_map.exposure_ev = 1.0F;
    configure(configuration);
    static_cast<void>(render(scene, size));
    CHECK(renderer.report().refined == 6);
    configuration.frame_budget_ms = 1e6F;
    configure(configuration);
    static_cast<void>(render(scene, size));
    CHECK(renderer.report().refined == 7);
}

TEST_CASE_FIXTURE(RefinementTests, "another world restarts it, and so does jitter") {
    const Configuration configuration = refining(16);
    configure(configuration);
    static_cast<void>(refined(4));
    const Scene other = furnace_box(0.5F);
    static_cast<void>(render(other, size));
    CHECK(renderer.report().refined == 1);
    static_cast<void>(refined(4));
    CHECK(renderer.report().refined == 4);
    const RenderTarget target(device, size);
    renderer.render(scene.world, scene.camera, target.target(), {0.25F, 0.0F});
    CHECK(renderer.report().refined == 1);
}

}  // TEST_SUITE("refinement")
