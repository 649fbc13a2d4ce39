#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "renderer/passes/scene/scene_layout.hpp"
#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {

/// A point of the scene's surfaces.
struct SurfacePoint {
    std::uint32_t solid = 0;     ///< index into SceneSurfaces::solids
    std::uint32_t triangle = 0;  ///< of the solid
    glm::vec2 weights{0.0F};     ///< of its corners b and c
    bool back = false;           ///< on its back
    bool operator==(const SurfacePoint&) const = default;
};

/// Unit normal of a side of a triangle.
[[nodiscard]] glm::vec3 normal_of(const Triangle& triangle, bool back);
[[nodiscard]] inline glm::vec3 position_of(const Triangle& triangle, glm::vec2 weights) {
    return triangle.a + weights.x * (triangle.b - triangle.a) + weights.y * (triangle.c - triangle.a);
}

/// The corners of a triangle, or of a part of one.
using Corners = std::array<glm::dvec3, 3>;
[[nodiscard]] inline Corners corners_of(const Triangle& triangle) {
    return {triangle.a, triangle.b, triangle.c};
}
/// m².
[[nodiscard]] double area_of(const Corners& corners);
/// Weights of the corners b and c of the place in the plane of a triangle that is nearest to this one. Not
/// numbers if the triangle has no area.
[[nodiscard]] glm::dvec2 weights_at(const Corners& triangle, const glm::dvec3& place);

/// Sums over surfaces, by area, and the box around them.
struct SurfaceMoments {
    double area = 0.0;  ///< m²
    glm::dvec3 position{0.0}, position2{0.0}, normal{0.0}, normal2{0.0};
    Box box{};

    /// Adds a part of a side of a triangle. `facing`: unit normal; any if the part has no area.
    void add(const Corners& corners, double of_area, const glm::dvec3& facing);
    void add(const SurfaceMoments& other);
    /// Those of the other sides.
    [[nodiscard]] SurfaceMoments turned() const;
    /// Those of surfaces that are so many times as large.
    [[nodiscard]] SurfaceMoments scaled(float size) const;
};

/// What surfels are placed on: the solid drawables of a scene, each in the space of its item's shape (see
/// shape_of). Triangles are computed when they are asked for, so that objects of one mesh cost little more
/// than one.
class SceneSurfaces {
 public:
    struct Solid {
        std::shared_ptr<const DrawnPrimitive> drawn;
        std::uint32_t item = 0;
        bool mirrored = false;  ///< its matrix reverses the winding

        [[nodiscard]] const Material& material() const { return *drawn->primitive().material; }
    };

    SceneSurfaces() = default;
    /// `shapes`: by item.
    SceneSurfaces(const SceneLayout& layout, std::vector<glm::mat3> shapes);

    /// In the order of SceneLayout::visit_solids, so that their indices follow from what is in the scene.
    [[nodiscard]] std::span<const Solid> solids() const { return solids_; }
    /// Indices of an item's solids: the first one, and the one after the last.
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> solids_of(std::uint32_t item) const;

    /// The triangles of the mesh, also where it is deformed: where surfels are must not depend on which
    /// deformation came first. They refer to the solid.
    [[nodiscard]] PlacedMesh mesh(std::uint32_t solid) const;
    [[nodiscard]] Triangle triangle(std::uint32_t solid, std::uint32_t i) const {
        return mesh(solid).triangle(i);
    }
    /// Of its fronts, and of its backs if it is double-sided. They are summed up once for all solids of a
    /// primitive whose shapes differ in size alone.
    [[nodiscard]] SurfaceMoments moments(std::uint32_t solid);

 private:
    /// A primitive, the numbers of a shape matrix, and whether that reverses the winding.
    using MeshShape = std::tuple<const Primitive*, std::array<float, 9>, bool>;

    std::vector<Solid> solids_;
    std::vector<glm::mat3> shapes_;
    std::map<MeshShape, SurfaceMoments> moments_;  // of fronts
};

}  // namespace candela
