#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include <candela/scene/components.hpp>

namespace candela {

/// Four floats that the CPU handles at once. A plain type of GCC and Clang, on any CPU.
using Lanes = float __attribute__((vector_size(16)));

/// The columns of an affine matrix. The last lane is 0.
struct alignas(64) AffineColumns {
    Lanes x, y, z, translation;
};

[[nodiscard]] AffineColumns columns_of(const glm::mat4& matrix);

/// A joint that moves a vertex.
struct Pull {
    std::uint32_t joint;
    float weight;  ///< > 0; those of a vertex add up to 1
};

/// The influences of a primitive in the form that moves vertices fast.
struct PreparedInfluences {
    std::vector<Pull> pulls;          ///< vertex after vertex
    std::vector<std::uint32_t> ends;  ///< of the pulls of each vertex; empty: the primitive has no influences
    std::size_t joints = 0;           ///< that it needs
    bool has_tangents = false;
};

/// Throws SceneError, which says what is wrong, if they do not fit the vertices or weights are negative or
/// not finite.
[[nodiscard]] PreparedInfluences prepare_influences(const Primitive& primitive);

/// What is wrong with the primitive's morph targets, if anything is.
[[nodiscard]] std::optional<std::string> fault_of_targets(const Primitive& primitive);

/// Sets positions, normals and tangents of `moved`, as many as of the primitive, to those of its vertices
/// with weighted offsets.
void add_targets(const Primitive& primitive, std::span<const float> weights, std::span<Vertex> moved);

/// Sets positions, normals and, if the primitive has them, tangents of `moved` to those of `rest`, moved by
/// the joints; see MeshDeformer.
void move_by_joints(std::span<const Vertex> rest, const PreparedInfluences& influences,
                    std::span<const AffineColumns> joints, std::span<Vertex> moved);

}  // namespace candela
