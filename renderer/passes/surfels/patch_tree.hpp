#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "renderer/passes/surfels/scene_surfaces.hpp"

namespace candela {

/// A part of a triangle, on one of its sides.
struct Fragment {
    std::uint32_t triangle = 0;  ///< index into the tree's
    bool back = false;
    /// Weights of b and c of the triangle at the corners of the part.
    std::array<glm::vec2, 3> corners{glm::vec2(0.0F, 0.0F), glm::vec2(1.0F, 0.0F), glm::vec2(0.0F, 1.0F)};
};

/// A triangle of a root that has been cut.
struct TreeTriangle {
    Triangle placed;           ///< in the space of the item's shape
    std::uint32_t solid = 0;   ///< as in SurfacePoint
    std::uint32_t number = 0;  ///< SurfacePoint::triangle
};

/// A part of surfaces. Its values depend on its root and on the cuts down to it, and on nothing else in the
/// tree.
struct Patch {
    std::uint64_t id = 0;
    std::uint32_t item = 0;
    bool emits = false;      ///< of the surfaces of the item that emit light, otherwise of the others
    double area = 0.0;       ///< m²
    glm::vec3 centre{0.0F};  ///< mean position
    float spread2 = 0.0F;    ///< m², variance of the position, sum over the axes
    /// How far it is from a flat piece of surface, 0 to 2: the variance of its unit normal, summed over the
    /// axes, and the share of `spread2` along its mean normal.
    float bend = 0.0F;
    Box box{};                  ///< around it
    SurfacePoint point{};       ///< a random point of it; of a root, only if it is whole
    bool has_middle = false;    ///< it is flat, and `centre` is on it; of a root, only if it is whole
    std::uint32_t first = 0;    ///< of its two halves, which follow each other; 0: not cut yet
    bool is_whole = false;      ///< it can't be cut
    bool cuts_normals = false;  ///< by the direction that its surfaces face, otherwise by position
    int axis = 0;               ///< that it is cut across
    float at = 0.0F;            ///< coordinate of the cut
    float middle = 0.0F;        ///< mean coordinate: becomes `at` if nothing is on one side of that
};

/// Random number of an id, evenly in [0, 1). Another `use` gives an independent one.
[[nodiscard]] double random_of(std::uint64_t id, std::uint64_t use);
/// An id made of two, by the steps of SplitMix64 (Steele et al., "Fast Splittable Pseudorandom Number
/// Generators", 2014).
[[nodiscard]] std::uint64_t combine_ids(std::uint64_t id, std::uint64_t other);

/// Binary trees of patches. The root of one is the surfaces of an item that reflect light, or those that emit
/// it. A patch is cut into two across the axis along which its position varies most, near its middle, at a
/// place that its id gives at random; or, where they vary more, by the directions that its surfaces face.
/// Patches are cut when asked for: only then are triangles looked at one by one.
class PatchTree {
 public:
    /// `surfaces` must outlive the tree.
    explicit PatchTree(SceneSurfaces& surfaces) : surfaces_(&surfaces) {}

    /// Index of the patch of an item's surfaces that emit light, or of the others; nullopt if they have no
    /// area.
    [[nodiscard]] std::optional<std::uint32_t> add_root(std::uint32_t item, bool emits, std::uint64_t id);

    /// Cuts a patch, unless it is cut already. Returns whether it could be.
    bool cut(std::uint32_t patch);

    /// The half of a cut patch that a point is in, 0 or 1.
    [[nodiscard]] std::uint32_t half_of(std::uint32_t patch, const SurfacePoint& point) const;

    /// The reference is valid until the next call of add_root or cut.
    [[nodiscard]] const Patch& operator[](std::uint32_t patch) const { return patches_[patch]; }
    [[nodiscard]] std::size_t size() const { return patches_.size(); }

 private:
    bool add_half(std::vector<Fragment> fragments, Patch patch);
    bool try_cut(std::uint32_t patch);
    [[nodiscard]] std::vector<Fragment> fragments_of_root(const Patch& root);
    template <class Visit>
    void visit_solids(const Patch& root, Visit visit) const;

    SceneSurfaces* surfaces_;
    std::vector<TreeTriangle> triangles_;
    std::vector<Patch> patches_;
    std::vector<std::vector<Fragment>> fragments_;  // by patch; none of those that are cut, and of new roots
};

}  // namespace candela
