// How cells are divided where surfaces cut them, and the rays on the CPU that find it.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/passes/scene/traced_scene.hpp"
#include "renderer/passes/scene/world_triangles.hpp"
#include "renderer/passes/surfels/cell_division.hpp"
#include "tests/renderer/items_of_meshes.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/seed.hpp"

using namespace candela;

namespace {

/// Meshes of one primitive each.
class Surroundings {
 public:
    void add(const std::shared_ptr<const Mesh>& mesh, const glm::mat4& world = glm::mat4(1.0F)) {
        add_item(layout_, mesh);
        placement_.world.push_back(world);
        hierarchy_.update(layout_, placement_);
    }

    [[nodiscard]] TracedScene traced() const { return {hierarchy_, layout_, placement_}; }

    /// All triangles, in world space.
    [[nodiscard]] std::vector<Triangle> triangles() const {
        std::vector<Triangle> all;
        layout_.visit_solids([&](std::uint32_t i) {
            const std::vector<Triangle> own =
                placed_in_world(layout_, layout_.drawables[i], placement_).triangles();
            all.insert(all.end(), own.begin(), own.end());
        });
        return all;
    }

 private:
    SceneLayout layout_;
    ScenePlacement placement_;
    SceneHierarchy hierarchy_;
};

constexpr float ray_offset = 1e-4F;
constexpr glm::vec3 up(0.0F, 1.0F, 0.0F);

/// A square in the plane x = `x`, from y = -height to height.
glm::mat4 upright(float x, float height = 1.0F) {
    const glm::mat4 moved = glm::translate(glm::mat4(1.0F), {x, 0.0F, 0.0F});
    const glm::mat4 turned = glm::rotate(moved, glm::half_pi<float>(), {0.0F, 0.0F, 1.0F});
    return glm::scale(turned, {height, 1.0F, 1.0F});
}

std::shared_ptr<const Mesh> wall() {
    return square(1.0F, diffuse(glm::vec3(0.5F), true));
}

/// Adds a cell of 1 m² whose surfel is at the first of its points, and has its normal. The points have equal
/// areas.
void add_cell(SurfelSet& set, const std::vector<glm::vec3>& positions,
              const std::vector<glm::vec3>& normals) {
    const auto first = static_cast<std::uint32_t>(set.points.size());
    const auto count = static_cast<std::uint32_t>(positions.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        set.points.push_back({.position = positions[i],
                              .material = 0,
                              .normal = normals[i],
                              .area = 1.0F / static_cast<float>(count),
                              .uv = glm::vec2(0.0F),
                              .surfel = static_cast<std::uint32_t>(set.surfels.size()),
                              .colour = 0xffffffffU,
                              .middle = positions[i]});
        set.point_places.push_back(
            {.solid = 0, .triangle = first + i, .weights = glm::vec2(0.3F), .back = false});
    }
    set.surfels.push_back({.position = positions[0],
                           .first_point = first,
                           .normal = normals[0],
                           .point_count = count,
                           .area = 1.0F,
                           .width2 = 1.0F});
    set.ids.push_back(set.surfels.size());
    set.patches.push_back(set.surfels.size());
    set.surfel_places.push_back(set.point_places[first]);
    set.item_of.push_back(static_cast<std::uint32_t>(set.surfels.size() % 3));
}

/// A cell on the floor y = 0, in the square from -0.5 to 0.5 along x and z, of n × n points.
void add_floor_cell(SurfelSet& set, int n) {
    std::vector<glm::vec3> positions;
    for (int i = 0; i < n * n; ++i) {
        const auto at = [&](int k) { return (static_cast<float>(k) + 0.5F) / static_cast<float>(n) - 0.5F; };
        positions.emplace_back(at(i / n), 0.0F, at(i % n));
    }
    add_cell(set, positions, std::vector<glm::vec3>(positions.size(), up));
}

SurfelSet floor_cell(int n = 8) {
    SurfelSet set;
    add_floor_cell(set, n);
    return set;
}

SurfelSet divided_in(const Surroundings& surroundings, const SurfelSet& set) {
    std::vector<CellDivision> cells;
    for (std::size_t i = 0; i < set.surfels.size(); ++i) {
        cells.push_back(divide_cell(set, i, surroundings.traced(), {}, ray_offset));
    }
    return divided(set, cells);
}

double area_of(const SurfelSet& set) {
    double area = 0.0;
    for (const gpu::Surfel& surfel : set.surfels) area += static_cast<double>(surfel.area);
    return area;
}

/// Checks that surfels and points refer to each other, and that areas and places belong to them.
void check_consistent(const SurfelSet& set) {
    CHECK(set.surfel_places.size() == set.surfels.size());
    CHECK(set.item_of.size() == set.surfels.size());
    CHECK(set.point_places.size() == set.points.size());
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < set.surfels.size(); ++i) {
        const gpu::Surfel& surfel = set.surfels[i];
        CHECK(surfel.first_point == next);
        CHECK(surfel.point_count > 0);
        next += surfel.point_count;
        float area = 0.0F;
        bool is_at_point = false;
        for (std::uint32_t p = surfel.first_point; p < next; ++p) {
            CHECK(set.points[p].surfel == i);
            area += set.points[p].area;
            is_at_point |= set.points[p].position == surfel.position &&
                           set.points[p].normal == surfel.normal &&
                           set.point_places[p].triangle == set.surfel_places[i].triangle;
        }
        CHECK(is_at_point);
        CHECK(surfel.area == doctest::Approx(area));
    }
    CHECK(next == set.points.size());
}

