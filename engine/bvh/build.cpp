#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "engine/bvh/two_level.hpp"

namespace candela {
namespace {

constexpr std::uint32_t bin_count = 16;

// Bounds of a hierarchy.
struct Limits {
    std::uint32_t depth;
    std::uint32_t leaf_size;
};

// A triangle, or a box, as the builder sees it. `centroid` is the centre of its box, with coordinates that
// are not finite replaced by 0.
struct Reference {
    Box box;
    glm::vec3 centroid;
    std::uint32_t index;
};

// A node still to be built from references [first, first + count).
struct Task {
    std::uint32_t node;
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t depth;
};

// Divides the extent of the centroids along one axis into `bin_count` equal slices. Without an extent, all
// centroids are in the first slice.
struct Slicing {
    glm::length_t axis;
    float lower;
    float slices_per_metre = 0.0F;

    Slicing(const Box& centroids, glm::length_t along) : axis(along), lower(centroids.lower[along]) {
        const float extent = centroids.upper[along] - lower;
        if (extent > 0.0F) slices_per_metre = static_cast<float>(bin_count) / extent;
    }

    [[nodiscard]] std::uint32_t slice(const Reference& reference) const {
        // With the arguments in this order, std::max turns NaN (from 0 · ∞) into 0.
        const float at = std::max(0.0F, (reference.centroid[axis] - lower) * slices_per_metre);
        return static_cast<std::uint32_t>(std::min(at, static_cast<float>(bin_count - 1)));
    }
};

struct Bin {
    Box box;
    std::uint32_t count = 0;

    void add(const Bin& other) {
        box.grow(other.box);
        count += other.count;
    }
    // Expected cost of intersecting its triangles, in triangle tests times (half) surface area.
    [[nodiscard]] float cost() const { return half_area(box.lower, box.upper) * static_cast<float>(count); }
};
using Bins = std::array<Bin, bin_count>;

// References in slices below `slice` along `axis` go left. An infinite cost means that there is no split.
struct Split {
    glm::length_t axis = 0;
    std::uint32_t slice = 0;
    float cost = std::numeric_limits<float>::infinity();
};

Reference make_reference(const Box& box, std::uint32_t index) {
    glm::vec3 centroid = 0.5F * box.lower + 0.5F * box.upper;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(centroid[axis])) centroid[axis] = 0.0F;
    }
    return {box, centroid, index};
}

Split cheapest_split(const Bins& bins, glm::length_t axis) {
    std::array<float, bin_count> cost_above{};  // of bins i and up
    Bin above;
    for (std::uint32_t i = bin_count; i-- > 0;) {
        above.add(bins[i]);
        cost_above[i] = above.cost();
    }
    Split best;
    Bin below;
    for (std::uint32_t i = 1; i < bin_count; ++i) {
        below.add(bins[i - 1]);
        const float cost = below.cost() + cost_above[i];
        const bool divides = below.count > 0 && below.count < above.count;
        if (divides && cost < best.cost) best = {axis, i, cost};
    }
    return best;
}

Split cheapest_split(std::span<const Reference> references, const Box& centroids) {
    const std::array slicings{Slicing(centroids, 0), Slicing(centroids, 1), Slicing(centroids, 2)};
    std::array<Bins, 3> bins;
    for (const Reference& reference : references) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bins[axis][slicings[axis].slice(reference)].add({reference.box, 1});
        }
    }
    Split best;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        const Split split = cheapest_split(bins[static_cast<std::size_t>(axis)], axis);
        if (split.cost < best.cost) best = split;
    }
    return best;
}

// Number of levels of median splits that divide n triangles into leaves.
std::uint32_t median_levels(std::uint32_t n, std::uint32_t leaf_size) {
    return static_cast<std::uint32_t>(std::bit_width((n - 1) / leaf_size));
}

