#include "renderer/passes/surfels/scene_surfaces.hpp"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>

namespace candela {
namespace {

/// Moments of the fronts.
SurfaceMoments moments_of(const PlacedMesh& mesh) {
    SurfaceMoments moments;
    for (std::uint32_t i = 0; i < mesh.count(); ++i) {
        const Triangle triangle = mesh.triangle(i);
        const Corners corners = corners_of(triangle);
        moments.add(corners, area_of(corners), normal_of(triangle, false));
    }
    return moments;
}

std::array<float, 9> numbers_of(const glm::mat3& matrix) {
    std::array<float, 9> numbers{};
    std::copy_n(glm::value_ptr(matrix), numbers.size(), numbers.begin());
    return numbers;
}

}  // namespace

glm::vec3 normal_of(const Triangle& triangle, bool back) {
    const glm::vec3 front = glm::normalize(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
    return back ? -front : front;
}

double area_of(const Corners& corners) {
    return 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

glm::dvec2 weights_at(const Corners& triangle, const glm::dvec3& place) {
    const glm::dvec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0], to = place - triangle[0];
    const glm::dvec3 normal = glm::cross(ab, ac);
    return glm::dvec2(glm::dot(glm::cross(to, ac), normal), glm::dot(glm::cross(ab, to), normal)) /
           glm::dot(normal, normal);
}

void SurfaceMoments::add(const Corners& corners, double of_area, const glm::dvec3& facing) {
    for (const glm::dvec3& corner : corners) box.grow(glm::vec3(corner));
    if (!(of_area > 0.0)) return;
    const glm::dvec3 sum = corners[0] + corners[1] + corners[2];
    area += of_area;
    position += of_area / 3.0 * sum;
    // The mean of x² over a triangle is (Σ xᵢ² + (Σ xᵢ)²) / 12.
    position2 += of_area / 12.0 *
                 (corners[0] * corners[0] + corners[1] * corners[1] + corners[2] * corners[2] + sum * sum);
    normal += of_area * facing;
    normal2 += of_area * facing * facing;
}

void SurfaceMoments::add(const SurfaceMoments& other) {
    area += other.area;
    position += other.position;
    position2 += other.position2;
    normal += other.normal;
    normal2 += other.normal2;
    box.grow(other.box);
}

SurfaceMoments SurfaceMoments::turned() const {
    SurfaceMoments moments = *this;
    moments.normal = -normal;
    return moments;
}

SurfaceMoments SurfaceMoments::scaled(float size) const {
    const auto s = static_cast<double>(size);
    return {.area = s * s * area,
            .position = s * s * s * position,
            .position2 = s * s * s * s * position2,
            .normal = s * s * normal,
            .normal2 = s * s * normal2,
            .box = {size * box.lower, size * box.upper}};
}

SceneSurfaces::SceneSurfaces(const SceneLayout& layout, std::vector<glm::mat3> shapes)
    : shapes_(std::move(shapes)) {
    layout.visit_solids([&](std::uint32_t number) {
        const SceneLayout::Drawable& drawable = layout.drawables[number];
        solids_.push_back({drawable.drawn, drawable.item, layout.geometry.items[drawable.item].mirrored});
    });
}

std::pair<std::uint32_t, std::uint32_t> SceneSurfaces::solids_of(std::uint32_t item) const {
    const auto first = std::ranges::lower_bound(solids_, item, {}, &Solid::item);
    const auto end = std::ranges::upper_bound(solids_, item, {}, &Solid::item);
    return {static_cast<std::uint32_t>(first - solids_.begin()),
            static_cast<std::uint32_t>(end - solids_.begin())};
}

PlacedMesh SceneSurfaces::mesh(std::uint32_t solid) const {
    const Solid& of = solids_[solid];
    return {.drawn = *of.drawn,
            .vertices = of.drawn->primitive().vertices,
            .matrix = glm::mat4(shapes_[of.item]),
            .mirrored = of.mirrored};
}

SurfaceMoments SceneSurfaces::moments(std::uint32_t solid) {
    PlacedMesh of = mesh(solid);
    const glm::mat3 shape = shapes_[solids_[solid].item];
    const float size = shape[1][1] > 0.0F ? shape[1][1] : 1.0F;
    const glm::mat3 unit = shape / size;
    const auto [found, is_new] = moments_.try_emplace({&of.drawn.primitive(), numbers_of(unit), of.mirrored});
    if (is_new) {
        of.matrix = glm::mat4(unit);
        found->second = moments_of(of);
    }
    SurfaceMoments moments = found->second.scaled(size);
    if (solids_[solid].material().double_sided) moments.add(moments.turned());
    return moments;
}

}  // namespace candela