/// Whether a surfel and all points of its cell are on the same side of x = `x`.
bool is_on_one_side(const SurfelSet& set, const gpu::Surfel& surfel, float x) {
    const auto begin = set.points.begin() + surfel.first_point;
    return std::all_of(begin, begin + surfel.point_count, [&](const gpu::CellPoint& point) {
        return (point.position.x < x) == (surfel.position.x < x);
    });
}

/// A material whose alpha is 0 in the left half of its image and 1 in the right one.
std::shared_ptr<const Material> half_hole() {
    Image image{.width = 2, .height = 1, .texels = {{255, 255, 255, 0}, {255, 255, 255, 255}}};
    image.wrap_u = Wrap::clamp_to_edge;
    Material material;
    material.base_colour_texture = std::make_shared<const Image>(std::move(image));
    material.double_sided = true;
    material.alpha_mode = AlphaMode::mask;
    return std::make_shared<const Material>(std::move(material));
}

}  // namespace

TEST_SUITE("surfels: division") {
TEST_CASE("a wall that stands on a cell divides it, and each side has a surfel") {
    Surroundings surroundings;
    surroundings.add(square(2.0F, diffuse(glm::vec3(0.5F))));
    surroundings.add(wall(), upright(0.1F));
    const SurfelSet set = divided_in(surroundings, floor_cell());
    check_consistent(set);
    REQUIRE(set.surfels.size() == 2);
    for (const gpu::Surfel& surfel : set.surfels) CHECK(is_on_one_side(set, surfel, 0.1F));
    // Five columns of points, of eight, are on the side of the first surfel, which stays.
    CHECK(set.surfels[0].position == floor_cell().surfels[0].position);
    CHECK(set.surfels[0].area == doctest::Approx(0.625));
    CHECK(set.surfels[1].area == doctest::Approx(0.375));
    // The other is at one of the two points in the middle of three columns.
    CHECK(set.surfels[1].position.x == doctest::Approx(0.3125));
    CHECK(std::abs(set.surfels[1].position.z) == doctest::Approx(0.0625));
    CHECK(set.item_of[1] == set.item_of[0]);
}

TEST_CASE("a cell stays whole in the open, beside a wall, close under a ceiling, and where it is curved") {
    Surroundings surroundings;
    surroundings.add(square(2.0F, diffuse(glm::vec3(0.5F))));
    surroundings.add(wall(), upright(0.5F));
    surroundings.add(wall(), glm::translate(glm::mat4(1.0F), {0.0F, 0.02F, 0.0F}));
    CHECK(divided_in(surroundings, floor_cell()).surfels.size() == 1);
    // A cap of a sphere of 1.5 m from its inside and from its outside; a chord is at most 0.1 m below it.
    for (const float side : {-1.0F, 1.0F}) {
        SurfelSet cap = floor_cell();
        for (gpu::CellPoint& point : cap.points) {
            const glm::vec3 out = glm::normalize(point.position + 1.5F * up);
            point.position = 1.5F * out;
            point.normal = side * out;
        }
        cap.surfels[0].position = cap.points[0].position;
        cap.surfels[0].normal = cap.points[0].normal;
        Surroundings sphere;
        sphere.add(sphere_inwards(1.5F, 4, diffuse(glm::vec3(0.5F))));
        // Facets lie up to 1.5 m · (1 - cos 2°) = 1 mm inside the sphere.
        const CellDivision division = divide_cell(cap, 0, sphere.traced(), {}, 2e-3F);
        CHECK(divided(cap, {&division, 1}).surfels.size() == 1);
    }
}

TEST_CASE("a cell is divided where it is bent by more than the cosine 0.7, which is 46 degrees") {
    for (const float degrees : {40.0F, 50.0F}) {
        SurfelSet bent;
        const float angle = glm::radians(degrees);
        const glm::vec3 other(std::sin(angle), std::cos(angle), 0.0F);
        add_cell(bent, {{-0.2F, 0, 0}, {-0.1F, 0, 0}, 0.1F * glm::vec3(other.y, -other.x, 0.0F)},
                 {up, up, other});
        const SurfelSet set = divided_in(Surroundings{}, bent);
        check_consistent(set);
        CHECK(set.surfels.size() == (degrees < 46.0F ? 1 : 2));
        CHECK(area_of(set) == doctest::Approx(1.0));
        CHECK(set.surfels.back().normal == (degrees < 46.0F ? up : other));
    }
}

TEST_CASE("a cell that emits light keeps all of its area around a closed body, in four parts") {
    SurfelSet cube;
    std::vector<glm::vec3> sides;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) sides.emplace_back(0.0F)[axis] = side;
    }
    add_cell(cube, sides, sides);
    cube.emitting_count = 1;
    const SurfelSet set = divided_in(Surroundings{}, cube);
    check_consistent(set);
    CHECK(set.surfels.size() == most_cell_parts);
    CHECK(area_of(set) == doctest::Approx(1.0));
}