std::uint32_t split_at_median(std::span<Reference> references, const Box& centroids) {
    const glm::vec3 extent = centroids.upper - centroids.lower;
    const glm::length_t longer = extent.y > extent.x ? 1 : 0;
    const glm::length_t axis = extent.z > extent[longer] ? 2 : longer;
    const auto before = [axis](const Reference& a, const Reference& b) {
        return std::pair(a.centroid[axis], a.index) < std::pair(b.centroid[axis], b.index);
    };
    const auto median = references.begin() + static_cast<std::ptrdiff_t>(references.size() / 2);
    std::nth_element(references.begin(), median, references.end(), before);
    return static_cast<std::uint32_t>(median - references.begin());
}

std::uint32_t split_at(const Split& split, std::span<Reference> references, const Box& centroids) {
    const Slicing slicing(centroids, split.axis);
    const auto goes_left = [&](const Reference& reference) { return slicing.slice(reference) < split.slice; };
    const auto right = std::partition(references.begin(), references.end(), goes_left);
    return static_cast<std::uint32_t>(right - references.begin());
}

// Reorders the references of a node so that the left child's come first, and returns their number; 0 means
// that the node is a leaf.
std::uint32_t divide(std::span<Reference> references, const Box& box, std::uint32_t depth,
                     const Limits& limits) {
    const auto n = static_cast<std::uint32_t>(references.size());
    if (n == 1) return 0;
    Box centroids;
    for (const Reference& reference : references) {
        centroids.grow(reference.centroid);
    }

    // Below every node there must be enough levels left for median splits down to the leaves, so that no
    // input exceeds the largest depth.
    const bool free_choice = depth + median_levels(n, limits.leaf_size) < limits.depth;
    const Split split = free_choice ? cheapest_split(references, centroids) : Split{};
    if (n <= limits.leaf_size) {
        // Entering an inner node costs as much as one triangle test.
        const float area = half_area(box.lower, box.upper);
        const bool pays = area + split.cost < area * static_cast<float>(n);
        return pays ? split_at(split, references, centroids) : 0;
    }
    const bool found = split.cost < std::numeric_limits<float>::infinity();
    return found ? split_at(split, references, centroids) : split_at_median(references, centroids);
}

Bvh build(std::vector<Reference> references, const Limits& limits) {
    if (references.empty()) return {};
    Bvh bvh;
    bvh.nodes.resize(1);
    std::vector<Task> tasks{{0, 0, static_cast<std::uint32_t>(references.size()), 0}};
    while (!tasks.empty()) {
        const auto [node, first, count, depth] = tasks.back();
        tasks.pop_back();
        const auto range = std::span(references).subspan(first, count);
        Box box;
        for (const Reference& reference : range) {
            box.grow(reference.box);
        }

        const std::uint32_t left = divide(range, box, depth, limits);
        if (left == 0) {
            bvh.nodes[node] = {box.lower, first, box.upper, count};
            bvh.depth = std::max(bvh.depth, depth);
            continue;
        }
        const auto child = static_cast<std::uint32_t>(bvh.nodes.size());
        bvh.nodes[node] = {box.lower, child, box.upper, 0};
        bvh.nodes.resize(bvh.nodes.size() + 2);
        tasks.push_back({child + 1, first + left, count - left, depth + 1});
        tasks.push_back({child, first, left, depth + 1});
    }

    bvh.order.reserve(references.size());
    for (const Reference& reference : references) {
        bvh.order.push_back(reference.index);
    }
    return bvh;
}

}  // namespace

Bvh build_bvh(std::span<const Triangle> triangles, std::uint32_t max_depth) {
    std::vector<Reference> references;
    references.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        references.push_back(make_reference(bounds(triangles[i]), i));
    }
    return build(std::move(references), {.depth = max_depth, .leaf_size = 4});
}

Bvh build_box_bvh(std::span<const Box> boxes, std::uint32_t max_depth) {
    std::vector<Reference> references;
    references.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        references.push_back(make_reference(boxes[i], i));
    }
    return build(std::move(references), {.depth = max_depth, .leaf_size = 1});
}

}  // namespace candela
