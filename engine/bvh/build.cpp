#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"

namespace candela {
namespace {

constexpr std::uint32_t bin_count = 16;

// Bounds of a hierarchy.
struct Limits {
    std::uint32_t depth;
    std::uint32_t leaf_size;
};

// Four floats, with which the processor computes at once. Of points, the fourth means nothing.
using Lanes [[gnu::vector_size(16)]] = float;
using WholeLanes [[gnu::vector_size(16)]] = std::int32_t;

constexpr Lanes zero{};
constexpr Lanes infinity = zero + std::numeric_limits<float>::infinity();

// Without `b` where it is NaN.
Lanes least(Lanes a, Lanes b) {
    return b < a ? b : a;
}

// A box, initially empty. As its upper corner is negated, it grows by minima alone.
struct Extent {
    Lanes lower = infinity;
    Lanes minus_upper = infinity;

    void grow(Lanes point) {
        lower = least(lower, point);
        minus_upper = least(minus_upper, -point);
    }
    void grow(const Extent& other) {
        lower = least(lower, other.lower);
        minus_upper = least(minus_upper, other.minus_upper);
    }
    [[nodiscard]] Lanes size() const { return -minus_upper - lower; }
    [[nodiscard]] Box box() const {
        return {{lower[0], lower[1], lower[2]}, {-minus_upper[0], -minus_upper[1], -minus_upper[2]}};
    }
};

// A triangle, or a box, as the builder sees it. The index is in the fourth lane, so that a reference has 32
// bytes.
class Reference {
 public:
    Reference(const Box& box, std::uint32_t index)
        : extent_{.lower = {box.lower.x, box.lower.y, box.lower.z, std::bit_cast<float>(index)},
                  .minus_upper = {-box.upper.x, -box.upper.y, -box.upper.z, 0.0F}} {}

    [[nodiscard]] const Extent& extent() const { return extent_; }
    [[nodiscard]] std::uint32_t index() const {
        return std::bit_cast<std::uint32_t>(float{extent_.lower[3]});
    }
    // The centre of its box, with coordinates that are not finite replaced by 0.
    [[nodiscard]] Lanes centroid() const {
        // Without the index: as a float it is denormal, and processors take a hundred times as long for
        // these.
        constexpr WholeLanes point{-1, -1, -1, 0};
        const auto lower = std::bit_cast<Lanes>(std::bit_cast<WholeLanes>(extent_.lower) & point);
        const Lanes centre = 0.5F * lower - 0.5F * extent_.minus_upper;
        return least(centre, -centre) > -infinity ? centre : zero;
    }

 private:
    Extent extent_;
};

// A node still to be built from references [first, first + count).
struct Task {
    std::uint32_t node;
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t depth;
};

// Divides the extent of the centroids along each axis into `bin_count` equal slices. Without an extent, all
// centroids are in the first slice.
class Slicing {
 public:
    explicit Slicing(const Extent& centroids) : lower_(centroids.lower) {
        const Lanes size = centroids.size();
        slices_per_metre_ = size > zero ? static_cast<float>(bin_count) / size : zero;
    }

    // The slices that contain the reference, along x, y and z.
    [[nodiscard]] WholeLanes slices(const Reference& reference) const {
        const Lanes at = (reference.centroid() - lower_) * slices_per_metre_;
        const Lanes not_below = at > zero ? at : zero;  // also NaN (from 0 · ∞) becomes 0
        return __builtin_convertvector(least(zero + static_cast<float>(bin_count - 1), not_below),
                                       WholeLanes);
    }

 private:
    Lanes lower_;
    Lanes slices_per_metre_;
};

struct Bin {
    Extent extent;
    std::uint32_t count = 0;

