#pragma once

#include <glm/vec4.hpp>

#include <candela/api.hpp>
#include <candela/scene/components.hpp>

namespace candela {

/// Sets the tangents of all vertices, as a normal texture needs them, from positions, normals and texture
/// coordinates: Primitive::second_uvs if the material's normal texture lies by them. They are similar to
/// those of MikkTSpace (Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008), which glTF prescribes
/// and for which normal textures are made: the mean of the tangents of the triangles at the vertex, weighted
/// by their angles there. Vertices with equal position, normal and texture coordinates count as one. Where
/// triangles of mirrored texture coordinates meet others, their vertices are split: new ones are appended, at
/// most as many as there were, with their influences and the offsets of morph targets, and the indices of
/// these triangles change. A vertex whose triangles have no area in the texture gets any tangent that is
/// perpendicular to its normal. Positions, normals and texture coordinates must be finite, every index must
/// be that of a vertex, and second_uvs must be empty or one for each vertex.
CANDELA_API void derive_tangents(Primitive& primitive);

/// Vertex::tangent of a unit vector (x, y, z) and of w, which is 1 or -1; rounded.
[[nodiscard]] CANDELA_API glm::i16vec4 packed_tangent(const glm::vec4& tangent);

/// The inverse; its vector is of unit length but for the rounding.
[[nodiscard]] CANDELA_API glm::vec4 unpacked_tangent(const glm::i16vec4& tangent);

}  // namespace candela
