#include "renderer/passes/emission_cells.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::array domains{EmissionDomain::sphere, EmissionDomain::upper_half};

using Points = std::vector<glm::dvec3>;

glm::dvec3 random_point(std::mt19937& random, EmissionDomain domain) {
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    glm::dvec3 point = glm::normalize(glm::dvec3(x, y, z));
    if (domain == EmissionDomain::upper_half) point.z = std::abs(point.z);
    return point;
}

Points random_points(std::mt19937& random, EmissionDomain domain, std::size_t count) {
    Points points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(random_point(random, domain));
    return points;
}

/// All of them within a small cap, but for the last few.
Points clustered_points(std::mt19937& random, EmissionDomain domain, std::size_t count) {
    Points points = random_points(random, domain, count);
    const glm::dvec3 centre = random_point(random, domain);
    for (std::size_t i = 0; i + 3 < count; ++i) {
        points[i] = glm::normalize(centre + 1e-3 * points[i]);
        if (domain == EmissionDomain::upper_half) points[i].z = std::abs(points[i].z);
    }
    return points;
}

double sum(const std::vector<double>& areas) {
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::size_t nearest(const Points& points, glm::dvec3 to) {
    const auto closer = [&](glm::dvec3 a, glm::dvec3 b) { return glm::dot(a, to) < glm::dot(b, to); };
    return static_cast<std::size_t>(std::ranges::max_element(points, closer) - points.begin());
}

Points icosahedron() {
    const double t = (1.0 + std::sqrt(5.0)) / 2.0;
    Points corners;
    for (const double a : {-1.0, 1.0}) {
        for (const double b : {-t, t}) {
            corners.insert(corners.end(),
                           {glm::normalize(glm::dvec3(a, b, 0)), glm::normalize(glm::dvec3(0, a, b)),
                            glm::normalize(glm::dvec3(b, 0, a))});
        }
    }
    return corners;
}

}  // namespace

