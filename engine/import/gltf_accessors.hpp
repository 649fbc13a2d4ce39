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

/// What an accessor is to hold: `plural`, as vectors of this type, of FLOAT or of the integers named here.
struct Use {
    std::string_view plural;
    std::string_view type;
    bool has_optional_alpha = false;    ///< VEC3, too: the fourth component is then 1
    bool unsigned_fractions = false;    ///< normalised UNSIGNED_BYTE and UNSIGNED_SHORT
    bool signed_fractions = false;      ///< normalised BYTE and SHORT
    bool quantized_numbers = false;     ///< by KHR_mesh_quantization: of 8 and 16 bits, normalised or not
    bool quantized_directions = false;  ///< the same: normalised BYTE and SHORT
};
namespace uses {
inline constexpr Use positions{.plural = "positions", .type = "VEC3", .quantized_numbers = true};
inline constexpr Use normals{.plural = "normals", .type = "VEC3", .quantized_directions = true};
inline constexpr Use tangents{.plural = "tangents", .type = "VEC4", .quantized_directions = true};
inline constexpr Use texture_coordinates{
    .plural = "texture coordinates", .type = "VEC2", .unsigned_fractions = true, .quantized_numbers = true};
inline constexpr Use colours{
    .plural = "colours", .type = "VEC3 or VEC4", .has_optional_alpha = true, .unsigned_fractions = true};
inline constexpr Use weights{.plural = "weights", .type = "VEC4", .unsigned_fractions = true};
inline constexpr Use matrices{.plural = "matrices", .type = "MAT4"};
inline constexpr Use times{.plural = "times", .type = "SCALAR"};
inline constexpr Use vectors_of_instances{.plural = "translations or scales", .type = "VEC3"};
inline constexpr Use rotations_of_instances{.plural = "rotations", .type = "VEC4", .signed_fractions = true};
}  // namespace uses

/// Elements that consist of finite floats: float or a vector or matrix of GLM. Normalised integers become
/// fractions of the largest, others the same number.
template <class Element>
[[nodiscard]] std::vector<Element> read_reals(const Document& document, int accessor,
                                              const Selection& selection, const Use& use);

/// Indices of joints: VEC4 of UNSIGNED_BYTE or UNSIGNED_SHORT, not normalised.
[[nodiscard]] std::vector<glm::u16vec4> read_joints(const Document& document, int accessor,
                                                    const Selection& selection);

/// Values of an animation's keys, their components one after the other: SCALAR, VEC3 or VEC4, as `components`
/// says, of FLOAT, or, if they `may_be_integers`, of normalised integers of 8 or 16 bits.
[[nodiscard]] std::vector<float> read_key_values(const Document& document, int accessor,
                                                 std::size_t components, bool may_be_integers);

/// Vertex indices: SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT, each below `vertex_count`.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const Document& document, int accessor,
                                                      std::size_t vertex_count);

}  // namespace candela::gltf
