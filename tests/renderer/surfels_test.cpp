// Where surfels are, what light they emit, and that they follow moving objects.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <random>
#include <set>

#include "renderer/passes/surfels/surfels.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/seed.hpp"

using namespace candela;

namespace {

constexpr double pi = glm::pi<double>();

/// A parallelogram of two triangles.
void add_parallelogram(SceneTriangles& scene, std::uint32_t item, glm::vec3 corner, glm::vec3 u,
                       glm::vec3 v) {
    const auto add_triangle = [&](glm::vec3 a, glm::vec3 ab, glm::vec3 ac) {
        gpu::TraceTriangle triangle{};
        triangle.a = a;
        triangle.edge_ab = ab;
        triangle.edge_ac = ac;
        scene.triangles.push_back(triangle);
        scene.item_of.push_back(item);
    };
    add_triangle(corner, u, v);
    add_triangle(corner + u + v, -u, -v);
}

/// The six sides of a cube with edges of 2 m, each with its own normal.
SceneTriangles cube() {
    SceneTriangles scene{.triangles = {}, .item_of = {}, .double_sided = {false}, .emits = {false}};
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            glm::vec3 normal(0.0F), u(0.0F);
            normal[axis] = side;
            u[(axis + 1) % 3] = 2.0F;
            const glm::vec3 v = glm::cross(normal, u);
            add_parallelogram(scene, 0, normal - 0.5F * (u + v), u, v);
        }
    }
    return scene;
}

SurfelSet placed(const SceneTriangles& scene, const SurfelCounts& counts, std::uint32_t seed,
                 const std::vector<std::vector<Focus>>& foci = {}) {
    return SurfelPlacement(scene, seed).place(counts, foci);
}

double total_area(const SurfelSet& set) {
    double area = 0.0;
    for (const gpu::Surfel& surfel : set.surfels) area += static_cast<double>(surfel.area);
    return area;
}

