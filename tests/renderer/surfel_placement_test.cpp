// Where surfels are.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <set>
#include <vector>

#include "renderer/passes/surfels/surfel_placement.hpp"
#include "renderer/passes/surfels/surfel_spread.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/seed.hpp"

TEST_SUITE("surfels: placement") {

using namespace candela;

namespace {

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
    SceneTriangles scene{.triangles = {}, .item_of = {}, .materials = {diffuse(glm::vec3(0.5F))}};
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

/// From -1 to 1 along x and y.
SceneTriangles square() {
    SceneTriangles scene{.triangles = {}, .item_of = {}, .materials = {diffuse(glm::vec3(0.5F))}};
    add_parallelogram(scene, 0, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    return scene;
}

/// 64 x 64 points of the square, of which the left ones have all shares: this part of them.
std::vector<GuidePoint> guide_of(float part) {
    std::vector<GuidePoint> guide;
    constexpr int side = 64;
    for (int i = 0; i < side * side; ++i) {
        const glm::vec2 at = (glm::vec2(i % side, i / side) + 0.5F) / static_cast<float>(side);
        const bool first = at.x + at.y < 1.0F;  // triangle 0 has the corner at -1, -1
        guide.push_back({.place = {.triangle = first ? 0U : 1U, .weights = first ? at : 1.0F - at},
                         .area = 4.0F / (side * side),
                         .share = at.x < part ? 3.0F : 0.0F});
    }
    return guide;
}

/// How many of the surfels are not in the other set.
std::size_t new_surfels(const SurfelSet& set, const SurfelSet& before) {
    const std::set<std::uint64_t> known(before.ids.begin(), before.ids.end());
    return static_cast<std::size_t>(
        std::ranges::count_if(set.ids, [&](std::uint64_t id) { return !known.contains(id); }));
}

/// Of those on the left half of the square.
std::ptrdiff_t left_surfels(const SurfelSet& set) {
    return std::ranges::count_if(set.surfels,
                                 [](const gpu::Surfel& surfel) { return surfel.position.x < 0.0F; });
}

double total_area(const SurfelSet& set) {
    double area = 0.0;
    for (const gpu::Surfel& surfel : set.surfels) area += static_cast<double>(surfel.area);
    return area;
}

}  // namespace

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
    SceneTriangles sheet{.triangles = {}, .item_of = {}, .materials = {diffuse(glm::vec3(0.5F))}};
    add_parallelogram(sheet, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    for (const bool both : {false, true}) {
        sheet.materials.set(0, diffuse(glm::vec3(0.5F), both));
        const SurfelSet set = placed(sheet, {.reflecting = 50}, 0);
        const auto front = std::ranges::count_if(
            set.surfels, [](const gpu::Surfel& surfel) { return surfel.normal.z > 0.5F; });
        CHECK(total_area(set) == doctest::Approx(both ? 2.0 : 1.0).epsilon(1e-4));
        CHECK(static_cast<double>(front) / static_cast<double>(set.surfels.size()) ==
              doctest::Approx(both ? 0.5 : 1.0).epsilon(0.1));
    }
}

TEST_CASE("no point is in a hole of a mask, and cells have the area of what is left") {
    // The left half of the square is a hole: alpha reaches the cutoff midway between the two texels.
    Material material = *diffuse(glm::vec3(0.5F), true);
    material.alpha_mode = AlphaMode::mask;
    material.base_colour_texture = std::make_shared<const Image>(Image{
        .width = 2, .height = 1, .texels = {{0, 0, 0, 0}, {0, 0, 0, 255}}, .wrap_u = Wrap::clamp_to_edge});
    SceneTriangles scene = square();
    scene.materials = {std::make_shared<const Material>(std::move(material))};
    for (gpu::TraceTriangle& triangle : scene.triangles) {
        const auto uv_of = [](glm::vec3 corner) { return 0.5F * glm::vec2(corner) + 0.5F; };
        triangle.uv_a = uv_of(triangle.a);
        triangle.uv_b = uv_of(triangle.a + triangle.edge_ab);
        triangle.uv_c = uv_of(triangle.a + triangle.edge_ac);
        triangle.colour_a = triangle.colour_b = triangle.colour_c = 0xffffffffU;
    }
    const SurfelSet set = placed(scene, {.reflecting = 100}, test_seed());
    for (const gpu::CellPoint& point : set.points) CHECK(point.position.x >= 0.0F);
    for (const gpu::Surfel& surfel : set.surfels) {
        REQUIRE(surfel.point_count > 0);
        CHECK(surfel.position.x >= 0.0F);
        double area = 0.0;
        for (std::uint32_t p = 0; p < surfel.point_count; ++p) {
            area += static_cast<double>(set.points[surfel.first_point + p].area);
        }
        CHECK(static_cast<double>(surfel.area) == doctest::Approx(area));
    }
    // Both sides of the right half have 2 m² each. Of 1,600 parts, about 60 are cut by the edge, and each has
    // a point on either side of it at random: √60 / 2 parts.
    CHECK(total_area(set) == doctest::Approx(4.0).epsilon(0.03));
}

TEST_CASE("no cell extends to another item, even in the same plane") {
    SceneTriangles two{.triangles = {}, .item_of = {}, .materials = {diffuse(glm::vec3(0.5F))}};
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
    SceneTriangles plane{.triangles = {}, .item_of = {}, .materials = {diffuse(glm::vec3(0.5F))}};
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

TEST_CASE("surfels are dense where a guide says that light comes from, and the rest has a part by area") {
    const SurfelSet set =
        SurfelPlacement(square(), test_seed()).place({.reflecting = 480}, {}, guide_of(0.5F));
    const std::ptrdiff_t left = left_surfels(set);
    // Light counts 1 and area 0.2, of which the right half has half: 0.1 of 1.2. The worth of cells, of which
    // the most is cut, varies by a factor of 4, more than its mean does.
    const double share_right = 1.0 - static_cast<double>(left) / static_cast<double>(set.surfels.size());
    CHECK(share_right > 0.5 / 12.0);
    CHECK(share_right < 2.0 / 12.0);
    CHECK(total_area(set) == doctest::Approx(4.0).epsilon(1e-4));
}

TEST_CASE("a guide without light changes nothing") {
    const std::vector<GuidePoint> dark{{.place = {.triangle = 0}, .area = 1.0F, .share = 0.0F}};
    const SurfelSet plain = placed(cube(), {.reflecting = 100}, test_seed());
    const SurfelSet guided = SurfelPlacement(cube(), test_seed()).place({.reflecting = 100}, {}, dark);
    CHECK(plain.ids == guided.ids);
}

TEST_CASE("most surfels stay where a focus moves a little, and where it was before does not matter") {
    SceneTriangles plane{.triangles = {}, .item_of = {}, .materials = {diffuse(glm::vec3(0.5F))}};
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
            const std::size_t stay = set.ids.size() - new_surfels(set, before);
            // A step of 6 % of the radius changes the density by at most 3 · 6 %, and a cell is cut for
            // an eighth of an octave at most, of the one in which it may be.
            CHECK(static_cast<double>(stay) > 0.7 * static_cast<double>(set.ids.size()));
        }
        before = set;
    }
}

TEST_CASE("a set that follows changes by no more cells than it may, first where most light comes from") {
    constexpr std::uint32_t most_new = 12;
    const SurfelCounts counts{.reflecting = 200};
    SurfelPlacement placement(square(), test_seed());
    SurfelSet set = placement.place(counts);
    const std::vector<GuidePoint> guide = guide_of(0.5F);
    const SurfelSet wanted = SurfelPlacement(square(), test_seed()).place(counts, {}, guide);
    const std::ptrdiff_t begin = left_surfels(set), end = left_surfels(wanted);
    const std::size_t to_change = new_surfels(wanted, set);
    REQUIRE(to_change > 8 * most_new);
    std::size_t steps = 0;
    do {
        const SurfelSet before = set;
        set = placement.place(counts, {}, guide, {&before.cut, most_new});
        REQUIRE(++steps < 1000);
        CHECK(set.surfels.size() <= counts.reflecting);
        CHECK(total_area(set) == doctest::Approx(4.0).epsilon(1e-4));
        // A patch that is opened gives two cells.
        CHECK(new_surfels(set, before) <= most_new + 1);
        // A third of the cells that are replaced are the closed ones, of little light.
        if (steps == 1) CHECK(left_surfels(set) > begin);
    } while (set.left.all > 0);
    CHECK(left_surfels(set) == end);
    CHECK(set.ids == wanted.ids);
    // Each step has its number of them; cells on the way to those that are wanted cost no more than as many.
    CHECK(steps <= 2 * (to_change / most_new + 1));
}

TEST_CASE("a set that follows only what is worth it stays where others are worth little more") {
    const SurfelCounts counts{.reflecting = 200};
    SurfelPlacement placement(square(), test_seed());
    const SurfelSet before = placement.place(counts, {}, guide_of(0.5F));
    const LastCut worth_double{.cut = &before.cut, .most_new = 200, .gain = 2.0};
    // A 32nd more of the square has light: a 16th of what had it.
    const SurfelSet nearly = placement.place(counts, {}, guide_of(0.53125F), worth_double);
    const SurfelSet at_once = placement.place(counts, {}, guide_of(0.53125F));
    CHECK(new_surfels(at_once, before) > 0);
    CHECK(2 * new_surfels(nearly, before) < new_surfels(at_once, before));
    CHECK(nearly.left.all > 0);
    CHECK(nearly.left.gains == 0);
    // All light elsewhere. What is worth less than double is halves of a cell: of those that are wanted there
    // are at least about half.
    std::vector<GuidePoint> right = guide_of(0.5F);
    for (GuidePoint& point : right) point.share = 3.0F - point.share;
    const SurfelSet moved = placement.place(counts, {}, right, worth_double);
    const auto right_of = [](const SurfelSet& set) { return std::ssize(set.surfels) - left_surfels(set); };
    CHECK(right_of(moved) > 0.45 * static_cast<double>(right_of(placement.place(counts, {}, right))));
    CHECK(right_of(moved) > 2 * right_of(before));
}

TEST_CASE("where items come and go, a set that follows keeps the cells of the others") {
    SceneTriangles one = square();
    SceneTriangles two = square();
    add_parallelogram(two, 1, {9, -1, 0}, {2, 0, 0}, {0, 2, 0});
    const SurfelCounts counts{.reflecting = 64};
    const SurfelSet before = placed(one, counts, test_seed());
    SurfelPlacement placement(two, test_seed());
    SurfelSet set = placement.place(counts, {}, {}, {&before.cut, 8});
    CHECK(new_surfels(set, before) <= 9);
    CHECK(total_area(set) == doctest::Approx(8.0).epsilon(1e-4));
    for (int step = 0; set.left.all > 0; ++step) {
        REQUIRE(step < 100);
        const PatchCut last = set.cut;
        set = placement.place(counts, {}, {}, {&last, 8});
    }
    CHECK(set.ids == placed(two, counts, test_seed()).ids);
    const SurfelSet again = SurfelPlacement(one, test_seed()).place(counts, {}, {}, {&set.cut, 64});
    CHECK(again.ids == before.ids);
}

TEST_CASE("of many items some have surfels, which stand for all") {
    constexpr int count = 3000;
    SceneTriangles many{.triangles = {}, .item_of = {}, .materials = {diffuse(glm::vec3(0.5F))}};
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
        for (const gpu::Surfel& surfel : set.surfels) CHECK(surfel.own * surfel.area <= 4.001F);
        mean += total_area(set) / sets;
    }
    // Some fifty items are chosen for each set, each at random: the mean of 32 sets is off by about
    // 1 / √1600, 2.5 %. Four times as much is hardly ever.
    CHECK(mean == doctest::Approx(area).epsilon(0.1));
}

