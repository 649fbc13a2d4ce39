#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tiny_gltf.h>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace candela::gltf {

// Reading of accessors, including strided and sparse ones. Every range is checked against the loaded buffers
// before memory is allocated for it. All functions throw SceneError, which names the accessor or the buffer
// view and the problem.

/// The bytes of a buffer view.
[[nodiscard]] std::span<const unsigned char> buffer_view_bytes(const tinygltf::Model& model, int buffer_view);

/// Positions or normals: VEC3 of finite FLOAT.
[[nodiscard]] std::vector<glm::vec3> read_vectors(const tinygltf::Model& model, int accessor);

/// Texture coordinates: VEC2 of finite FLOAT, or of normalised UNSIGNED_BYTE or UNSIGNED_SHORT.
[[nodiscard]] std::vector<glm::vec2> read_texture_coordinates(const tinygltf::Model& model, int accessor);

/// Vertex colours: VEC3, whose alpha is 1, or VEC4, with channels in [0, 1], as FLOAT or as normalised
/// UNSIGNED_BYTE or UNSIGNED_SHORT. Floats outside [0, 1] are clamped. 65535 is 1.
[[nodiscard]] std::vector<glm::u16vec4> read_colours(const tinygltf::Model& model, int accessor);

/// Vertex indices: SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT, each below `vertex_count`.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor,
                                                      std::size_t vertex_count);

}  // namespace candela::gltf
