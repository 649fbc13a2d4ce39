#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"

namespace candela {

// A scene's hierarchy as the GPU reads it, in one array of nodes: a top over instances, the instances, and
// the hierarchies of meshes, each in the space of its mesh. A mesh is there once, however many instances it
// has; when an instance moves, only its own node and the top change.

/// Node with up to four children (std430, 64 bytes). After Ylitie, Karras and Laine, "Efficient Incoherent
/// Ray Traversal on GPUs Through Compressed Wide BVHs" (2017): the children's boxes are given by whole
/// numbers of steps from a corner, rounded outwards. Instances take the same bytes: see instance_node.
struct WideNode {
    glm::vec3 origin{0.0F};       ///< lower corner of the box around all children, metres
    std::uint32_t exponents = 0;  ///< steps along x, y and z in metres: 8 bits of a float's exponent each
    glm::uvec4 lower{0};     ///< along x, y and z: of each child 8 bits, the number of steps from `origin`
    glm::uvec4 upper{0};     ///< the same of the upper corners
    glm::uvec4 children{0};  ///< WideChild::word; 0: none
    bool operator==(const WideNode&) const = default;
};
static_assert(sizeof(WideNode) == 64);

/// Most children that a traversal may have to keep: each level of the binary hierarchy replaces one by four
/// at most.
inline constexpr std::uint32_t wide_stack_size = 3 * bvh_max_depth + 1;

struct WideChild {
    Box box;                 ///< empty: it is left out, as no ray can hit it
    std::uint32_t word = 0;  ///< see child_word
};

/// What refers to a leaf with `count` triangles from `first` on, at most 4, or with a count of 0 to wide node
/// `first`, which is not the root, or with a count of `instance_child` to the instance in node `first`.
[[nodiscard]] constexpr std::uint32_t child_word(std::uint32_t first, std::uint32_t count) {
    return first << 3U | count;
}
inline constexpr std::uint32_t instance_child = 7;

/// The node with these children, at most 4. Coordinates beyond ±2^126 m are cut off there.
[[nodiscard]] WideNode wide_node(std::span<const WideChild> children);

/// The nodes of the hierarchy that are the children of a wide node.
struct WideChildren {
    std::array<std::uint32_t, 4> nodes;
    std::size_t count;
};
/// Of the wide node for the inner node whose children are nodes `first` and `first + 1`: these, of which the
/// inner one with the largest box is replaced by its own two, until there are four.
[[nodiscard]] WideChildren wide_children(const Bvh& bvh, std::uint32_t first);

/// The place of a mesh's hierarchy in the joint arrays of nodes and triangles.
struct MeshPlace {
    std::uint32_t first_node = 0;      ///< greater than 0
    std::uint32_t first_triangle = 0;  ///< place of the triangle Bvh::order[0]
};
/// A mesh's nodes, from `first_node` on: a wide node for each inner node of the hierarchy.
[[nodiscard]] std::vector<WideNode> wide_nodes(const Bvh& mesh, const MeshPlace& place);
/// What refers to the root of a mesh that has triangles.
[[nodiscard]] std::uint32_t root_word(const Bvh& mesh, const MeshPlace& place);

/// The nodes of a top (KeptTop::tree), with which the joint array starts; the instances are in nodes
/// `first_instance` and following, by object. At least one, which has no children if there are no objects.
[[nodiscard]] std::vector<WideNode> top_nodes(const Bvh& top, std::uint32_t first_instance);
/// One of them; the top must have more than one object.
[[nodiscard]] WideNode top_node(const Bvh& top, std::uint32_t first_instance, std::uint32_t index);

/// An instance in the form of a node: the rows of the matrix that leads into its mesh's space, in the places
/// of (`origin`, `exponents`), `lower` and `upper`, the root of its mesh, and the entity's index.
[[nodiscard]] WideNode instance_node(const glm::mat4& mesh_from_world, std::uint32_t root,
                                     std::uint32_t entity);

}  // namespace candela