TEST_CASE("however many items emit light, each has a surfel, and they have all of their area") {
    std::size_t before = 0;
    for (const std::uint32_t count : {1U, 16U, 17U, 64U, 65U, 300U, most_emitting_items}) {
        CAPTURE(count);
        Material glowing;
        glowing.emissive = glm::vec3(1.0F);
        SceneTriangles lamps{
            .triangles = {}, .item_of = {}, .materials = {std::make_shared<const Material>(glowing)}};
        double area = 0.0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const float size = i % 7 == 0 ? 1.0F : 0.1F;
            add_parallelogram(lamps, i, {3.0F * static_cast<float>(i), 0, 0}, {size, 0, 0}, {0, size, 0});
            area += static_cast<double>(size * size);
        }
        const SurfelSet set = placed(lamps, {.reflecting = 100, .emitting = 64}, test_seed());
        CHECK(set.emitting_count == set.surfels.size());
        CHECK(std::set(set.item_of.begin(), set.item_of.end()).size() == count);
        CHECK(total_area(set) == doctest::Approx(area).epsilon(1e-4));
        // One more lamp takes nothing from the others.
        CHECK(set.surfels.size() == 64 + count - 1);
        CHECK(set.surfels.size() >= before);
        before = set.surfels.size();
    }
}

TEST_CASE("triangles without an area have no surfels and do no harm") {
    SceneTriangles scene{.triangles = {}, .item_of = {}, .materials = {diffuse(glm::vec3(0.5F), true)}};
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
            const glm::vec3 axis = glm::normalize(glm::vec3(number(engine), number(engine), number(engine)));
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

}  // TEST_SUITE("surfels: placement")
