// Incremental VPLs: what a frame keeps of the one before, what it makes anew, and what that comes to.

#include "renderer/passes/vpl_refresh.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/renderer/random_edits.hpp"
#include "tests/seed.hpp"

using namespace candela;

namespace {

constexpr std::uint32_t budget = 8;

void move(World& world, Entity entity, glm::vec3 by) {
    world.edit<Transform>(entity, [&](Transform& transform) { transform.translation += by; });
}

Configuration incremental(std::uint32_t count, VplVisibility visibility = VplVisibility::none) {
    Configuration configuration = linear_configuration();
    configuration.vpls = {.count = count, .bounces = 3, .budget = budget};
    configuration.visibility = {.method = visibility, .map_resolution = 16};
    configuration.shadows = {.cube_resolution = 64, .map_resolution = 64, .budget_mib = 16};
    return configuration;
}

class Refresh : public RenderFixture {
 protected:
    VplReport vpls() {
        const auto report = renderer.report().vpls;
        REQUIRE(report);
        return *report;
    }

    /// A frame; its account must balance.
    VplReport frame(const Scene& scene) {
        picture = render(scene, size);
        CHECK(is_sane(picture));
        const VplReport report = vpls();
        const EnergyAccount& flux = report.flux;
        const glm::dvec3 gone = flux.absorbed + flux.escaped + flux.truncated + flux.roulette;
        for (int c = 0; c < 3; ++c) {
            CHECK(std::abs(gone[c] - flux.emitted[c]) <= 1e-3 * flux.emitted[c]);
            CHECK(std::abs(flux.roulette[c]) <=
                  std::max(4.0 * flux.roulette_error[c], 1e-3 * flux.emitted[c]));
        }
        // All that may be made in a frame is what was missing before, and what is made is made within it.
        CHECK(report.traced <= budget);
        CHECK(report.maps_drawn <= budget);
        return report;
    }

    /// Frames until nothing is left to do; gives how many.
    std::uint32_t settle(const Scene& scene) {
        std::uint32_t frames = 0;
        for (VplReport report = vpls(); report.debt + report.stale > 0; report = frame(scene)) {
            REQUIRE(++frames < 500);
        }
        return frames;
    }

    Picture regenerated(const Scene& scene) {
        Configuration all = renderer.configuration();
        all.vpls.budget = 0;
        TestedRenderer fresh(context->get_proc());
        REQUIRE(fresh.configure(all).empty());
        const RenderTarget target(device, size);
        fresh.render(scene.world, scene.camera, target.target());
        return target.read();
    }

    /// Random edits, a frame after each, until `steps` are done; then what is left to do comes to an end, and
    /// the state is that of full regeneration.
    void check_edits(RandomEdits& edits, int steps) {
        configure(edits.configuration);
        renderer.invalidate();
        size = edits.size;
        static_cast<void>(render(edits.scene, size));
        std::string history;
        for (int step = 0; step < steps; ++step) {
            history += edits.next();
            CAPTURE(history);
            configure(edits.configuration);
            size = edits.size;
            static_cast<void>(frame(edits.scene));
        }
        CAPTURE(history);
        settle(edits.scene);
        CHECK(render(edits.scene, size) == regenerated(edits.scene));
    }

    glm::uvec2 size{40, 30};
    Picture picture;
};

/// Mean over the pixels of |a - b|² / (|b|² + 0.01 |mean of b|²).
double relative_mse(const Picture& a, const Picture& b) {
    const double floor = 0.01 * 3.0 * mean(b) * mean(b);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 wanted(b.pixels[i]);
        const glm::dvec3 error = glm::dvec3(a.pixels[i]) - wanted;
        sum += glm::dot(error, error) / (glm::dot(wanted, wanted) + floor);
    }
    return sum / static_cast<double>(a.pixels.size());
}

}  // namespace