TEST_CASE("of surfaces that lie on each other only the front one counts, or the first") {
    const auto floor = square(2.0F, diffuse(glm::vec3(0.5F)));
    // The area of a cell on the floor at y = 0, and of one on a floor at y = `height`.
    const auto areas = [&](float height, const std::shared_ptr<const Mesh>& other, bool upside_down = false) {
        const glm::mat4 moved = glm::translate(glm::mat4(1.0F), {0.0F, height, 0.0F});
        Surroundings surroundings;
        surroundings.add(floor);
        surroundings.add(other, upside_down ? glm::scale(moved, {1.0F, -1.0F, -1.0F}) : moved);
        const std::vector<std::uint32_t> order = order_of_solids(surroundings.traced().layout);
        std::array<double, 2> found{};
        for (std::uint32_t item = 0; item < 2; ++item) {
            SurfelSet cell = floor_cell();
            const float side = item == 1 && upside_down ? -1.0F : 1.0F;
            for (gpu::CellPoint& point : cell.points) {
                if (item == 1) point.position.y = height;
                point.normal *= side;
            }
            for (SurfacePoint& place : cell.point_places) place = {.solid = order[item]};
            cell.surfels[0].position = cell.points[0].position;
            cell.surfels[0].normal = cell.points[0].normal;
            cell.surfel_places[0] = cell.point_places[0];
            const CellDivision division = divide_cell(cell, 0, surroundings.traced(), order, ray_offset);
            const SurfelSet set = divided(cell, {&division, 1});
            check_consistent(set);
            found[item] = area_of(set);
        }
        return found;
    };
    using Areas = std::array<double, 2>;
    const auto is_about = [](const Areas& a, const Areas& b) {
        return std::abs(a[0] - b[0]) < 1e-5 && std::abs(a[1] - b[1]) < 1e-5;
    };
    CHECK(is_about(areas(0.0F, floor), {1.0, 0.0}));
    CHECK(is_about(areas(1e-4F, floor), {0.0, 1.0}));
    CHECK(is_about(areas(-1e-4F, floor), {1.0, 0.0}));
    CHECK(is_about(areas(2e-3F, floor), {1.0, 1.0}));
    // Of 8 × 8 points, 4 × 4 are less than a quarter of a metre from the middle, where the other floor is.
    CHECK(is_about(areas(1e-4F, square(0.25F, diffuse(glm::vec3(0.5F)))), {0.75, 1.0}));
    // The two sides of a sheet, each a surface of its own.
    for (const float apart : {0.0F, -1e-4F}) {
        CHECK(is_about(areas(apart, floor, true), {1.0, 1.0}));
    }
    // Of a double-sided one, the front alone is on the floor.
    CHECK(is_about(areas(0.0F, square(2.0F, diffuse(glm::vec3(0.5F), true))), {1.0, 0.0}));
}

