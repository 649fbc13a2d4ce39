#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <glm/mat4x4.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>

namespace candela {

/// Why something cannot be rendered, for example "the colour is negative or not finite". None: nothing is
/// wrong.
using Fault = std::optional<std::string>;

enum class Strictness : std::uint8_t {
    usual,  ///< faults that would spoil the picture or crash
    strict  ///< also normals that are not of unit length, to within 1 %
};

/// Reads all vertices and indices; the materials must not change as long as the mesh exists.
[[nodiscard]] Fault fault_of(const Mesh& mesh, Strictness strictness);
/// Reads all vertices.
[[nodiscard]] Fault fault_of(const DeformedMesh::Vertices& vertices, Strictness strictness);
/// Whether there are as many vertices as `mesh` has, with tangents where its materials need them.
[[nodiscard]] Fault fault_of_fit(const DeformedMesh& deformed, const Mesh& mesh);
/// Reads all texels.
[[nodiscard]] Fault fault_of(const SkyPicture& picture);

[[nodiscard]] Fault fault_of(const AnyLight& light);
/// Without its picture.
[[nodiscard]] Fault fault_of(const Environment& environment);
[[nodiscard]] Fault fault_of(const Camera& camera);
/// Of a local-to-world matrix.
[[nodiscard]] Fault fault_of(const glm::mat4& world);
// What is finite, but so bright that its picture would not be. All else must have been checked.
[[nodiscard]] Fault too_bright(const AnyLight& light);
[[nodiscard]] Fault too_bright(const Environment& environment);
[[nodiscard]] Fault too_bright(const Mesh& mesh);

/// Of a mesh whose vertices are at most `reach` metres from its origin, with this local-to-world matrix.
[[nodiscard]] Fault fault_of_extent(const glm::mat4& world, float reach);
/// The largest distance of a vertex from the origin of the mesh, metres.
[[nodiscard]] float reach_of(const Mesh& mesh);

}  // namespace candela
