// What light surfels emit, and that they follow moving objects.

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "shaders/bindings.glsl"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/seed.hpp"

TEST_SUITE("surfels: light") {

using namespace candela;

namespace {

constexpr double pi = glm::pi<double>();

class SurfelTests : public RenderFixture {
 protected:
    static Configuration surfels(std::uint32_t count, std::uint32_t bounces = 8) {
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.vpls = {.placement = VplPlacement::surfels,
                              .count = count,
                              .bounces = bounces,
                              .seed = 0,
                              .guided = false};
        return configuration;
    }
};

/// A closed box with a lamp inside, on a ground of 1 km in the sun. The camera is in the box.
Scene room_on_ground() {
    Scene scene = furnace_box(0.7F);
    add(scene.world, at({0.0F, -1.5F, 0.0F}), MeshInstance{square(500.0F, diffuse(glm::vec3(0.8F)))});
    add(scene.world, looking({0.0F, 0.0F, 0.0F}, {0.3F, -1.0F, 0.2F}),
        DirectionalLight{.illuminance = 10.0F});
    return scene;
}

}  // namespace

TEST_CASE_FIXTURE(SurfelTests,
                  "in a sphere lit from its centre, indirect light is uniform and little is lost") {
    // Indirect radiance ρ/π · I/R² · ρ/(1 - ρ), at any albedo: steps go on until little is left. Discs
    // take off what is nearer than their radius: of 256 surfels of 16 points each, some 16⁻¹ of 256⁻¹ of
    // the sphere a bounce, times a logarithm.
    for (const float albedo : {0.5F, 0.8F, 0.99F, 0.999F}) {
        CAPTURE(albedo);
        Scene scene;
        add(scene.world, Transform{}, MeshInstance{sphere_inwards(2.0F, 4, diffuse(glm::vec3(albedo)))});
        scene.light = add(scene.world, Transform{}, PointLight{.intensity = 3.0F});
        scene.camera = add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
        configure(surfels(256, 64));
        renderer.invalidate();
        const Picture picture = render(scene, {48, 36});
        const double rho = albedo;
        const double expected = rho / pi * 3.0 / 4.0 * rho / (1.0 - rho);
        CHECK(mean(picture) == doctest::Approx(expected).epsilon(0.02));
        for (const glm::vec3& pixel : picture.pixels) {
            CHECK(static_cast<double>(pixel.r) == doctest::Approx(expected).epsilon(0.06));
        }
        const EnergyAccount flux = renderer.report().vpls->flux;
        CHECK(flux.truncated.r != 0.0);  // fewer bounces than allowed
        CHECK(std::abs(flux.truncated.r) < 2e-3 * flux.emitted.r);
    }
}

TEST_CASE_FIXTURE(SurfelTests, "two rooms have all of their light, however long each keeps each colour") {
    // After 64 bounces, half of the light of an albedo of 0.99 would be missing.
    const glm::vec3 first(0.99F, 0.5F, 0.9F), second(0.6F, 0.985F, 0.95F);
    Scene scene;
    for (const bool is_second : {false, true}) {
        const glm::vec3 centre(is_second ? 6.0F : 0.0F, 0.0F, 0.0F);
        const auto material = diffuse(is_second ? second : first);
        add(scene.world, at(centre), MeshInstance{sphere_inwards(2.0F, 4, material)});
        add(scene.world, at(centre), PointLight{.intensity = is_second ? 0.5F : 3.0F});
    }
    scene.camera = add(scene.world, Transform{}, Camera{.vertical_fov = 1.4F});
    Configuration configuration = surfels(512, 64);
    configuration.visibility.method = VplVisibility::rays;
    configure(configuration);
    for (const bool is_second : {false, true}) {
        CAPTURE(is_second);
        const glm::vec3 at_wall(is_second ? 6.5F : 0.5F, 0.3F, 1.0F);
        scene.world.set(scene.camera, looking(at_wall, at_wall - glm::vec3(0.5F, 0.3F, 1.0F)));
        const Picture picture = render(scene, {24, 18});
        glm::dvec3 sum(0.0);
        for (const glm::vec3& pixel : picture.pixels) sum += glm::dvec3(pixel);
        const glm::dvec3 rho(is_second ? second : first);
        // As above: the radiance is the same everywhere.
        const glm::dvec3 expected = rho / pi * (is_second ? 0.5 : 3.0) / 4.0 * rho / (1.0 - rho);
        const glm::dvec3 found = sum / static_cast<double>(picture.pixels.size());
        for (int c = 0; c < 3; ++c) CHECK(found[c] == doctest::Approx(expected[c]).epsilon(0.03));
    }
}

TEST_CASE_FIXTURE(SurfelTests, "a long corridor has all of its light, however white its walls are") {
    // All that a light of 1 cd emits is absorbed: 4π lm = (1 - ρ) A E for the mean irradiance E of the walls,
    // of which the account knows the flux. It has two slow modes at least: light that is nearer to one end.
    const auto mesh = box_inwards(1.0F, diffuse(glm::vec3(0.5F, 0.99F, 0.999F)));
    Scene scene;
    add(scene.world, Transform{.scale = {6.0F, 1.0F, 1.0F}}, MeshInstance{mesh});
    scene.light = add(scene.world, at({-5.0F, 0.1F, 0.2F}), PointLight{});
    scene.camera = add(scene.world, looking({5.5F, 0, 0}, {0, 0, 0}), Camera{});
    configure(surfels(512, all_bounces));
    static_cast<void>(render(scene, {16, 12}));
    const EnergyAccount flux = renderer.report().vpls->flux;
    for (int c = 0; c < 3; ++c) {
        CAPTURE(c);
        CHECK(std::abs(flux.truncated[c]) < 2e-3 * flux.emitted[c]);
        // Form factors are reciprocal to some per cent only, near the edges.
        CHECK(flux.absorbed[c] == doctest::Approx(4.0 * pi).epsilon(0.03));
    }
}

TEST_CASE_FIXTURE(SurfelTests, "an albedo of 1 or more is bounded in a closed room, and named") {
    // As if it were 0.9992.
    const auto mean_of = [&](float albedo) {
        configure(surfels(256, all_bounces));
        renderer.invalidate();
        const Picture picture = render(furnace_box(albedo), {16, 12});
        CHECK(is_sane(picture));
        static_cast<void>(renderer.report());
        return mean(picture) / static_cast<double>(albedo);
    };
    const double white = mean_of(1.0F);
    // ρ/π E of the last reflection, whose albedo is that of the picture: 4 I / A / (1 - ρ) of the walls, 24
    // m².
    CHECK(white == doctest::Approx(4.0 / 24.0 / (1.0 - 0.9992)).epsilon(0.05));
    CHECK(mean_of(1.5F) == doctest::Approx(white).epsilon(0.01));
}

TEST_CASE_FIXTURE(SurfelTests, "a floor that lies twice in one place reflects as one") {
    // With four floors of 16 m² instead of one, the light under the ceiling would be 3.5 times as much.
    const auto light_with = [&](const std::vector<float>& heights) {
        Scene scene = cornell_box();
        for (const float height : heights) {
            add(scene.world, at({0.0F, height, 0.0F}), MeshInstance{square(0.9F, diffuse(glm::vec3(0.7F)))});
        }
        configure(surfels(512, 64));
        renderer.invalidate();
        return mean(render(scene, {24, 18}));
    };
    const double once = light_with({1e-3F});
    // Fewer surfels, at other places: some per cent.
    CHECK(light_with({1e-3F, 1e-3F}) == doctest::Approx(once).epsilon(0.03));
    CHECK(light_with({1e-3F, 1.1e-3F}) == doctest::Approx(once).epsilon(0.03));
    CHECK(light_with({1e-3F, 1e-3F, 1e-3F, 1e-3F}) == doctest::Approx(once).epsilon(0.03));
}

TEST_CASE_FIXTURE(SurfelTests,
                  "all flux that is emitted in furnished rooms is absorbed, escapes or is truncated") {
    for (const char* const name : {"cornell", "two-rooms"}) {
        CAPTURE(name);
        const Scene scene = shipped_scene(name);
        configure(surfels(512, 64));
        renderer.invalidate();
        static_cast<void>(render(scene, {16, 12}));
        const EnergyAccount flux = renderer.report().vpls->flux;
        const auto sum = [](glm::dvec3 rgb) { return rgb.r + rgb.g + rgb.b; };
        const double accounted = sum(flux.absorbed) + sum(flux.escaped) + sum(flux.truncated);
        // The two form factors of a pair are reciprocal only up to the shapes of the discs, which are far
        // from those of narrow parts of cells at the foot of a wall.
        CHECK(accounted == doctest::Approx(sum(flux.emitted)).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(SurfelTests, "the light of a dim face hardly depends on the placement of surfels") {
    // The front of the short block of the Cornell box is lit by the walls alone. With 1,024 VPLs on paths
    // its mean is off by a factor of two from one seed to the next.
    Scene scene = cornell_box();
    const glm::vec3 middle(0.33F, 0.3F, 0.39F);
    scene.world.set(scene.camera, looking(middle + glm::vec3(-0.23F, 0.0F, 0.77F), middle));
    scene.world.set(scene.camera, Camera{.vertical_fov = 0.8F});
    constexpr int seeds = 24;
    double sum = 0.0, squares = 0.0;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
        Configuration configuration = surfels(512, 64);
        configuration.vpls.seed = seed;
        configuration.visibility.method = VplVisibility::maps;
        configure(configuration);
        const double light = mean(render(scene, {16, 16}));
        sum += light / seeds;
        squares += light * light / seeds;
    }
    // The most and the least of eight are then 2.85 · 3 % = 8.6 % apart (the mean range of eight normal
    // numbers).
    CHECK(std::sqrt(squares - sum * sum) < 0.03 * sum);
}

TEST_CASE_FIXTURE(SurfelTests, "a room on a ground of 1 km has the indirect light that it has alone") {
    Configuration configuration = surfels(256, 64);
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 64};
    configure(configuration);
    const Scene room = furnace_box(0.7F);
    const double alone = mean(render(room, {32, 24}));
    // Another set of surfels: its light differs by a few per cent.
    CHECK(mean(render(room_on_ground(), {32, 24})) == doctest::Approx(alone).epsilon(0.06));
}

TEST_CASE_FIXTURE(SurfelTests, "light from the ground far around a closed room does not leak into it") {
    Configuration configuration = surfels(256, 64);
    configuration.visibility = {.method = VplVisibility::none, .map_resolution = 64};
    configure(configuration);
    Scene scene = room_on_ground();
    scene.world.destroy(scene.light);
    const double unblocked = mean(render(scene, {32, 24}));
    REQUIRE(unblocked > 0.1);
    configuration.visibility.method = VplVisibility::rays;
    configure(configuration);
    CHECK(mean(render(scene, {32, 24})) == 0.0);
    // Texels of maps on the outline of the room see past it. A hundred metres away, the whole room is
    // smaller than a texel of a map of the hemisphere, and about 30 texels wide in one of the focus.
    configuration.visibility.method = VplVisibility::maps;
    configure(configuration);
    CHECK(mean(render(scene, {32, 24})) < 0.03 * unblocked);
}

TEST_CASE_FIXTURE(SurfelTests, "surfels stay while the camera moves a little, and forget where it was") {
    configure(surfels(64));
    Scene scene = room_on_ground();
    const Transform start = scene.world.get<Transform>(scene.camera);
    const auto move_by = [&](glm::vec3 offset) {
        Transform moved = start;
        moved.translation += offset;
        scene.world.set(scene.camera, moved);
        return render(scene, {32, 24});
    };
    static_cast<void>(move_by(glm::vec3(0.0F)));
    static_cast<void>(move_by({0.01F, 0.02F, -0.01F}));
    CHECK_FALSE(ran("surfel-spread"));
    static_cast<void>(move_by({30.0F, 2.0F, 0.0F}));
    CHECK(ran("surfel-visibility"));
    const Picture after = move_by({0.3F, 0.1F, -0.4F});
    CHECK(after == from_scratch(scene, {32, 24}));
}

TEST_CASE_FIXTURE(SurfelTests, "after a walk the picture is that of a new renderer, bit for bit") {
    Configuration configuration = surfels(96);
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
    configure(configuration);
    Scene scene = room_on_ground();
    add(scene.world, upside_down_at({30.0F, 5.0F, 0.0F}), MeshInstance{square(1.0F, emitter({3, 2, 1}))});
    const Entity post = add(scene.world, at({24.0F, 0.0F, 3.0F}),
                            MeshInstance{box_inwards(0.5F, diffuse(glm::vec3(0.6F), true))});
    const auto walk_to = [&](glm::vec3 eye) {
        scene.world.set(scene.camera, looking(eye, {25.0F, -1.0F, 2.0F}));
        scene.world.edit<Transform>(post, [](Transform& pose) { pose.translation.z -= 0.3F; });
        return render(scene, {32, 24});
    };
    // Around the room, into it and out again, by small and by large steps and, last, by none.
    for (const glm::vec3 eye :
         {glm::vec3(40, 2, 0), glm::vec3(38, 2, 0), glm::vec3(30, 1, 6), glm::vec3(0.0F), glm::vec3(20, 3, 1),
          glm::vec3(36, 3, 4), glm::vec3(33, 3, 4), glm::vec3(33, 3, 4)}) {
        CAPTURE(eye.x);
        const Picture picture = walk_to(eye);
        CHECK(mean(picture) > 0.0);
        CHECK(picture == fresh_picture(scene, {32, 24}));
    }
}

TEST_CASE_FIXTURE(SurfelTests, "a camera close to a wall does not draw the surfels of a room to it") {
    configure(surfels(512));
    Scene scene = cornell_box();
    static_cast<void>(render(scene, {16, 16}));
    scene.world.set(scene.camera, looking({-0.95F, 0.6F, -0.4F}, {-1.0F, 0.6F, -0.4F}));
    static_cast<void>(render(scene, {16, 16}));
    CHECK(ran("surfel-focus"));
    CHECK_FALSE(ran("surfels"));
}

TEST_CASE_FIXTURE(SurfelTests, "with more surfels less of a closed box's flux is lost") {
    const Scene scene = furnace_box(0.5F);
    double before = 1.0;
    for (const std::uint32_t count : {64U, 256U, 1024U}) {
        CAPTURE(count);
        configure(surfels(count, 24));
        static_cast<void>(render(scene, {16, 12}));
        const EnergyAccount flux = renderer.report().vpls->flux;
        // A light of 1 cd emits 4π lm, which 16 points per surfel integrate accurately.
        CHECK(flux.emitted.r == doctest::Approx(4.0 * pi).epsilon(0.01));
        CHECK(flux.escaped.r == 0.0);
        const double lost = std::abs(flux.emitted.r - flux.absorbed.r - flux.truncated.r) / flux.emitted.r;
        CHECK(lost < before);
        before = lost;
    }
    CHECK(before < 0.005);
}

TEST_CASE_FIXTURE(SurfelTests, "on a GPU, few dispatches gather the same bounces") {
    struct Case {
        const char* scene;
        std::uint32_t count, bounces;
        double error;
    };
    // The sums are the same in another order. With several classes of surfels each ends by itself, where the
    // last bounce adds 0.02 % at most to the light of a surfel; the light that two rooms keep is some times
    // that.
    std::vector<Case> cases;
    for (const std::uint32_t bounces : {0U, 1U, 2U, 3U, 4U, 5U, 8U, 11U, all_bounces}) {
        cases.push_back({"cornell", 256, bounces, 1e-5});
    }
    cases.push_back({"two-rooms", 512, all_bounces, 1e-5});
    cases.push_back({"two-rooms", MOST_COLUMNS + MOST_COLUMNS / 5 + 1, 8, 1e-5});
    cases.push_back({"two-rooms", MOST_COLUMNS + MOST_COLUMNS / 5 + 1, all_bounces, 2e-3});
    std::vector<Picture> pictures;
    std::vector<EnergyAccount> accounts;
    const auto show = [&](const Case& shown) {
        configure(surfels(shown.count, shown.bounces));
        renderer.invalidate();
        pictures.push_back(render(shipped_scene(shown.scene), {24, 18}));
        accounts.push_back(renderer.report().vpls->flux);
    };
    for (const bool software : {true, false}) {
        pretend(renderer, software);
        for (const Case& shown : cases) show(shown);
    }
    CHECK(pictures[cases.size() - 1] != pictures.back());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        CAPTURE(cases[i].scene);
        CAPTURE(cases[i].count);
        CAPTURE(cases[i].bounces);
        const std::size_t gpu = i + cases.size();
        const double floor = 1e-2 * mean(pictures[i]) + 1e-6;  // without bounces all is black
        CHECK(worst_error(pictures[gpu], pictures[i], floor) <= cases[i].error);
        for (const auto part : {&EnergyAccount::emitted, &EnergyAccount::absorbed, &EnergyAccount::escaped,
                                &EnergyAccount::truncated}) {
            const glm::dvec3 apart = accounts[gpu].*part - accounts[i].*part;
            CHECK(glm::length(apart) <= cases[i].error * glm::length(accounts[i].emitted));
        }
    }
}

TEST_CASE_FIXTURE(SurfelTests, "where surfels gather from a part of the others, all flux is accounted for") {
    const Scene scene = shipped_scene("two-rooms");
    for (const std::uint32_t stride : {2U, 4U}) {
        CAPTURE(stride);
        // About as many as are asked for are placed.
        configure(surfels(MOST_COLUMNS * (stride - 1) + MOST_COLUMNS / 5 + 1, all_bounces));
        static_cast<void>(render(scene, {16, 12}));
        const EnergyAccount flux = renderer.report().vpls->flux;
        const double lost = std::abs(flux.emitted.r - flux.absorbed.r - flux.escaped.r - flux.truncated.r);
        // As many surfels as these lose less in a closed box: see above. Were one of them to gather what
        // others send to its neighbours, it would be 0.03.
        CHECK(lost < 0.005 * flux.emitted.r);
    }
}

TEST_CASE_FIXTURE(SurfelTests,
                  "without bounces there is no indirect light, and each further bounce adds less") {
    const Scene scene = cornell_box();
    configure(surfels(64, 0));
    const Picture dark = render(scene, {24, 18});
    CHECK(mean(dark) == 0.0);
    configure(surfels(64, 1));
    const Picture once = render(scene, {24, 18});
    configure(surfels(64, 2));
    const Picture twice = render(scene, {24, 18});
    configure(surfels(64, 8));
    const Picture more = render(scene, {24, 18});
    CHECK(mean(once) > 0.0);
    CHECK(mean(twice) > mean(once));
    CHECK(mean(more) > mean(twice));
    // Each bounce adds less than the one before, by a factor of the scene's albedo.
    CHECK(mean(more) - mean(twice) < 3.0 * (mean(twice) - mean(once)));
}

TEST_CASE_FIXTURE(SurfelTests, "a light close to a wall lights a room with all of its flux") {
    Scene scene = furnace_box(0.5F);
    for (const float distance : {0.0F, 0.003F, 0.02F, 0.1F}) {
        scene.world.set(scene.light, at({1.0F - distance, 0.2F, 0.1F}));
        for (std::uint32_t seed = 0; seed < 4; ++seed) {
            CAPTURE(distance);
            CAPTURE(seed);
            Configuration configuration = surfels(256);
            configuration.vpls.seed = seed;
            configure(configuration);
            static_cast<void>(render(scene, {8, 6}));
            // A light of 1 cd emits 4π lm. Half of them fall on the wall: the sum over its points has a
            // standard deviation of 6 % (shaders/README.md, "Lights close to a surface"). They are some 0.08
            // m apart; from so high, 8 % of that half would miss a wall that is 1 m wide on all sides.
            const double emitted = renderer.report().vpls->flux.emitted.r;
            CHECK(emitted == doctest::Approx(4.0 * pi).epsilon(0.5 * (3.0 * 0.06 + 0.08)));
        }
    }
}

TEST_CASE_FIXTURE(SurfelTests, "light that falls between the points of cells through a slit is found") {
    // A floor under two plates that face down, with a slit of 1 cm between them, in the sun from above.
    constexpr float width = 0.01F, half = 2.0F;
    Scene scene;
    const auto white = diffuse(glm::vec3(0.5F));
    add(scene.world, Transform{}, MeshInstance{square(half, white)});
    for (const float side : {-1.0F, 1.0F}) {
        Transform over = at({side * (3.0F + 0.5F * width), 0.5F, 0.0F});
        over.rotation = glm::angleAxis(glm::pi<float>(), glm::vec3(0, 0, 1));
        add(scene.world, over, MeshInstance{square(3.0F, white)});
    }
    add(scene.world, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}), DirectionalLight{.illuminance = 1.0F});
    scene.camera = add(scene.world, looking({0, 0.3F, 1.5F}, {0, 0, 0}), Camera{});
    const double expected = static_cast<double>(2.0F * half * width);
    constexpr int sets = 16;
    double square_error = 0.0;
    for (std::uint32_t seed = 0; seed < sets; ++seed) {
        Configuration configuration = surfels(512);
        configuration.vpls.seed = seed;
        configure(configuration);
        static_cast<void>(render(scene, {8, 6}));
        const double error = renderer.report().vpls->flux.emitted.r / expected - 1.0;
        square_error += error * error / sets;
    }
    // The slit's light falls on 0.04 m². The floor has two elevenths of the surfels, 1,490 points of
    // 0.011 m², so that one ray from each finds it 3.7 times: a relative error of about 1/√3.7 = 0.52.
    // Eight rays find it 30 times, 1/√30 = 0.18 if they were independent; but they are around the points.
    CHECK(std::sqrt(square_error) < 0.4);
}

