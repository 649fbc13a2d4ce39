#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/import/gltf_document.hpp"

namespace candela::gltf {

// Reading of accessors, including strided and sparse ones. Every range is checked against the loaded buffers,
// and its memory is counted, before memory is allocated for it. All functions throw SceneError, which names
// the accessor or the buffer view and the problem.

/// The elements of an accessor to read, in this order: all, or those of a list.
class Selection {
 public:
    /// The first `count` elements.
    explicit Selection(std::size_t count) : count_(count) {}
    /// Ascending indices. `indices` must outlive the selection.
    explicit Selection(std::span<const std::uint32_t> indices) : count_(indices.size()), indices_(indices) {}

    [[nodiscard]] std::size_t count() const { return count_; }
    /// The element that comes at place i.
    [[nodiscard]] std::size_t operator[](std::size_t i) const { return indices_.empty() ? i : indices_[i]; }
    /// The place of an element; `count()` or more if it is not selected.
    [[nodiscard]] std::size_t place(std::size_t element) const;

 private:
    std::size_t count_;
    std::span<const std::uint32_t> indices_;
};

/// The bytes of a buffer view, decoded if they were compressed.
[[nodiscard]] Bytes buffer_view_bytes(const Document& document, int buffer_view);

/// The bytes of a buffer between the "byteOffset" and the "byteLength" of `range`, which belongs to that
/// buffer view.
[[nodiscard]] Bytes buffer_bytes(const Document& document, const Json& range, int buffer_view);

/// How the elements of an accessor are stored.
struct ElementLayout {
    int component_type;
    std::size_t components;    ///< of a 4 x 4 matrix 16; 0 for smaller ones, which nothing has
    std::size_t count;         ///< elements
    std::size_t element_size;  ///< bytes
};
[[nodiscard]] ElementLayout layout_of(const Document& document, int accessor);

/// The number of elements.
[[nodiscard]] std::size_t element_count(const Document& document, int accessor);

/// Throws SceneError unless an accessor with `plural` of a primitive has an element for each of its
/// positions.
void check_count(const Document& document, const Json& primitive, int accessor, std::string_view plural);

/// Whether any of its elements are in the file or were decoded. Without, all are zeros, unless an extension
/// that is not supported holds them.
[[nodiscard]] bool has_data(const Document& document, int accessor);

// Floats are finite. The types that are named "quantized" are read only if the document declares
// KHR_mesh_quantization. Normalised integers are fractions of the largest; others are numbers as they are.

/// Positions: VEC3 of FLOAT; quantized: of integers of 8 or 16 bits, normalised or not.
[[nodiscard]] std::vector<glm::vec3> read_positions(const Document& document, int accessor,
                                                    const Selection& selection);

/// Normals: VEC3 of FLOAT; quantized: of normalised BYTE or SHORT.
[[nodiscard]] std::vector<glm::vec3> read_normals(const Document& document, int accessor,
                                                  const Selection& selection);

/// Tangents: VEC4 of the same.
[[nodiscard]] std::vector<glm::vec4> read_tangents(const Document& document, int accessor,
                                                   const Selection& selection);

/// Translations or scales of instances: VEC3 of FLOAT.
[[nodiscard]] std::vector<glm::vec3> read_vectors(const Document& document, int accessor,
                                                  const Selection& selection);

/// Rotations of instances, (x, y, z, w): VEC4 of FLOAT or of normalised BYTE or SHORT.
[[nodiscard]] std::vector<glm::vec4> read_rotations(const Document& document, int accessor,
                                                    const Selection& selection);

/// Texture coordinates: VEC2 of FLOAT, or of normalised UNSIGNED_BYTE or UNSIGNED_SHORT; quantized: of
/// integers of 8 or 16 bits, normalised or not.
[[nodiscard]] std::vector<glm::vec2> read_texture_coordinates(const Document& document, int accessor,
                                                              const Selection& selection);

/// Vertex colours: VEC3, whose alpha is 1, or VEC4, with channels in [0, 1], as FLOAT or as normalised
/// UNSIGNED_BYTE or UNSIGNED_SHORT. Floats outside [0, 1] are clamped. 65535 is 1.
[[nodiscard]] std::vector<glm::u16vec4> read_colours(const Document& document, int accessor,
                                                     const Selection& selection);

/// Indices of joints: VEC4 of UNSIGNED_BYTE or UNSIGNED_SHORT, not normalised.
[[nodiscard]] std::vector<glm::u16vec4> read_joints(const Document& document, int accessor,
                                                    const Selection& selection);

/// Weights of joints: VEC4 of FLOAT, or of normalised UNSIGNED_BYTE or UNSIGNED_SHORT.
[[nodiscard]] std::vector<glm::vec4> read_weights(const Document& document, int accessor,
                                                  const Selection& selection);

/// Matrices: MAT4 of FLOAT.
[[nodiscard]] std::vector<glm::mat4> read_matrices(const Document& document, int accessor,
                                                   const Selection& selection);

/// Times of an animation's keys: SCALAR of FLOAT.
[[nodiscard]] std::vector<float> read_key_times(const Document& document, int accessor);

/// Values of an animation's keys, their components one after the other: SCALAR, VEC3 or VEC4, as `components`
/// says, of FLOAT, or, if they `may_be_integers`, of normalised integers of 8 or 16 bits.
[[nodiscard]] std::vector<float> read_key_values(const Document& document, int accessor,
                                                 std::size_t components, bool may_be_integers);

/// Vertex indices: SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT, each below `vertex_count`.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const Document& document, int accessor,
                                                      std::size_t vertex_count);

}  // namespace candela::gltf
