#include "renderer/passes/surfels/patch_tree.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

namespace candela {
namespace {

/// Random numbers of a patch.
enum PatchUse : std::uint64_t { use_cut, use_fragment, use_x, use_y, use_half };

/// How much the direction of surfaces counts beside their position, in choosing how to cut: patches are cut
/// by direction while they are about as bent as they are wide.
constexpr double weight_of_bend = 4.0;
/// How much more the extent of surfaces along their normal counts than that across it.
constexpr double weight_of_thickness = 16.0;
/// Variance of the normal below which a patch counts as flat.
constexpr double least_bend = 0.02;

glm::dvec3 variance(const glm::dvec3& sum, const glm::dvec3& sum2, double area) {
    const glm::dvec3 mean = sum / area;
    return glm::max(sum2 / area - mean * mean, 0.0);
}

double sum_of(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

/// Index of the largest number. Of those within 1 % of each other, the first: rounding does not decide.
int largest(const glm::dvec3& v) {
    int index = 0;
    for (int i = 1; i < 3; ++i) {
        if (v[i] > 1.01 * v[index]) index = i;
    }
    return index;
}

/// The size and shape of a patch, and how it is cut.
void describe(Patch& patch, const SurfaceMoments& moments) {
    const glm::dvec3 spread = variance(moments.position, moments.position2, moments.area);
    const glm::dvec3 bend = variance(moments.normal, moments.normal2, moments.area);
    const glm::dvec3 normal = moments.normal / moments.area;
    const double spread2 = sum_of(spread);
    const glm::dvec3 along_normal = spread * normal * normal;
    patch.area = moments.area;
    patch.box = moments.box;
    patch.centre = glm::vec3(moments.position / moments.area);
    patch.spread2 = static_cast<float>(spread2);
    patch.bend = static_cast<float>(sum_of(bend) + (spread2 > 0.0 ? sum_of(along_normal) / spread2 : 0.0));
    // Surfaces one behind the other are separated first.
    const glm::dvec3 length = spread + weight_of_thickness * along_normal;
    const int longest = largest(length), most_bent = largest(bend);
    patch.cuts_normals =
        bend[most_bent] > least_bend && weight_of_bend * bend[most_bent] * spread2 > length[longest];
    patch.axis = patch.cuts_normals ? most_bent : longest;
    patch.middle = static_cast<float>(
        ((patch.cuts_normals ? moments.normal : moments.position) / moments.area)[patch.axis]);
    // Opposite faces of a box and those between have normals of 1, -1 and 0: not at 0, where rounding would
    // decide. By position, within 0.2 standard deviations of the middle.
    const double off = patch.cuts_normals ? 0.5 : 0.4 * random_of(patch.id, use_cut) - 0.2;
    patch.at =
        patch.middle + static_cast<float>(off * std::sqrt((patch.cuts_normals ? bend : spread)[patch.axis]));
}

/// The triangles of a tree.
using Triangles = std::span<const TreeTriangle>;

Corners corners_of(Triangles triangles, const Fragment& fragment) {
    const Triangle& placed = triangles[fragment.triangle].placed;
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = position_of(placed, fragment.corners[i]);
    return corners;
}

/// A random point of a fragment, evenly by area.
SurfacePoint point_in(Triangles triangles, const Fragment& fragment, std::uint64_t id) {
    glm::vec2 at(random_of(id, use_x), random_of(id, use_y));
    if (at.x + at.y > 1.0F) at = 1.0F - at;
    const auto& corners = fragment.corners;
    const TreeTriangle& triangle = triangles[fragment.triangle];
    return {triangle.solid, triangle.number,
            corners[0] + at.x * (corners[1] - corners[0]) + at.y * (corners[2] - corners[0]), fragment.back};
}

/// Sums over fragments.
struct Sums {
    SurfaceMoments moments;
    std::vector<double> area_up_to;  // the area of those up to each one, and of that one
};

Sums sum_up(Triangles triangles, const std::vector<Fragment>& fragments) {
    Sums sums;
    sums.area_up_to.reserve(fragments.size());
    for (const Fragment& fragment : fragments) {
        const Corners corners = corners_of(triangles, fragment);
        const glm::vec3 normal = normal_of(triangles[fragment.triangle].placed, fragment.back);
        sums.moments.add(corners, area_of(corners), normal);
        sums.area_up_to.push_back(sums.moments.area);
    }
    return sums;
}

/// A random point of fragments, evenly by area.
SurfacePoint random_point(Triangles triangles, const std::vector<Fragment>& fragments, const Sums& sums,
                          std::uint64_t id) {
    const auto chosen =
        std::ranges::upper_bound(sums.area_up_to, random_of(id, use_fragment) * sums.moments.area);
    return point_in(triangles, fragments[static_cast<std::size_t>(chosen - sums.area_up_to.begin())], id);
}

/// Whether a place is on a fragment, seen along its normal.
bool is_on(Triangles triangles, const Fragment& fragment, const glm::dvec3& place) {
    const glm::dvec2 weights = weights_at(corners_of(triangles, fragment), place);
    return weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0;
}

/// Sets the points that represent a patch.
void set_points(Patch& patch, Triangles triangles, const std::vector<Fragment>& fragments, const Sums& sums) {
    patch.point = random_point(triangles, fragments, sums, patch.id);
    const auto has_centre = [&, centre = glm::dvec3(patch.centre)](const Fragment& fragment) {
        return is_on(triangles, fragment, centre);
    };
    patch.has_middle = patch.bend < least_bend && std::ranges::any_of(fragments, has_centre);
}

/// The two sides of a cut.
using Halves = std::array<std::vector<Fragment>, 2>;

/// Cuts a fragment whose corners have these signed distances from the cut, of both signs.
void cut_fragment(const Fragment& fragment, const std::array<float, 3>& distances, Halves& halves) {
    // The corner that is alone on its side.
    std::size_t alone = 0;
    while ((distances[alone] < 0.0F) == (distances[(alone + 1) % 3] < 0.0F) ||
           (distances[alone] < 0.0F) == (distances[(alone + 2) % 3] < 0.0F)) {
        ++alone;
    }
    const std::size_t next = (alone + 1) % 3, last = (alone + 2) % 3;
    const auto meet = [&](std::size_t to) {
        const float share = distances[alone] / (distances[alone] - distances[to]);
        return glm::mix(fragment.corners[alone], fragment.corners[to], share);
    };
    const glm::vec2 to_next = meet(next), to_last = meet(last);
    const std::size_t side = distances[alone] < 0.0F ? 0 : 1;
    const auto add = [&](std::size_t half, glm::vec2 a, glm::vec2 b, glm::vec2 c) {
        halves[half].push_back({fragment.triangle, fragment.back, {a, b, c}});
    };
    add(side, fragment.corners[alone], to_next, to_last);
    add(1 - side, to_next, fragment.corners[next], fragment.corners[last]);
    add(1 - side, to_next, fragment.corners[last], to_last);
}

/// Fragments that are much smaller than the patch are not cut: they go to one side as a whole.
void divide_by_position(const Triangle& triangle, const Fragment& fragment, const Patch& patch,
                        Halves& halves) {
    std::array<float, 3> distances{};
    for (std::size_t i = 0; i < 3; ++i) {
        distances[i] = position_of(triangle, fragment.corners[i])[patch.axis] - patch.at;
    }
    const auto [least, most] = std::minmax({distances[0], distances[1], distances[2]});
    const bool is_small = (most - least) * (most - least) < 0.04F * patch.spread2;
    if (least < 0.0F && most > 0.0F && !is_small) {
        cut_fragment(fragment, distances, halves);
        return;
    }
    halves[distances[0] + distances[1] + distances[2] < 0.0F ? 0 : 1].push_back(fragment);
}

Halves divide(Triangles triangles, const std::vector<Fragment>& fragments, const Patch& patch) {
    Halves halves;
    for (const Fragment& fragment : fragments) {
        const Triangle& triangle = triangles[fragment.triangle].placed;
        if (patch.cuts_normals) {
            const float along = normal_of(triangle, fragment.back)[patch.axis];
            halves[along < patch.at ? 0 : 1].push_back(fragment);
        } else {
            divide_by_position(triangle, fragment, patch, halves);
        }
    }
    return halves;
}

}  // namespace

std::uint64_t combine_ids(std::uint64_t id, std::uint64_t other) {
    std::uint64_t x = (id ^ other) + 0x9e37'79b9'7f4a'7c15U;
    x = (x ^ (x >> 30U)) * 0xbf58'476d'1ce4'e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d0'49bb'1331'11ebU;
    return x ^ (x >> 31U);
}

double random_of(std::uint64_t id, std::uint64_t use) {
    return static_cast<double>(combine_ids(id, use) >> 11U) * 0x1p-53;
}

/// Calls `visit(solid)` for the solids of a root's item whose surfaces are its.
template <class Visit>
void PatchTree::visit_solids(const Patch& root, Visit visit) const {
    const auto [first, end] = surfaces_->solids_of(root.item);
    for (std::uint32_t solid = first; solid < end; ++solid) {
        if (candela::emits(surfaces_->solids()[solid].material()) == root.emits) visit(solid);
    }
}

std::optional<std::uint32_t> PatchTree::add_root(std::uint32_t item, bool emits, std::uint64_t id) {
    Patch patch{.id = id, .item = item, .emits = emits};
    SurfaceMoments moments;
    visit_solids(patch, [&](std::uint32_t solid) { moments.add(surfaces_->moments(solid)); });
    if (!(moments.area > 0.0)) return std::nullopt;
    describe(patch, moments);
    patches_.push_back(patch);
    fragments_.emplace_back();
    return static_cast<std::uint32_t>(patches_.size() - 1);
}

/// `patch` is told its id and its surfaces. Returns whether it has an area.
bool PatchTree::add_half(std::vector<Fragment> fragments, Patch patch) {
    const Sums sums = sum_up(triangles_, fragments);
    if (!(sums.moments.area > 0.0)) return false;
    describe(patch, sums.moments);
    set_points(patch, triangles_, fragments, sums);
    patches_.push_back(patch);
    fragments_.push_back(std::move(fragments));
    return true;
}

bool PatchTree::cut(std::uint32_t patch) {
    if (patches_[patch].first != 0 || patches_[patch].is_whole) return !patches_[patch].is_whole;
    if (try_cut(patch)) return true;
    patches_[patch].at = patches_[patch].middle;
    if (try_cut(patch)) return true;
    Patch& whole = patches_[patch];
    whole.is_whole = true;
    set_points(whole, triangles_, fragments_[patch], sum_up(triangles_, fragments_[patch]));
    return false;
}

std::uint32_t PatchTree::half_of(std::uint32_t patch, const SurfacePoint& point) const {
    const Patch& cut = patches_[patch];
    const Triangle triangle = surfaces_->triangle(point.solid, point.triangle);
    const glm::vec3 place =
        cut.cuts_normals ? normal_of(triangle, point.back) : position_of(triangle, point.weights);
    return place[cut.axis] < cut.at ? 0 : 1;
}

/// All sides that reflect light, or emit it: fronts, and the backs of double-sided ones. Adds their
/// triangles.
std::vector<Fragment> PatchTree::fragments_of_root(const Patch& root) {
    std::vector<Fragment> fragments;
    visit_solids(root, [&](std::uint32_t solid) {
        const PlacedMesh mesh = surfaces_->mesh(solid);
        const bool double_sided = surfaces_->solids()[solid].material().double_sided;
        for (std::uint32_t i = 0; i < mesh.count(); ++i) {
            const auto index = static_cast<std::uint32_t>(triangles_.size());
            triangles_.push_back({mesh.triangle(i), solid, i});
            fragments.push_back({.triangle = index});
            if (double_sided) fragments.push_back({.triangle = index, .back = true});
        }
    });
    return fragments;
}

bool PatchTree::try_cut(std::uint32_t patch) {
    const Patch whole = patches_[patch];
    std::vector<Fragment>& fragments = fragments_[patch];
    if (fragments.empty()) fragments = fragments_of_root(whole);
    Halves halves = divide(triangles_, fragments, whole);
    if (halves[0].empty() || halves[1].empty()) return false;
    const auto first = static_cast<std::uint32_t>(patches_.size());
    const auto half = [&](std::uint64_t use) {
        return Patch{.id = combine_ids(whole.id, use), .item = whole.item, .emits = whole.emits};
    };
    if (!add_half(std::move(halves[0]), half(use_half))) return false;
    if (!add_half(std::move(halves[1]), half(use_half + 1))) {
        patches_.pop_back();
        fragments_.pop_back();
        return false;
    }
    patches_[patch].first = first;
    fragments_[patch] = {};
    return true;
}

}  // namespace candela
