// The renderer's estimate of the error of its indirect light, against the error over the path tracer's.

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/reference/pictures.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/study/measures.hpp"

TEST_SUITE("reference: the renderer's estimate of its error") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{96, 72};
constexpr std::uint32_t seeds = 4;

class RendererError : public RenderFixture {
 protected:
    Configuration configuration(std::uint32_t vpls, std::uint32_t seed) const {
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.vpls = {.count = vpls, .seed = seed};
        configuration.visibility = {};
        return configuration;
    }

    /// The mean over some seeds of the error, as it is estimated and as it is.
    struct Errors {
        double estimated = 0.0;
        double measured = 0.0;
    };
    Errors mean_errors(const Scene& scene, const reference::Estimate& truth, std::uint32_t vpls) {
        const study::Mask off_edges = reference::without(truth.hit, truth.edge);
        Errors errors;
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            configure(configuration(vpls, seed));
            RenderTarget target(device, size);
            const RenderView view{.camera = scene.camera, .target = target.target(), .estimate_error = true};
            renderer.render(scene.world, {&view, 1});
            errors.estimated += renderer.report().vpls->estimated_error.value() / seeds;
            const auto picture = reference::flipped(target.read());
            errors.measured += study::rel_mse_of_blocks(picture, truth.halves, off_edges).value() / seeds;
        }
        return errors;
    }
};

}  // namespace

TEST_CASE_FIXTURE(RendererError, "is right within a factor of three but in one case, and of two in most") {
    // Errors below 4 % count as equal: what all sets of surfels have in common outweighs what differs.
    // The study tests that the factor is two in 9 of 10 scenes, of which these are a few.
    constexpr double invisible = 0.002;
    constexpr double factor = 3.0;
    int cases = 0;
    int within_two = 0;
    for (const std::string name : {"cornell", "two-rooms", "corner", "lamp", "court"}) {
        CAPTURE(name);
        const Scene scene = shipped_scene(name);
        const reference::Estimate truth =
            trace(reference::Scene(scene.world), scene.camera, {.size = size, .samples = 512});
        renderer.invalidate();
        for (const std::uint32_t vpls : {128U, 512U}) {
            CAPTURE(vpls);
            const Errors errors = mean_errors(scene, truth, vpls);
            MESSAGE(name, ", ", vpls, " VPLs: estimated ", errors.estimated, ", measured ", errors.measured);
            const double ratio = std::max(errors.estimated, invisible) / std::max(errors.measured, invisible);
            // Too high in the court with few surfels, also if exact rays are shown: the sets differ more at
            // single pixels than in the means that are measured.
            const bool is_too_high = name == "court" && vpls == 128;
            CHECK(ratio < (is_too_high ? 2.0 * factor : factor));
            CHECK(ratio > 1.0 / factor);
            ++cases;
            within_two += ratio > 0.5 && ratio < 2.0 ? 1 : 0;
        }
    }
    CHECK(4 * within_two >= 3 * cases);
}

}  // TEST_SUITE("reference: the renderer's estimate of its error")
