#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"

namespace candela {

/// Node with up to four children, as the GPU reads it (std430, 64 bytes). After Ylitie, Karras and Laine,
/// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs" (2017): the children's boxes are
/// given by whole numbers of steps from a corner, rounded outwards.
struct WideNode {
    glm::vec3 origin{0.0F};  ///< lower corner of the box around all children, metres
    std::uint32_t exponents =
        0;                ///< steps along x, y and z in metres, of each the 8 bits of a float's exponent
    glm::uvec3 lower{0};  ///< along x, y and z: of each child 8 bits, the number of steps from `origin`
    std::uint32_t pad0 = 0;
    glm::uvec3 upper{0};
    std::uint32_t pad1 = 0;
    glm::uvec4 children{0};  ///< WideChild::word; 0: none
};
static_assert(sizeof(WideNode) == 64);

/// Most children that a traversal may have to keep: each level of the binary hierarchy replaces one by four
/// at most.
inline constexpr std::uint32_t wide_stack_size = 3 * bvh_max_depth + 1;

struct WideChild {
    Box box;                 ///< empty: it is left out, as no ray can hit it
    std::uint32_t word = 0;  ///< see child_word
};

/// What refers to a leaf with `count` triangles from `first` on, or with a count of 0 to wide node `first`,
/// which is not the root.
[[nodiscard]] constexpr std::uint32_t child_word(std::uint32_t first, std::uint32_t count) {
    return first << 3U | count;
}

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

/// A wide node for each inner node of the hierarchy, so that each of them may be used as a root: its children
/// are those of the node, or theirs. It is at place `wide_index`. `words`: of each node of the hierarchy,
/// what it is as a child.
[[nodiscard]] std::vector<WideNode> widen(const Bvh& bvh, std::span<const std::uint32_t> words);

[[nodiscard]] inline std::uint32_t wide_index(const BvhNode& inner) {
    return (inner.first - 1) / 2;
}

}  // namespace candela
