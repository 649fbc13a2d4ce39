// The estimate of the error of the VPLs' light. tests/reference holds it against the path tracer.

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/passes/indirect/vpl_error.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("error of VPLs") {

using namespace candela;

namespace {

class VplErrorTests : public RenderFixture {
 protected:
    /// A picture of the scene by a renderer that estimates the error, or does not.
    Picture picture(Renderer& by, const Scene& scene, bool estimates) {
        RenderTarget target(device, {32, 24});
        const RenderView view{.camera = scene.camera, .target = target.target(), .estimate_error = estimates};
        by.render(scene.world, {&view, 1});
        return target.read();
    }

    std::size_t passes_of_estimate() {
        return static_cast<std::size_t>(
            std::ranges::count_if(renderer.last_passes(), [](const PassRecord& pass) {
                return pass.name.starts_with("vpl-samples") || pass.name.ends_with("(other set)");
            }));
    }
};

Configuration with_maps(std::uint32_t vpls) {
    Configuration configuration = linear_configuration();
    configuration.vpls.count = vpls;
    configuration.visibility.method = VplVisibility::maps;
    return configuration;
}

}  // namespace

TEST_CASE("sets that agree are right, and the error does not depend on the unit") {
    const std::vector<glm::vec4> nothing(4, glm::vec4(0.0F));
    const std::vector<glm::vec4> black(4, {0, 0, 0, 1});
    std::vector<glm::vec4> a(4, {1, 2, 3, 1});
    CHECK(estimated_error(nothing, nothing) == 0.0);
    CHECK(estimated_error(black, black) == 0.0);
    CHECK(estimated_error(a, a) == 0.0);
    std::vector<glm::vec4> b(4, {1, 2, 4, 1});
    const double error = estimated_error(a, b);
    CHECK(error > 0.0);
    CHECK(estimated_error(b, a) == error);
    // Pixels without a surface do not count.
    a.resize(9, glm::vec4(0.0F));
    b.resize(9, glm::vec4(0.0F));
    CHECK(estimated_error(a, b) == doctest::Approx(error));
    for (auto* set : {&a, &b}) {
        for (glm::vec4& sample : *set) sample = glm::vec4(1000.0F * glm::vec3(sample), sample.a);
    }
    CHECK(estimated_error(a, b) == doctest::Approx(error));
}

TEST_CASE("the error grows with the square of the difference") {
    const std::vector<glm::vec4> a(4, {1, 1, 1, 1});
    const auto shifted = [&](float by) { return std::vector<glm::vec4>(4, {1 + by, 1 + by, 1 + by, 1}); };
    // The mean that it is relative to also grows, by a hundredth.
    CHECK(estimated_error(a, shifted(0.02F)) ==
          doctest::Approx(4.0 * estimated_error(a, shifted(0.01F))).epsilon(0.02));
}

TEST_CASE_FIXTURE(VplErrorTests, "the estimate changes no picture, and costs nothing if nobody asks for it") {
    const Scene scene = cornell_box();
    for (const VplPlacement placement : {VplPlacement::paths, VplPlacement::surfels}) {
        for (const VplVisibility method : {VplVisibility::none, VplVisibility::maps, VplVisibility::rays}) {
            CAPTURE(to_string(placement));
            CAPTURE(to_string(method));
            Configuration configuration = with_maps(32);
            configuration.vpls.placement = placement;
            configuration.visibility.method = method;
            configure(configuration);
            const Picture without = picture(renderer, scene, false);
            CHECK(passes_of_estimate() == 0);
            CHECK_FALSE(renderer.report().vpls->estimated_error);
            CHECK(picture(renderer, scene, true) == without);
            CHECK(passes_of_estimate() > 0);
            const std::optional<double> error = renderer.report().vpls->estimated_error;
            REQUIRE(error);
            CHECK(*error > 0.0);
            CHECK(*error < 1.6);  // what it is if only one set has any light
            // In a still frame, it is known already.
            CHECK(picture(renderer, scene, true) == without);
            CHECK_FALSE(ran("vpl-samples"));
            CHECK_FALSE(ran("vpl-samples-other"));
            CHECK(renderer.report().vpls->estimated_error == error);
        }
    }
}

TEST_CASE_FIXTURE(VplErrorTests, "every view has its own estimate") {
    const Scene scene = cornell_box();
    configure(with_maps(32));
    RenderTarget target(device, {32, 24});
    const RenderView asks{.camera = scene.camera, .target = target.target(), .estimate_error = true};
    RenderView other = asks;
    other.estimate_error = false;
    const std::vector<RenderView> views{other, asks};
    renderer.render(scene.world, views);
    CHECK_FALSE(renderer.report(0).vpls->estimated_error);
    CHECK(renderer.report(1).vpls->estimated_error.value_or(0.0) > 0.0);
}

TEST_CASE_FIXTURE(VplErrorTests, "a warning names a view for which the VPLs are too few") {
    const Scene scene = shipped_scene("two-rooms");
    std::vector<std::string> lines;
    Renderer logged(context->get_proc(), {.log = [&](std::string_view line) { lines.emplace_back(line); }});
    for (const std::uint32_t count : {256U, 4U}) {
        CAPTURE(count);
        REQUIRE(logged.configure(with_maps(count)).empty());
        for (int frame = 0; frame < 2; ++frame) {
            static_cast<void>(picture(logged, scene, true));
            static_cast<void>(logged.report());
        }
        CHECK(lines.size() == (count == 4 ? 1 : 0));
    }
    REQUIRE(!lines.empty());
    CHECK(lines.front().find("4 VPLs are too few") != std::string::npos);
}

}  // TEST_SUITE("error of VPLs")