TEST_SUITE("emission cells") {
    TEST_CASE("the corners of regular solids have equal cells, and holes at the middles of their faces") {
        const Points octahedron = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
        for (const Points& solid : {octahedron, icosahedron()}) {
            for (const double area : emission_cells(solid, EmissionDomain::sphere).areas) {
                CHECK(area == doctest::Approx(4.0 * pi / static_cast<double>(solid.size())).epsilon(1e-12));
            }
        }
        // Middle of an octahedron's face: (1, 1, 1) / √3. Of an icosahedron's: its circumradius in the face
        // is edge / √3 with edge² = 4 / (φ √5), so that cos² = 1 - 4 / (3 φ √5).
        const double phi = (1.0 + std::sqrt(5.0)) / 2.0;
        const double ico = std::sqrt(1.0 - 4.0 / (3.0 * phi * std::sqrt(5.0)));
        CHECK(thinnest_places(emission_cells(octahedron, EmissionDomain::sphere), 1).at(0).cosine ==
              doctest::Approx(1.0 / std::sqrt(3.0)).epsilon(1e-12));
        CHECK(thinnest_places(emission_cells(icosahedron(), EmissionDomain::sphere), 1).at(0).cosine ==
              doctest::Approx(ico).epsilon(1e-12));
    }

    TEST_CASE("few points share the domain by symmetry") {
        const glm::dvec3 up(0, 0, 1);
        const glm::dvec3 x(1, 0, 0);
        CHECK(emission_cells({}, EmissionDomain::sphere).areas.empty());
        CHECK(thinnest_places(emission_cells({}, EmissionDomain::sphere), 1).empty());
        for (const EmissionDomain domain : domains) {
            CHECK(emission_cells(Points{up}, domain).areas.at(0) == doctest::Approx(area_of(domain)));
            for (const double area : emission_cells(Points{x, -x}, domain).areas) {
                CHECK(area == doctest::Approx(area_of(domain) / 2.0));
            }
            // Two of three are one point, and share its cell.
            const auto areas = emission_cells(Points{x, -x, x}, domain).areas;
            CHECK(areas[0] == doctest::Approx(area_of(domain) / 4.0));
            CHECK(areas[1] == doctest::Approx(area_of(domain) / 2.0));
        }
        // The farthest from one point is its antipode; within the half, of a slanted one, the far end of the
        // rim.
        CHECK(thinnest_places(emission_cells(Points{up}, EmissionDomain::sphere), 1).at(0).cosine ==
              doctest::Approx(-1.0));
        CHECK(thinnest_places(emission_cells(Points{up}, EmissionDomain::upper_half), 1).at(0).cosine ==
              doctest::Approx(0.0));
        const glm::dvec3 slanted(0.6 * std::cos(1.0), 0.6 * std::sin(1.0), 0.8);
        CHECK(thinnest_places(emission_cells(Points{slanted}, EmissionDomain::upper_half), 1).at(0).cosine ==
              doctest::Approx(-0.6));
    }

    TEST_CASE("the cells of any points partition the domain, and the largest hole is where it is found" *
              doctest::test_suite("random")) {
        CHECK(rc::check("areas are not negative and sum to the domain's", [] {
            std::mt19937 random(*rc::gen::arbitrary<unsigned>());
            const EmissionDomain domain = *rc::gen::elementOf(domains);
            const auto count = *rc::gen::inRange<std::size_t>(1, 200);
            const Points points = *rc::gen::arbitrary<bool>() ? random_points(random, domain, count)
                                                              : clustered_points(random, domain, count);
            const auto areas = emission_cells(points, domain).areas;
            RC_ASSERT(areas.size() == points.size());
            RC_ASSERT(std::ranges::all_of(areas, [](double area) { return area >= 0.0; }));
            // Rounding of some thousand triangles of a size of 1 each.
            RC_ASSERT(std::abs(sum(areas) - area_of(domain)) < 1e-9);
        }));
        CHECK(rc::check("no place tried at random is farther from all points than the hole's middle", [] {
            std::mt19937 random(*rc::gen::arbitrary<unsigned>());
            const EmissionDomain domain = *rc::gen::elementOf(domains);
            const Points points = random_points(random, domain, *rc::gen::inRange<std::size_t>(1, 60));
            const EmptyCircle hole = thinnest_places(emission_cells(points, domain), 1).at(0);
            RC_ASSERT(domain == EmissionDomain::sphere || hole.centre.z > -1e-12);
            const glm::dvec3 closest = points[nearest(points, hole.centre)];
            RC_ASSERT(std::abs(glm::dot(closest, hole.centre) - hole.cosine) < 1e-12);
            for (int i = 0; i < 2000; ++i) {
                const glm::dvec3 place = random_point(random, domain);
                RC_ASSERT(glm::dot(points[nearest(points, place)], place) > hole.cosine - 1e-9);
            }
        }));
    }

    TEST_CASE("each cell has the area that points thrown at random find") {
        std::mt19937 random(3);
        constexpr int thrown = 200'000;
        for (const EmissionDomain domain : domains) {
            const Points points = random_points(random, domain, 40);
            std::vector<int> hits(points.size(), 0);
            for (int i = 0; i < thrown; ++i) ++hits[nearest(points, random_point(random, domain))];
            const auto areas = emission_cells(points, domain).areas;
            for (std::size_t i = 0; i < points.size(); ++i) {
                // Five standard errors of a binomial count; one hit stands for the rarest.
                const double share = areas[i] / area_of(domain);
                CHECK(std::abs(hits[i] - share * thrown) < 5.0 * std::sqrt(share * thrown) + 1.0);
            }
        }
    }

    TEST_CASE("several thin places keep apart") {
        std::mt19937 random(5);
        const Points points = random_points(random, EmissionDomain::sphere, 30);
        const auto places = thinnest_places(emission_cells(points, EmissionDomain::sphere), 8);
        REQUIRE(places.size() == 8);
        for (std::size_t i = 1; i < places.size(); ++i) {
            CHECK(places[i].cosine >= places[i - 1].cosine);
            for (std::size_t j = 0; j < i; ++j) {
                CHECK(glm::dot(places[i].centre, places[j].centre) <= places[i].cosine + 1e-12);
            }
        }
    }

    TEST_CASE("starts go to the domain and back, and equal shares of the square to equal areas") {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> uniform;
        for (const auto kind : {gpu::LightKind::point, gpu::LightKind::spot, gpu::LightKind::directional}) {
            const double lowest = kind == gpu::LightKind::point ? -1.0 : 0.0;
            constexpr int drawn = 100'000;
            std::array<int, 16> found{};
            for (int i = 0; i < drawn; ++i) {
                const glm::dvec2 start(uniform(random), uniform(random));
                const glm::dvec3 point = to_emission_domain(kind, start);
                CHECK(glm::length(point) == doctest::Approx(1.0).epsilon(1e-12));
                CHECK(point.z >= lowest - 1e-12);
                // Near the pole the way back loses half of the digits.
                CHECK(glm::distance(from_emission_domain(kind, point), start) < 1e-6);
                // Four rings of equal height, four quadrants: equal areas (Archimedes).
                const auto ring = std::min(3, static_cast<int>(4.0 * (point.z - lowest) / (1.0 - lowest)));
                const auto quadrant = (point.x < 0.0 ? 1 : 0) + (point.y < 0.0 ? 2 : 0);
                ++found.at(static_cast<std::size_t>(4 * ring + quadrant));
            }
            for (const int count : found) {
                CHECK(std::abs(count - drawn / 16) < 5.0 * std::sqrt(drawn / 16.0));
            }
        }
    }
}