TEST_CASE_FIXTURE(SurfelTests, "a light exactly on a wall lights the room like one just in front of it") {
    Scene scene = furnace_box(0.5F);
    configure(surfels(256, 2));
    const auto lit_from = [&](float x) {
        scene.world.set(scene.light, at({x, 0.2F, 0.1F}));
        return mean(render(scene, {24, 18}));
    };
    // The lit spot on the wall that the light is on is nearly the same.
    CHECK(lit_from(1.0F) == doctest::Approx(lit_from(0.999F)).epsilon(0.05));
}

TEST_CASE_FIXTURE(SurfelTests, "light from a floor does not leak through a wall that stands on it") {
    // The cells of few surfels extend under the wall. Behind the wall there are only the floor, which does
    // not light itself, and the back of the wall.
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(2.0F, diffuse(glm::vec3(0.8F)))});
    const glm::quat upright = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 0, 1));
    add(scene.world, Transform{.translation = {0, 0, 0}, .rotation = upright},
        MeshInstance{square(2.0F, diffuse(glm::vec3(0.8F), true))});
    scene.light = add(scene.world, at({1.0F, 1.0F, 0}), PointLight{.intensity = 10.0F});
    scene.camera = add(scene.world, looking({-1.0F, 1.5F, 0.1F}, {-0.3F, 0.3F, 0}), Camera{});
    for (const std::uint32_t count : {50U, 1500U}) {
        for (const auto method : {VplVisibility::maps, VplVisibility::rays}) {
            CAPTURE(count);
            Configuration configuration = surfels(count);
            configuration.visibility.method = method;
            configure(configuration);
            const double behind = mean(render(scene, {32, 24}));
            Scene before = scene;
            before.world.set(before.camera, looking({1.0F, 1.5F, 0.1F}, {0.3F, 0.3F, 0}));
            renderer.invalidate();
            const double lit = mean(render(before, {32, 24}));
            CHECK(lit > 0.05);
            CHECK(behind < 1e-3 * lit);
        }
    }
}

