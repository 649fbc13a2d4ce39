#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <candela/scene/components.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_document.hpp"

namespace candela::gltf {

/// The number of morph targets of the mesh. Throws SceneError if its primitives, or its weights, have another
/// number.
[[nodiscard]] std::size_t count_targets(const Json& mesh);

/// The weights of an object with so many targets, a mesh or a node; `otherwise` if it has none. Throws
/// SceneError if there are not as many weights as targets.
[[nodiscard]] std::vector<float> read_morph_weights(const Json& object, std::size_t targets,
                                                    const std::vector<float>& otherwise);

/// The morph targets of a primitive, for the selected vertices. Throws SceneError.
[[nodiscard]] std::vector<MorphTarget> read_targets(const Document& document, const Json& primitive,
                                                    bool with_tangents, const Selection& selection,
                                                    ImportBudget& budget);

/// Sets the offsets of normals to the difference that a whole target makes to the normals of faces. No two
/// triangles share a vertex.
void set_face_normal_offsets(const std::vector<Vertex>& vertices,
                             std::span<const std::array<std::uint32_t, 3>> triangles, MorphTarget& target);

}  // namespace candela::gltf