    void add(const Bin& other) {
        extent.grow(other.extent);
        count += other.count;
    }
    // Expected cost of intersecting its triangles, in triangle tests times (half) surface area.
    [[nodiscard]] float cost() const {
        const Box box = extent.box();
        return half_area(box.lower, box.upper) * static_cast<float>(count);
    }
};

using Bins = std::array<Bin, bin_count>;

// References in slices below `slice` along `axis` go left. An infinite cost means that there is no split.
struct Split {
    glm::length_t axis = 0;
    std::uint32_t slice = 0;
    float cost = std::numeric_limits<float>::infinity();
};

// Of equally cheap splits the first, which is behind a slice that is not empty. Most nodes have few
// triangles, so most slices are empty.
Split cheapest_split(const Bins& bins, glm::length_t axis) {
    std::array<float, bin_count> cost_above{};  // of bins i and up
    Bin above;
    for (std::uint32_t i = bin_count; i-- > 0;) {
        if (bins[i].count == 0) continue;
        above.add(bins[i]);
        cost_above[i] = above.cost();
    }
    Split best;
    Bin below;
    std::uint32_t behind = 0;  // the last slice that is not empty
    for (std::uint32_t i = 0; i < bin_count; ++i) {
        if (bins[i].count == 0) continue;
        const float cost = below.cost() + cost_above[i];
        if (below.count > 0 && cost < best.cost) best = {axis, behind, cost};
        below.add(bins[i]);
        behind = i + 1;
    }
    return best;
}

Split cheapest_split(std::span<const Reference> references, const Slicing& slicing) {
    std::array<Bins, 3> bins;
    for (const Reference& reference : references) {
        const WholeLanes slices = slicing.slices(reference);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bins[axis][static_cast<std::size_t>(slices[axis])].add({reference.extent(), 1});
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

std::uint32_t split_at_median(std::span<Reference> references, const Extent& centroids) {
    const Lanes size = centroids.size();
    const int longer = size[1] > size[0] ? 1 : 0;
    const int axis = size[2] > size[longer] ? 2 : longer;
    const auto before = [axis](const Reference& a, const Reference& b) {
        return std::pair(float{a.centroid()[axis]}, a.index()) <
               std::pair(float{b.centroid()[axis]}, b.index());
    };
    const auto median = references.begin() + static_cast<std::ptrdiff_t>(references.size() / 2);
    std::nth_element(references.begin(), median, references.end(), before);
    return static_cast<std::uint32_t>(median - references.begin());
}

std::uint32_t split_at(const Split& split, std::span<Reference> references, const Slicing& slicing) {
    const auto slice = static_cast<std::int32_t>(split.slice);
    const auto goes_left = [&](const Reference& reference) {
        return slicing.slices(reference)[split.axis] < slice;
    };
    const auto right = std::partition(references.begin(), references.end(), goes_left);
    return static_cast<std::uint32_t>(right - references.begin());
}

// Reorders the references of a node so that the left child's come first, and returns their number; 0 means
// that the node is a leaf.
std::uint32_t divide(std::span<Reference> references, const Box& box, const Extent& centroids,
                     std::uint32_t depth, const Limits& limits) {
    const auto n = static_cast<std::uint32_t>(references.size());
    if (n == 1) return 0;

    // Below every node there must be enough levels left for median splits down to the leaves, so that no
    // input exceeds the largest depth.
    const bool free_choice = depth + median_levels(n, limits.leaf_size) < limits.depth;
    const Slicing slicing(centroids);
    const Split split = free_choice ? cheapest_split(references, slicing) : Split{};
    if (n <= limits.leaf_size) {
        // Entering an inner node costs as much as one triangle test.
        const float area = half_area(box.lower, box.upper);
        const bool pays = area + split.cost < area * static_cast<float>(n);
        return pays ? split_at(split, references, slicing) : 0;
    }
    const bool found = split.cost < std::numeric_limits<float>::infinity();
    return found ? split_at(split, references, slicing) : split_at_median(references, centroids);
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
        Extent extent;
        Extent centroids;
        for (const Reference& reference : range) {
            extent.grow(reference.extent());
            centroids.grow(reference.centroid());
        }

        const Box box = extent.box();
        const std::uint32_t left = divide(range, box, centroids, depth, limits);
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
        bvh.order.push_back(reference.index());
    }
    return bvh;
}

}  // namespace

Bvh build_bvh(std::span<const Triangle> triangles, std::uint32_t max_depth) {
    std::vector<Reference> references;
    references.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        references.emplace_back(bounds(triangles[i]), i);
    }
    return build(std::move(references), {.depth = max_depth, .leaf_size = 4});
}

Bvh build_box_bvh(std::span<const Box> boxes, std::uint32_t max_depth) {
    std::vector<Reference> references;
    references.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        references.emplace_back(boxes[i], i);
    }
    return build(std::move(references), {.depth = max_depth, .leaf_size = 1});
}

}  // namespace candela