TEST_CASE_FIXTURE(SurfelTests,
                  "a bare wall is lit smoothly, also if walls on cells make more surfels than asked for") {
    // So many are few enough for one loop of the shading pass on a software driver, but a tenth more are not.
    Scene scene = furnace_box(0.5F);
    const glm::quat upright = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 0, 1));
    for (const float x : {-0.77F, -0.53F, -0.21F, 0.13F, 0.37F, 0.59F, 0.83F}) {
        add(scene.world, Transform{.translation = {x, -1.0F, 0}, .rotation = upright},
            MeshInstance{square(1.0F, diffuse(glm::vec3(0.5F), true))});
    }
    scene.world.set(scene.camera, looking({0, 0.2F, 0}, {0, 1.0F, 0.1F}));
    scene.world.set(scene.camera, Camera{.vertical_fov = 1.0F});
    configure(surfels(2100, 2));
    const Picture picture = render(scene, {16, 12});
    // On a wall the light of each surfel is a smooth function. Across a pixel of an eighth of a radian, the
    // curvature of the irradiance from a lit wall beside it is up to about an eighth squared of it.
    for (std::uint32_t y = 1; y + 1 < picture.size.y; ++y) {
        for (std::uint32_t x = 1; x + 1 < picture.size.x; ++x) {
            const auto at = [&](std::uint32_t u, std::uint32_t v) { return picture.at(u, v).g; };
            CAPTURE(x);
            CAPTURE(y);
            CHECK(std::abs(at(x - 1, y) - 2.0F * at(x, y) + at(x + 1, y)) < 0.03F * at(x, y));
            CHECK(std::abs(at(x, y - 1) - 2.0F * at(x, y) + at(x, y + 1)) < 0.03F * at(x, y));
        }
    }
}

