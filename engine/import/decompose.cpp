#include "engine/import/decompose.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace candela {

namespace {

// Tolerance for perpendicular axes (cosine of the angle). Axes stored in single precision are perpendicular
// to about 1e-7; ten times that for a product of a few matrices, and a safety factor of ten.
constexpr double perpendicular = 1e-5;

// An axis shorter than this fraction of the longest one has no reliable direction.
constexpr double vanishing = 1e-9;

bool are_perpendicular(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    return std::abs(glm::dot(a, b)) <= tolerance * glm::length(a) * glm::length(b);
}

// Rotates columns p and q of `a` in their plane so that they become perpendicular, and applies the same
// rotation to columns p and q of `v` (one step of the one-sided Jacobi method: Hestenes, "Inversion of
// Matrices by Biorthogonalization", 1958).
void make_perpendicular(glm::dmat3& a, glm::dmat3& v, int p, int q) {
    const double overlap = glm::dot(a[p], a[q]);
    const double zeta = (glm::dot(a[q], a[q]) - glm::dot(a[p], a[p])) / (2.0 * overlap);
    const double tangent = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
    const double cosine = 1.0 / std::hypot(1.0, tangent);
    const double sine = cosine * tangent;
    for (glm::dmat3* matrix : {&a, &v}) {
        const glm::dvec3 column = (*matrix)[p];
        (*matrix)[p] = cosine * column - sine * (*matrix)[q];
        (*matrix)[q] = sine * column + cosine * (*matrix)[q];
    }
}

// Returns the rotation V for which the columns of `a`·V are perpendicular, and replaces `a` by that product.
glm::dmat3 make_perpendicular(glm::dmat3& a, double tolerance) {
    constexpr int sweeps = 30;  // converges quadratically: six are usual for 3 × 3
    constexpr std::array<std::array<int, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
    glm::dmat3 v(1.0);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        bool done = true;
        for (const auto& [p, q] : pairs) {
            if (are_perpendicular(a[p], a[q], tolerance)) continue;
            make_perpendicular(a, v, p, q);
            done = false;
        }
        if (done) break;
    }
    return v;
}

glm::dvec3 any_perpendicular(const glm::dvec3& unit) {
    const glm::dvec3 axis = std::abs(unit.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(glm::cross(unit, axis));
}

// Unit directions of perpendicular columns. Columns of (almost) zero length get directions that complete an
// orthonormal frame.
glm::dmat3 directions(const glm::dmat3& columns, const glm::dvec3& lengths) {
    const double longest = std::max({lengths.x, lengths.y, lengths.z});
    if (longest == 0.0) return glm::dmat3(1.0);
    glm::dmat3 frame(0.0);
    glm::bvec3 known(false);
    for (int i = 0; i < 3; ++i) {
        known[i] = lengths[i] > vanishing * longest;
        if (known[i]) frame[i] = columns[i] / lengths[i];
    }
    for (int i = 0; i < 3; ++i) {
        const int next = (i + 1) % 3;
        const int last = (i + 2) % 3;
        if (known[i] && !known[next] && !known[last]) {
            frame[next] = any_perpendicular(frame[i]);
            known[next] = true;
        }
    }
    for (int i = 0; i < 3; ++i) {
        if (!known[i]) frame[i] = glm::cross(frame[(i + 1) % 3], frame[(i + 2) % 3]);
    }
    return frame;
}

}  // namespace

std::vector<Transform> decompose(const glm::dmat4& matrix) {
    glm::dmat3 axes(matrix);
    const bool sheared = !are_perpendicular(axes[0], axes[1], perpendicular) ||
                         !are_perpendicular(axes[0], axes[2], perpendicular) ||
                         !are_perpendicular(axes[1], axes[2], perpendicular);
    const glm::dmat3 v = sheared ? make_perpendicular(axes, 1e-12) : glm::dmat3(1.0);

    glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    glm::dmat3 rotation = directions(axes, scale);
    if (glm::determinant(rotation) < 0.0) {
        rotation[0] = -rotation[0];
        scale.x = -scale.x;
    }

    Transform outer;
    outer.translation = glm::vec3(matrix[3]);
    outer.rotation = glm::normalize(glm::quat(glm::quat_cast(rotation)));
    outer.scale = glm::vec3(scale);
    if (!sheared) return {outer};

    Transform inner;
    inner.rotation = glm::normalize(glm::quat(glm::quat_cast(glm::transpose(v))));
    return {outer, inner};
}

}  // namespace candela