class SurfelTests : public RenderFixture {
 protected:
    static Configuration surfels(std::uint32_t count, std::uint32_t bounces = 8) {
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.vpls = {
            .placement = VplPlacement::surfels, .count = count, .bounces = bounces, .seed = 0};
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

TEST_SUITE("surfels: placement") {
    TEST_CASE("cells cover the area of all surfaces, and have about equal areas") {
        for (const std::uint32_t count : {24U, 100U, 1000U}) {
            CAPTURE(count);
            const SurfelSet set = placed(cube(), {.reflecting = count}, test_seed());
            CHECK(set.surfels.size() <= count);
            CHECK(set.surfels.size() > 0.8 * count);
            CHECK(total_area(set) == doctest::Approx(24.0).epsilon(1e-4));
            const double mean = 24.0 / static_cast<double>(set.surfels.size());
            double squares = 0.0;
            for (const gpu::Surfel& surfel : set.surfels) {
                const double off = static_cast<double>(surfel.area) / mean - 1.0;
                squares += off * off;
            }
            // More even than the cells of random points, whose areas have a standard deviation of 0.53 times
            // their mean (Voronoi cells: Gilbert, 1962).
            CHECK(std::sqrt(squares / static_cast<double>(set.surfels.size())) < 0.5);
        }
    }

    TEST_CASE("a cell is flat, on one side of the surface, and near its surfel") {
        const SurfelSet set = placed(cube(), {.reflecting = 200}, test_seed());
        const float width = std::sqrt(24.0F / 200.0F);
        std::size_t points = 0;
        for (const gpu::Surfel& surfel : set.surfels) {
            REQUIRE(surfel.first_point == points);
            for (std::uint32_t i = 0; i < surfel.point_count; ++i, ++points) {
                const gpu::CellPoint& point = set.points[points];
                CHECK(glm::dot(point.normal, surfel.normal) > 0.999F);
                CHECK(std::abs(glm::dot(point.position - surfel.position, surfel.normal)) < 1e-5F);
                CHECK(glm::distance(point.position, surfel.position) < 2.0F * width);
                CHECK(set.surfels[point.surfel].first_point == surfel.first_point);
            }
        }
        CHECK(points == set.points.size());
    }

    TEST_CASE("double-sided surfaces have surfels on both sides, others on their front") {
        SceneTriangles sheet{.triangles = {}, .item_of = {}, .double_sided = {false}, .emits = {false}};
        add_parallelogram(sheet, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        for (const bool both : {false, true}) {
            sheet.double_sided[0] = both;
            const SurfelSet set = placed(sheet, {.reflecting = 50}, 0);
            const auto front = std::ranges::count_if(
                set.surfels, [](const gpu::Surfel& surfel) { return surfel.normal.z > 0.5F; });
            CHECK(total_area(set) == doctest::Approx(both ? 2.0 : 1.0).epsilon(1e-4));
            CHECK(static_cast<double>(front) / static_cast<double>(set.surfels.size()) ==
                  doctest::Approx(both ? 0.5 : 1.0).epsilon(0.1));
        }
    }

    TEST_CASE("no cell extends to another item, even in the same plane") {
        SceneTriangles two{.triangles = {}, .item_of = {}, .double_sided = {false}, .emits = {false}};
        add_parallelogram(two, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        add_parallelogram(two, 1, {1, 0, 0}, {1, 0, 0}, {0, 1, 0});
        const SurfelSet set = placed(two, {.reflecting = 40}, test_seed());
        for (std::size_t i = 0; i < set.surfels.size(); ++i) {
            const gpu::Surfel& surfel = set.surfels[i];
            for (std::uint32_t p = 0; p < surfel.point_count; ++p) {
                CHECK((set.points[surfel.first_point + p].position.x < 1.0F) == (set.item_of[i] == 0));
            }
        }
    }

    TEST_CASE("surfels are dense in a focus, less so beyond it, and cover all of the surface") {
        constexpr float half = 500.0F;
        constexpr float radius = 5.0F;
        SceneTriangles plane{.triangles = {}, .item_of = {}, .double_sided = {false}, .emits = {false}};
        add_parallelogram(plane, 0, {-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0});
        const Focus focus{glm::vec3(3.0F, -2.0F, 0.0F), radius};
        const SurfelSet set = placed(plane, {.reflecting = 1000}, test_seed(), {{focus}});
        const auto radii = [&](const gpu::Surfel& surfel) {
            return glm::distance(surfel.position, focus.centre) / radius;
        };
        CHECK(total_area(set) == doctest::Approx(4.0 * half * half).epsilon(1e-4));
        // The density falls with the third power of the distance r: within R there are πR² parts of the
        // surfels, beyond it ∫ 2πr (R/r)³ dr = 2πR² (1 - R/500 m). It is constant within parts of half a
        // distance.
        const auto inside =
            std::ranges::count_if(set.surfels, [&](const auto& surfel) { return radii(surfel) < 1.0F; });
        CHECK(static_cast<double>(inside) / static_cast<double>(set.surfels.size()) ==
              doctest::Approx(1.0 / 3.0).epsilon(0.2));
        // Cells are as wide as the inverse root of the density: 100 m away, 20^1.5 = 89 times as wide.
        double near = 0.0, far = 0.0, near_count = 0.0, far_count = 0.0;
        for (const gpu::Surfel& surfel : set.surfels) {
            const double width = std::sqrt(static_cast<double>(surfel.area));
            if (radii(surfel) < 1.0F) near += width, ++near_count;
            if (radii(surfel) > 15.0F && radii(surfel) < 25.0F) far += width, ++far_count;
        }
        CHECK((far / far_count) / (near / near_count) > 30.0);
    }

    TEST_CASE("most surfels stay where a focus moves a little, and where it was before does not matter") {
        SceneTriangles plane{.triangles = {}, .item_of = {}, .double_sided = {false}, .emits = {false}};
        add_parallelogram(plane, 0, {-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0});
        const auto focus_at = [](float x) {
            return std::vector<std::vector<Focus>>{{Focus{.centre = {x, 2.0F, 0.0F}, .radius = 5.0F}}};
        };
        const SurfelCounts counts{.reflecting = 500};
        SurfelPlacement walked(plane, test_seed());
        SurfelSet before;
        for (const float x : {300.0F, 0.0F, 0.3F, 0.6F}) {
            CAPTURE(x);
            const SurfelSet set = walked.place(counts, focus_at(x));
            const SurfelSet fresh = placed(plane, counts, test_seed(), focus_at(x));
            CHECK(set.ids == fresh.ids);
            CHECK(std::ranges::equal(set.points, fresh.points, {}, &gpu::CellPoint::position,
                                     &gpu::CellPoint::position));
            if (x > 0.0F && x < 1.0F) {
                const std::set<std::uint64_t> known(before.ids.begin(), before.ids.end());
                const auto stay =
                    std::ranges::count_if(set.ids, [&](std::uint64_t id) { return known.contains(id); });
                // A step of 6 % of the radius changes the density by at most 3 · 6 %, and a cell is cut for
                // an eighth of an octave at most, of the one in which it may be.
                CHECK(static_cast<double>(stay) > 0.7 * static_cast<double>(set.ids.size()));
            }
            before = set;
        }
    }

    TEST_CASE("of many items some have surfels, which stand for all") {
        constexpr int count = 3000;
        SceneTriangles many{.triangles = {}, .item_of = {}, .double_sided = {false}, .emits = {false}};
        double area = 0.0;
        for (int i = 0; i < count; ++i) {
            const float size = i % 7 == 0 ? 2.0F : 0.5F;
            add_parallelogram(many, static_cast<std::uint32_t>(i), {3.0F * static_cast<float>(i), 0, 0},
                              {size, 0, 0}, {0, size, 0});
            area += static_cast<double>(size * size);
        }
        constexpr int sets = 32;
        double mean = 0.0;
        for (int i = 0; i < sets; ++i) {
            const SurfelSet set = placed(many, {.reflecting = 200}, test_seed() + static_cast<unsigned>(i));
            CHECK(set.surfels.size() == 200);
            mean += total_area(set) / sets;
        }
        // Some fifty items are chosen for each set, each at random: the mean of 32 sets is off by about
        // 1 / √1600, 2.5 %. Four times as much is hardly ever.
        CHECK(mean == doctest::Approx(area).epsilon(0.1));
    }

    TEST_CASE("triangles without an area have no surfels and do no harm") {
        SceneTriangles scene{.triangles = {}, .item_of = {}, .double_sided = {true}, .emits = {false}};
        add_parallelogram(scene, 0, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
        CHECK(placed(scene, {.reflecting = 20}, test_seed()).surfels.empty());
        add_parallelogram(scene, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        const SurfelSet set = placed(scene, {.reflecting = 20}, test_seed());
        CHECK(total_area(set) == doctest::Approx(2.0).epsilon(1e-4));
        CHECK(std::ranges::all_of(set.points, [](const gpu::CellPoint& point) {
            return std::abs(glm::length(point.normal) - 1.0F) < 1e-5F;
        }));
    }

    TEST_CASE("another seed gives another set, and empty input gives none") {
        CHECK(placed(cube(), {.reflecting = 100}, 1).surfels[0].position !=
              placed(cube(), {.reflecting = 100}, 2).surfels[0].position);
        CHECK(placed(cube(), {.reflecting = 0}, 1).surfels.empty());
        CHECK(placed({}, {.reflecting = 100}, 1).surfels.empty());
    }

    TEST_CASE("an item's shape does not depend on its rotation, bit for bit") {
        std::mt19937 engine(test_seed());
        std::uniform_real_distribution<float> number(-1.0F, 1.0F);
        for (const glm::vec3 scale :
             {glm::vec3(1.0F), glm::vec3(2.0F, 1.0F, 0.7F), glm::vec3(-1.0F, 0.3F, 5.0F)}) {
            const glm::mat3 shape = shape_of(glm::scale(glm::mat4(1.0F), scale));
            for (int i = 0; i < 200; ++i) {
                const glm::vec3 axis =
                    glm::normalize(glm::vec3(number(engine), number(engine), number(engine)));
                glm::mat4 world = glm::rotate(glm::mat4(1.0F), 3.0F * number(engine), axis);
                world = glm::scale(world, scale);
                world[3] = glm::vec4(number(engine), 2.0F, number(engine), 1.0F);
                CHECK(shape_of(world) == shape);
                // The rest is a rotation: mirroring is part of the shape.
                const glm::mat3 rotation = glm::mat3(world) * glm::inverse(shape);
                CHECK(glm::determinant(rotation) == doctest::Approx(1.0).epsilon(1e-3));
            }
        }
    }
}

TEST_SUITE("surfels: light") {
    TEST_CASE_FIXTURE(SurfelTests,
                      "in a sphere lit from its centre, indirect light is uniform and little is lost") {
        // Indirect radiance ρ/π · I/R² · ρ/(1 - ρ), at any albedo: bounces go on until little is left. Discs
        // take off what is nearer than their radius: of 256 surfels of 16 points each, some 16⁻¹ of 256⁻¹ of
        // the sphere a bounce, times a logarithm.
        for (const float albedo : {0.5F, 0.8F, 0.99F}) {
            CAPTURE(albedo);
            Scene scene;
            add(scene.world, Transform{}, MeshInstance{sphere_inwards(2.0F, 4, diffuse(glm::vec3(albedo)))});
            scene.light = add(scene.world, Transform{}, PointLight{.intensity = 3.0F});
            scene.camera =
                add(scene.world, looking({0.5F, 0.3F, 1.0F}, {0, 0, 0}), Camera{.vertical_fov = 1.4F});
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
            CHECK(std::abs(flux.truncated.r) < 1e-3 * flux.emitted.r / (1.0 - rho));
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
        double least = std::numeric_limits<double>::infinity(), most = 0.0;
        for (std::uint32_t seed = 0; seed < 8; ++seed) {
            Configuration configuration = surfels(512, 64);
            configuration.vpls.seed = seed;
            configuration.visibility.method = VplVisibility::maps;
            configure(configuration);
            const double light = mean(render(scene, {16, 16}));
            least = std::min(least, light);
            most = std::max(most, light);
        }
        CHECK(most - least < 0.1 * least);
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
             {glm::vec3(40, 2, 0), glm::vec3(38, 2, 0), glm::vec3(30, 1, 6), glm::vec3(0.0F),
              glm::vec3(20, 3, 1), glm::vec3(36, 3, 4), glm::vec3(33, 3, 4), glm::vec3(33, 3, 4)}) {
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
            const double lost =
                std::abs(flux.emitted.r - flux.absorbed.r - flux.truncated.r) / flux.emitted.r;
            CHECK(lost < before);
            before = lost;
        }
        CHECK(before < 0.005);
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
                // standard deviation of 6 % (theory.md, "Lights close to a surface"). They are some 0.08 m
                // apart; from so high, 8 % of that half would miss a wall that is 1 m wide on all sides.
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
        // With few surfels, whose cells extend under the wall, and with many, whose groups would. Behind the
        // wall there are only the floor, which does not light itself, and the back of the wall.
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

    TEST_CASE_FIXTURE(SurfelTests,
                      "cells and groups are divided where walls stand now, not where they stood") {
        Scene scene;
        add(scene.world, Transform{}, MeshInstance{square(2.0F, diffuse(glm::vec3(0.8F)))});
        const Entity wall =
            add(scene.world, Transform{}, MeshInstance{square(1.0F, diffuse(glm::vec3(0.6F), true))});
        scene.light = add(scene.world, at({1.0F, 1.0F, 0.4F}), PointLight{.intensity = 10.0F});
        scene.camera = add(scene.world, looking({-1.5F, 1.5F, 1.0F}, {0, 0.2F, 0}), Camera{});
        for (int i = 0; i < 12; ++i) {
            CAPTURE(i);
            // The last four with groups.
            if (i == 0) configure(surfels(50));
            if (i == 8) configure(surfels(1000));
            const auto part = static_cast<float>(i % 8) / 7.0F;
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
}