TEST_CASE_FIXTURE(SurfelTests, "no light is lost where a wall stands on a cell") {
    // A light of 1 cd in a closed box emits 4π lm, wherever there are walls in it. The points of 128
    // cells, which are half a metre wide, integrate it to about 0.5 %, less in the mean of three sets.
    for (const float x : {-0.37F, -0.2F, 0.6F}) {
        CAPTURE(x);
        Scene scene = furnace_box(0.5F);
        const glm::quat upright = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 0, 1));
        add(scene.world, Transform{.translation = {x, 0, 0}, .rotation = upright},
            MeshInstance{square(1.0F, diffuse(glm::vec3(0.5F), true))});
        scene.world.set(scene.light, at({0.2F, 0.1F, 0.0F}));
        double emitted = 0.0;
        for (std::uint32_t seed = 0; seed < 3; ++seed) {
            Configuration configuration = surfels(128, 2);
            configuration.vpls.seed = seed;
            configure(configuration);
            static_cast<void>(render(scene, {16, 12}));
            emitted += renderer.report().vpls->flux.emitted.r / 3.0;
        }
        CHECK(emitted == doctest::Approx(4.0 * pi).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(SurfelTests, "cells are divided where walls stand now, not where they stood") {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(2.0F, diffuse(glm::vec3(0.8F)))});
    const Entity wall =
        add(scene.world, Transform{}, MeshInstance{square(1.0F, diffuse(glm::vec3(0.6F), true))});
    scene.light = add(scene.world, at({1.0F, 1.0F, 0.4F}), PointLight{.intensity = 10.0F});
    scene.camera = add(scene.world, looking({-1.5F, 1.5F, 1.0F}, {0, 0.2F, 0}), Camera{});
    configure(surfels(50));
    for (int i = 0; i < 8; ++i) {
        CAPTURE(i);
        const auto part = static_cast<float>(i) / 7.0F;
        const glm::quat turned = glm::angleAxis(part, glm::vec3(0, 1, 0)) *
                                 glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 0, 1));
        scene.world.set(wall, Transform{.translation = {1.2F * part - 0.6F, 0, 0}, .rotation = turned});
        const Picture moved = render(scene, {32, 24});
        CHECK(ran("surfels"));
        CHECK(moved == from_scratch(scene, {32, 24}));
        CHECK(moved == render(scene, {32, 24}));
        CHECK_FALSE(ran("surfels"));
    }
}

}  // TEST_SUITE("surfels: light")