TEST_SUITE("vpl refresh") {
    TEST_CASE_FIXTURE(Refresh,
                      "when edits stop, the picture becomes that of full regeneration, bit for bit") {
        for (const VplVisibility visibility : {VplVisibility::none, VplVisibility::maps}) {
            CAPTURE(to_string(visibility));
            configure(incremental(64, visibility));
            Scene scene = cornell_box();
            Entity block{};
            for (const auto& [entity, mesh] : scene.world.view<MeshInstance>()) block = entity;
            const Entity spot =
                add(scene.world, looking({0.5F, 1.5F, 1.0F}, {0, 0, 0}), SpotLight{.intensity = 3.0F});
            const Entity sun = add(scene.world, looking({0.3F, 0.8F, 3.0F}, {0, 0, 0}),
                                   DirectionalLight{.illuminance = 1.0F});
            const std::vector<std::function<void()>> edits = {
                [&] {
                    move(scene.world, scene.light, {0.05F, -0.2F, 0.1F});
                },
                [&] {
                    move(scene.world, spot, {0.2F, -0.1F, 0.1F});
                },
                [&] {
                    scene.world.set(sun, looking({0.4F, 0.9F, 3.0F}, {0, 0, 0}));
                },
                [&] {
                    move(scene.world, block, {0.2F, 0.0F, -0.1F});
                },
                [&] {
                    move(scene.world, block, {0.0F, 0.0F, 1.5F});
                },  // out of the box: its bounds change
                [&] { scene.world.edit<PointLight>(scene.light, [](auto& l) { l.intensity *= 3.0F; }); },
                [&] { scene.world.edit<PointLight>(scene.light, [](auto& l) { l.range = 1.2F; }); },
                [&] { scene.world.destroy(spot); },
            };
            static_cast<void>(render(scene, size));
            REQUIRE(vpls().debt + vpls().stale == 0);
            for (std::size_t i = 0; i < edits.size(); ++i) {
                CAPTURE(i);
                edits[i]();
                static_cast<void>(frame(scene));
                settle(scene);
                CHECK(render(scene, size) == regenerated(scene));
            }
        }
    }

    TEST_CASE_FIXTURE(Refresh, "a still frame without debt runs nothing") {
        configure(incremental(64, VplVisibility::maps));
        Scene scene = cornell_box();
        static_cast<void>(render(scene, size));
        static_cast<void>(render(scene, size));
        CHECK_FALSE(ran("vpl-refresh"));
        CHECK_FALSE(ran("vpl-trace"));
        move(scene.world, scene.light, {0.1F, 0, 0});
        static_cast<void>(frame(scene));
        static_cast<void>(render(scene, size));
        CHECK(ran("vpl-refresh"));
        settle(scene);
        static_cast<void>(render(scene, size));
        CHECK_FALSE(ran("vpl-refresh"));
        CHECK_FALSE(ran("vpl-trace"));
        CHECK_FALSE(ran("vpl-maps"));
    }

    TEST_CASE_FIXTURE(Refresh, "colour and intensity change the flux, and no path or map is made anew") {
        configure(incremental(64, VplVisibility::maps));
        Scene scene = cornell_box();
        static_cast<void>(render(scene, size));
        scene.world.edit<PointLight>(scene.light, [](auto& light) { light.colour = {0.2F, 1.0F, 0.5F}; });
        const VplReport report = frame(scene);
        CHECK(report.traced == 0);
        CHECK(report.maps_drawn == 0);
        CHECK(report.debt + report.stale == 0);
        CHECK(picture == regenerated(scene));
    }

    TEST_CASE_FIXTURE(Refresh, "shadows that come and go leave all paths and maps as they are") {
        Configuration configuration = incremental(64, VplVisibility::maps);
        configure(configuration);
        const Scene scene = cornell_box();
        static_cast<void>(render(scene, size));
        for (const bool enabled : {false, true}) {
            configuration.shadows.enabled = enabled;
            configure(configuration);
            const VplReport report = frame(scene);
            CHECK(report.traced == 0);
            CHECK(report.maps_drawn == 0);
            CHECK(picture == regenerated(scene));
        }
    }

    TEST_CASE_FIXTURE(Refresh, "a mesh that moves takes away the paths that it stops, and no others") {
        configure(incremental(64));
        Scene scene = furnace_box(0.6F);
        const Entity pane =
            add(scene.world, at({0, -5, 0}), MeshInstance{square(0.02F, diffuse({1, 1, 1}, true))});
        static_cast<void>(render(scene, size));
        // Outside of the box, and still outside.
        move(scene.world, pane, {0.3F, 0, 0});
        VplReport report = frame(scene);
        CHECK(report.traced == 0);
        CHECK(report.debt + report.stale == 0);
        // Around the light, in all directions but a few: below it, 4 cm wide at 1 cm.
        scene.world.set(pane, at({0.2F, 0.29F, -0.1F}));
        report = frame(scene);
        // It spans 4 asin(4 / 5) of 4π; the solid angle of a square of half width 2 at height 1.
        const double stopped = 4.0 * std::asin(0.8) / (4.0 * 3.14159265);
        // Each path's bounces are 1 + 0.6 + 0.36 in the mean. Of some 33 low-discrepancy paths.
        const double expected = stopped * report.requested;
        CHECK(report.debt + report.traced > 0.7 * expected);
        CHECK(report.debt + report.traced < 1.4 * expected);
        settle(scene);
        CHECK(render(scene, size) == regenerated(scene));
    }

    TEST_CASE_FIXTURE(Refresh, "a light that creeps keeps its paths, and gives them other flux") {
        configure(incremental(128));
        Scene scene = cornell_box();
        const Picture before = render(scene, size);
        move(scene.world, scene.light, {0.005F, -0.002F, 0.0F});
        const VplReport report = frame(scene);
        // Of a room's surfaces as seen from the light half a centimetre hides behind the blocks' edges.
        CHECK(report.debt + report.traced < report.requested / 16);
        CHECK(report.stale > report.requested / 2);
        CHECK(picture != before);
    }

    TEST_CASE_FIXTURE(Refresh, "a spot that turns drops at once what its cone no longer reaches") {
        configure(incremental(64));
        Scene scene = furnace_box(0.5F);
        scene.world.remove<PointLight>(scene.light);
        scene.world.set(scene.light, looking({0, 0, 0}, {0, -1, 0}, {0, 0, 1}));
        scene.world.set(scene.light, SpotLight{.intensity = 2.0F, .inner_cone = 0.1F, .outer_cone = 0.3F});
        static_cast<void>(render(scene, size));
        const std::uint32_t all = vpls().alive;
        // A cone of 0.3 rad, turned by 0.7: both have no ray in common.
        scene.world.set(scene.light, looking({0, 0, 0}, {std::sin(0.7F), -std::cos(0.7F), 0}, {0, 0, 1}));
        const VplReport report = frame(scene);
        CHECK(report.traced > 0);
        CHECK(report.alive == report.traced);
        CHECK(report.debt + report.traced == all);
        settle(scene);
        CHECK(render(scene, size) == regenerated(scene));
    }

    TEST_CASE_FIXTURE(Refresh, "after a teleport the error is back within VPLs / budget frames") {
        configure(incremental(128));
        Scene scene = cornell_box();
        static_cast<void>(render(scene, size));
        move(scene.world, scene.light, {-0.4F, -0.8F, 0.3F});
        Configuration many = renderer.configuration();
        many.vpls = {.count = 4096, .bounces = 3, .budget = 0};
        TestedRenderer reference(context->get_proc());
        REQUIRE(reference.configure(many).empty());
        const RenderTarget target(device, size);
        reference.render(scene.world, scene.camera, target.target());
        const Picture wanted = target.read();
        const double regenerated_error = relative_mse(regenerated(scene), wanted);
        for (std::uint32_t i = 0; i < 128 / budget; ++i) static_cast<void>(frame(scene));
        CHECK(relative_mse(picture, wanted) <= 1.2 * regenerated_error);
    }

    TEST_CASE_FIXTURE(Refresh,
                      "a light that is switched off is out in the same frame, and others take its share") {
        configure(incremental(64));
        Scene scene = cornell_box();
        const Entity second = add(scene.world, at({0.3F, 1.0F, 0.2F}), PointLight{.intensity = 4.0F});
        static_cast<void>(render(scene, size));
        const glm::dvec3 both = vpls().flux.emitted;
        scene.world.edit<PointLight>(second, [](auto& light) { light.intensity = 0.0F; });
        const VplReport report = frame(scene);
        const double off = 4.0 * 4.0 * 3.14159265;
        CHECK(report.flux.emitted.r == doctest::Approx(both.r - off).epsilon(1e-4));
        settle(scene);
        CHECK(render(scene, size) == regenerated(scene));
    }

    TEST_CASE_FIXTURE(Refresh, "while one of several lights moves, no path of the others is made anew") {
        configure(incremental(128));
        Scene scene = cornell_box();
        for (const float x : {-0.5F, 0.5F}) {
            add(scene.world, at({x, 1.2F, 0.3F}), PointLight{.intensity = 2.0F, .range = 5.0F});
        }
        static_cast<void>(render(scene, size));
        move(scene.world, scene.light, {0.01F, 0, 0});
        const VplReport report = frame(scene);
        // The lights' fluxes are as what is stale of them; those at rest have nothing stale.
        CHECK(report.stale > 0);
        CHECK(report.stale < report.requested);
        settle(scene);
        CHECK(render(scene, size) == regenerated(scene));
    }

    TEST_CASE_FIXTURE(Refresh,
                      "random edits: every frame keeps account and budget, and debt comes to an end") {
        for (const unsigned sequence : {1U, 2U, 3U, 4U, 5U, 6U}) {
            CAPTURE(sequence);
            const VplVisibility visibility = sequence % 2 == 0 ? VplVisibility::maps : VplVisibility::none;
            RandomEdits edits(cornell_box(), incremental(96, visibility), test_seed(sequence));
            check_edits(edits, 40);
        }
    }

    TEST_CASE_FIXTURE(Refresh, "random edits among hundreds of lights, most of them without a path") {
        for (const unsigned sequence : {1U, 2U}) {
            CAPTURE(sequence);
            Scene scene = cluttered_room();
            scene.light = add(scene.world, at({0.1F, 1.4F, 0.2F}), PointLight{.intensity = 3.0F});
            add_ranged_lights(scene.world, 300, 0.7F);
            RandomEdits edits(std::move(scene), incremental(96, VplVisibility::maps), test_seed(sequence));
            check_edits(edits, 30);
            CHECK(vpls().paths < renderer.report().lights.count / 2);
        }
    }

    TEST_CASE_FIXTURE(Refresh, "without surfaces nothing is owed, and with them again all comes back") {
        RandomEdits edits(cornell_box(), incremental(64, VplVisibility::maps), 1);
        Scene& scene = edits.scene;
        check_edits(edits, 10);
        CHECK(vpls().alive > 0);
        edits.clear_meshes();
        static_cast<void>(frame(scene));
        CHECK(vpls().alive == 0);
        move(scene.world, scene.light, {0.1F, 0, 0});
        static_cast<void>(frame(scene));
        settle(scene);
        CHECK(render(scene, size) == regenerated(scene));
        add(scene.world, at({0, 1, 0}), MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.5F)))});
        static_cast<void>(frame(scene));
        settle(scene);
        CHECK(vpls().alive > 0);
        CHECK(render(scene, size) == regenerated(scene));
    }

    TEST_CASE_FIXTURE(Refresh,
                      "after refinement a move keeps the last set's VPLs, and pays off within the budget") {
        for (const VplVisibility visibility : {VplVisibility::none, VplVisibility::maps}) {
            CAPTURE(to_string(visibility));
            Configuration refining = incremental(64, visibility);
            refining.refinement = {.enabled = true, .frames = 16};
            configure(refining);
            Scene scene = cornell_box();
            add(scene.world, looking({0.5F, 1.5F, 1.0F}, {0, 0, 0}), SpotLight{.intensity = 3.0F});
            const Entity pane =
                add(scene.world, at({0, -5, 0}), MeshInstance{square(0.02F, diffuse({1, 1, 1}, true))});
            struct Edit {
                std::string name;
                bool keeps_all;  ///< whether no path is stopped by it
                std::function<void()> apply;
            };
            const std::vector<Edit> edits = {
                {"light moves", false,
                 [&] {
                     move(scene.world, scene.light, {0.1F, -0.05F, 0.0F});
                 }},
                {"camera moves", true,
                 [&] {
                     move(scene.world, scene.camera, {0.05F, 0.0F, 0.0F});
                 }},
                // What is outside of the box stops nothing in it, but has every path tested.
                {"mesh moves", true,
                 [&] {
                     move(scene.world, pane, {0.3F, 0.0F, 0.0F});
                 }},
                {"light brightens", true,
                 [&] { scene.world.edit<PointLight>(scene.light, [](auto& l) { l.intensity *= 1.01F; }); }},
            };
            for (const Edit& edit : edits) {
                CAPTURE(edit.name);
                for (int i = 0; i < 4; ++i) static_cast<void>(render(scene, size));
                REQUIRE(renderer.report().refined >= 4);
                const std::uint32_t alive = vpls().alive;
                edit.apply();
                const VplReport report = frame(scene);
                CHECK(renderer.report().refined == 1);
                CHECK(report.stale > alive / 2);
                // Maps that may show what moved are debt, too.
                if (edit.keeps_all && visibility == VplVisibility::none) CHECK(report.debt == 0);
                // Maps come first, and may take all of the budget.
                CHECK(report.traced + report.maps_drawn > 0);
                settle(scene);
                CHECK(renderer.report().refined == 1);
                CHECK(picture == regenerated(scene));
            }
        }
    }

    TEST_CASE_FIXTURE(Refresh, "another world, another seed and an invalidated renderer start over") {
        configure(incremental(64));
        Scene scene = cornell_box();
        Scene other = cornell_box();
        move(other.world, other.light, {0.2F, -0.3F, 0});
        static_cast<void>(render(scene, size));
        CHECK(render(other, size) == regenerated(other));
        Configuration configuration = incremental(64);
        configuration.vpls.seed = 5;
        configure(configuration);
        CHECK(render(other, size) == regenerated(other));
        configuration.vpls.count = 32;
        configure(configuration);
        CHECK(render(other, size) == regenerated(other));
        move(other.world, other.light, {0.2F, 0.1F, 0});
        renderer.invalidate();
        CHECK(render(other, size) == regenerated(other));
    }

    TEST_CASE("boxes lie around what moved, came or went, and around nothing else") {
        const auto small = square(1.0F, diffuse({1, 1, 1}));
        const auto large = square(3.0F, diffuse({1, 1, 1}));
        Material glass;
        glass.alpha_mode = AlphaMode::blend;
        const auto pane = square(2.0F, std::make_shared<const Material>(glass));
        const auto placed = [](glm::vec3 by) {
            glm::mat4 matrix(1.0F);
            matrix[3] = glm::vec4(by, 1.0F);
            return matrix;
        };
        const SceneGeometry before{{{small}, {large}, {pane}}};
        const ScenePlacement before_at{{placed({0, 0, 0}), placed({0, 5, 0}), placed({0, 9, 0})}};
        CHECK(moved_boxes(before, before_at, before, before_at).empty());
        // The blended pane moves: light is not traced against it.
        const ScenePlacement pane_at{{placed({0, 0, 0}), placed({0, 5, 0}), placed({7, 9, 0})}};
        CHECK(moved_boxes(before, before_at, before, pane_at).empty());
        const ScenePlacement after_at{{placed({10, 0, 0}), placed({0, 5, 0}), placed({0, 9, 0})}};
        const auto boxes = moved_boxes(before, before_at, before, after_at);
        CHECK(boxes.size() == 2);
        CHECK(std::ranges::count(boxes, Box{{-1, 0, -1}, {1, 0, 1}}) == 1);
        CHECK(std::ranges::count(boxes, Box{{9, 0, -1}, {11, 0, 1}}) == 1);
        // The small one goes, and the others' indices shift.
        const SceneGeometry fewer{{{large}, {pane}}};
        const ScenePlacement fewer_at{{placed({0, 5, 0}), placed({0, 9, 0})}};
        CHECK(moved_boxes(before, before_at, fewer, fewer_at) == std::vector<Box>{{{-1, 0, -1}, {1, 0, 1}}});
    }
}