TEST_CASE("a surfel is as high as the highest point of its part, but at most halfway below what is above") {
    SurfelSet bumpy = floor_cell(4);
    bumpy.points[5].position.y = 0.03F;
    bumpy.points[6].position.y = -0.2F;
    Surroundings open;
    CHECK(divided_in(open, bumpy).surfels[0].position.y == doctest::Approx(0.03));
    CHECK(divided_in(open, floor_cell(4)).surfels[0].position == floor_cell(4).surfels[0].position);
    Surroundings covered;
    covered.add(wall(), glm::translate(glm::mat4(1.0F), {0.0F, 0.04F, 0.0F}));
    // Rays begin at the offset.
    CHECK(divided_in(covered, bumpy).surfels[0].position.y == doctest::Approx(0.02).epsilon(0.01));
}

TEST_CASE("what stands or lies on a cell has the points below it to itself, also if it is low") {
    for (const float height : {0.01F, 0.2F, 2.0F}) {
        CAPTURE(height);
        Surroundings surroundings;
        surroundings.add(square(2.0F, diffuse(glm::vec3(0.5F))));
        // A block around the point at its middle, open below; rays begin at a tenth of a millimetre.
        const glm::vec3 half(0.21F, 0.5F * height, 0.21F);
        const glm::mat4 placed = glm::scale(glm::translate(glm::mat4(1.0F), {0.0F, half.y, 0.0F}), half);
        surroundings.add(box_inwards(1.0F, diffuse(glm::vec3(0.5F))), placed);
        const SurfelSet set = divided_in(surroundings, floor_cell(9));
        check_consistent(set);
        CHECK(area_of(set) == doctest::Approx(1.0));
        const auto is_below = [](glm::vec3 p) { return std::max(std::abs(p.x), std::abs(p.z)) < 0.21F; };
        double area_below = 0.0;
        for (const gpu::Surfel& surfel : set.surfels) {
            if (is_below(surfel.position)) area_below += static_cast<double>(surfel.area);
            for (std::uint32_t p = surfel.first_point; p < surfel.first_point + surfel.point_count; ++p) {
                CHECK(is_below(set.points[p].position) == is_below(surfel.position));
            }
        }
        // Of nine points along each axis, those at -1/9, 0 and 1/9.
        CHECK(area_below == doctest::Approx(9.0 / 81.0));
        // Rays run above a block that is lower than 0.25 m, a quarter of the width.
        CHECK(set.surfels.size() == (height < 0.25F ? 2 : 3));
    }
}

TEST_CASE("a cell has four parts at most, and what is left is dropped, emitting surfels last") {
    Surroundings strips;
    for (const float x : {-0.375F, -0.125F, 0.125F, 0.375F}) strips.add(wall(), upright(x));
    SurfelSet set;
    add_floor_cell(set, 8);
    add_floor_cell(set, 8);
    for (gpu::CellPoint& point : set.points) point.position.y += point.surfel == 0 ? 3.0F : 0.0F;
    set.surfels[0].position.y += 3.0F;  // above the walls
    set.emitting_count = 1;
    const SurfelSet parts = divided_in(strips, set);
    check_consistent(parts);
    CHECK(parts.surfels.size() == 1 + most_cell_parts);
    CHECK(parts.emitting_count == most_cell_parts);
    CHECK(parts.surfels[0].area == doctest::Approx(1.0));
    CHECK(parts.item_of[0] == set.item_of[0]);
    CHECK(parts.item_of[1] == set.item_of[1]);
    // Three strips have two columns of the eight, the two at the ends have one.
    const double dropped = 2.0 - area_of(parts);
    CHECK((dropped == doctest::Approx(0.125) || dropped == doctest::Approx(0.25)));
}

