#include <algorithm>
#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "engine/bvh/bvh.hpp"

TEST_SUITE("BVH intersect") {

namespace {

using namespace candela;

glm::vec3 draw(auto& distribution, std::mt19937& engine) {
    const auto x = static_cast<float>(distribution(engine));
    const auto y = static_cast<float>(distribution(engine));
    return {x, y, static_cast<float>(distribution(engine))};
}

TEST_CASE("intersect: hits lie strictly between t_min and t_max") {
    const Triangle triangle{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
    const auto hit = [&](float t_min, float t_max) {
        return intersect(triangle, 0, {{0.25F, 0.25F, 0}, {0, 0, 1}, t_min, t_max}).has_value();
    };
    CHECK(hit(1.0F, 3.0F));
    CHECK(hit(std::nextafter(2.0F, 0.0F), std::nextafter(2.0F, 3.0F)));
    CHECK_FALSE(hit(2.0F, 3.0F));
    CHECK_FALSE(hit(1.0F, 2.0F));
    CHECK_FALSE(hit(3.0F, 1.0F));
}

TEST_CASE("intersect: a hit solves the ray equation") {
    // The second implementation inverts the 3 × 3 system (b - a, c - a, -direction) in double precision.
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> distribution(-1.0F, 1.0F);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto point = [&] { return draw(distribution, engine); };
        const Triangle triangle{point(), point(), point()};
        const Ray ray{1.5F * point(), point()};
        const glm::dmat3 system(triangle.b - triangle.a, triangle.c - triangle.a, -ray.direction);
        const glm::dvec3 uvt = glm::inverse(system) * glm::dvec3(ray.origin - triangle.a);
        // How far inside the hit is. At the border, and for slivers, single precision may decide differently.
        const double inside = std::min({uvt.x, uvt.y, 1.0 - uvt.x - uvt.y, uvt.z});
        if (std::abs(inside) < 1e-3 || std::abs(glm::determinant(system)) < 1e-2) continue;
        const auto hit = intersect(triangle, 7, ray);
        REQUIRE(hit.has_value() == (inside > 0.0));
        if (!hit) continue;
        ++hits;
        CHECK(hit->triangle == 7);
        // A determinant of 1e-2 from terms of order 1 loses two of the seven digits; 1e-4 allows for one
        // more.
        CHECK(std::abs(static_cast<double>(hit->u) - uvt.x) < 1e-4);
        CHECK(std::abs(static_cast<double>(hit->v) - uvt.y) < 1e-4);
        CHECK(std::abs(static_cast<double>(hit->t) - uvt.z) < 1e-4 * std::max(1.0, uvt.z));
    }
    CHECK(hits > 300);
}

// For small integer coordinates this is exact: whether the ray hits inside (+1), outside (-1), or on the edge
// bc (0), where u + v = 1 and rounding decides. The other two edges and the vertex between them count as
// inside.
int exact_side(const Triangle& triangle, const Ray& ray) {
    const glm::dvec3 ab = triangle.b - triangle.a;
    const glm::dvec3 ac = triangle.c - triangle.a;
    const glm::dvec3 s = ray.origin - triangle.a;
    const glm::dvec3 p = glm::cross(glm::dvec3(ray.direction), ac);
    const glm::dvec3 q = glm::cross(s, ab);
    const double determinant = glm::dot(ab, p);
    const double sign = determinant < 0.0 ? -1.0 : 1.0;
    const double u = sign * glm::dot(s, p);
    const double v = sign * glm::dot(glm::dvec3(ray.direction), q);
    const double t = sign * glm::dot(ac, q);
    if (determinant == 0.0 || u < 0.0 || v < 0.0 || t <= 0.0 || u + v > std::abs(determinant)) return -1;
    return u + v < std::abs(determinant) ? 1 : 0;
}

TEST_CASE("intersect: hits are exact for small integer coordinates, including rays through vertices") {
    // Determinants stay below 2^24, so single precision is exact and can tell u + v < 1 from u + v = 1.
    std::mt19937 engine(2);
    std::uniform_int_distribution<int> near(-2, 2);
    std::uniform_int_distribution<int> far(-40, 40);
    int hits = 0;
    for (int i = 0; i < 200000; ++i) {
        const auto corner = [&] { return draw(near, engine); };
        const Triangle triangle{corner(), corner(), corner()};
        const glm::vec3 origin = i % 2 == 0 ? draw(far, engine) : corner();
        const glm::vec3 target = i % 3 == 0 ? triangle.a : corner();
        const Ray ray{origin, target - origin};
        const int side = exact_side(triangle, ray);
        if (side == 0) continue;
        REQUIRE(intersect(triangle, 0, ray).has_value() == (side > 0));
        hits += side > 0 ? 1 : 0;
    }
    CHECK(hits > 20000);
}

}  // namespace

}  // TEST_SUITE("BVH intersect")