TEST_CASE("which point becomes a surfel does not depend on where the cell is") {
    // Two points are left, as far from their centroid, which is rounded.
    std::mt19937 engine(test_seed());
    std::uniform_real_distribution<float> number(-100.0F, 100.0F);
    for (int i = 0; i < 50; ++i) {
        const glm::vec3 offset(number(engine), 0.0F, number(engine));
        SurfelSet set = floor_cell(2);
        for (gpu::CellPoint& point : set.points) point.position += offset;
        set.surfels[0].position += offset;
        Surroundings surroundings;
        surroundings.add(wall(), glm::translate(glm::mat4(1.0F), offset) * upright(0.1F));
        const SurfelSet parts = divided_in(surroundings, set);
        REQUIRE(parts.surfels.size() == 2);
        CHECK(parts.surfel_places[1].triangle == 2);
    }
}

TEST_CASE("points without area or normal, as of triangles that are deformed to nothing, end nothing") {
    SurfelSet set = floor_cell(2);
    for (gpu::CellPoint& point : set.points) point.area = 0.0F, point.normal = glm::vec3(0.0F);
    set.surfels[0].area = 0.0F;
    set.surfels[0].normal = glm::vec3(0.0F);
    CHECK(divided_in(Surroundings{}, set).surfels.empty());
}

TEST_CASE("what is outside the box of a division does not change it") {
    std::mt19937 engine(test_seed());
    std::uniform_real_distribution<float> number(-1.0F, 1.0F);
    const SurfelSet set = floor_cell(4);
    const Box box = box_of_division(set, 0, ray_offset);
    int apart = 0;
    for (int i = 0; i < 300; ++i) {
        Surroundings surroundings;
        surroundings.add(soup(1, static_cast<std::uint32_t>(i), 1.0F),
                         glm::translate(glm::mat4(1.0F), {number(engine), number(engine), 0.0F}));
        if (meet(bounds(surroundings.triangles()[0]), box, 0.0F)) continue;
        ++apart;
        CHECK(divided_in(surroundings, set).surfels.size() == 1);
    }
    CHECK(apart > 30);
}

}  // TEST_SUITE("surfels: division")

TEST_SUITE("traced scene") {
TEST_CASE("rays meet what a single hierarchy over all triangles meets") {
    Surroundings surroundings;
    for (std::uint32_t i = 0; i < 5; ++i) {
        const glm::mat4 moved = glm::translate(glm::mat4(1.0F), {0.3F * static_cast<float>(i), 0.0F, 0.2F});
        surroundings.add(soup(200, test_seed() + i, 0.2F), glm::rotate(moved, 1.0F, up));
    }
    const std::vector<Triangle> all = surroundings.triangles();
    const Bvh bvh = build_bvh(all);
    std::mt19937 engine(test_seed());
    std::uniform_real_distribution<float> number(-1.5F, 1.5F);
    const auto point = [&] { return glm::vec3(number(engine), number(engine), number(engine)); };
    int blocked = 0;
    for (int i = 0; i < 2000; ++i) {
        const Ray ray{point(), point(), 0.0F, 1.0F};
        const auto hit = closest_hit(bvh, all, ray);
        const auto found = nearest_surface(surroundings.traced(), ray);
        REQUIRE(found.has_value() == hit.has_value());
        // Rays meet a mesh in its own space: a few roundings of coordinates below 4 m.
        if (hit) CHECK(std::abs(found->distance - hit->t) < 1e-5F);
        if (hit) CHECK(glm::dot(found->normal, ray.direction) <= 0.0F);
        const glm::vec3 to = ray.origin + ray.direction;
        const Ray between{ray.origin, to - ray.origin, 0.0F, 1.0F};
        CHECK(is_blocked(surroundings.traced(), ray.origin, to) == any_hit(bvh, all, between));
        blocked += hit ? 1 : 0;
    }
    CHECK(blocked > 200);
    CHECK(blocked < 1800);
}

TEST_CASE("rays pass through the holes of masks") {
    Surroundings surroundings;
    surroundings.add(square(1.0F, half_hole()));  // u runs along x
    const auto is_open_at = [&](float x) {
        return !is_blocked(surroundings.traced(), {x, 1.0F, 0.2F}, {x, -1.0F, 0.2F});
    };
    CHECK(is_open_at(-0.1F));
    CHECK(is_open_at(-0.9F));
    CHECK_FALSE(is_open_at(0.1F));
    CHECK_FALSE(is_open_at(0.9F));
    CHECK(is_open_at(1.1F));
}

}  // TEST_SUITE("traced scene")
