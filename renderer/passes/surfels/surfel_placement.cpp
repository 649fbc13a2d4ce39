#include "renderer/passes/surfels/surfel_placement.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/color_space.hpp>
#include <glm/packing.hpp>
#include <iterator>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "renderer/passes/scene/image_texel.hpp"
#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {
namespace {

/// Random numbers of an id, after those of a patch.
enum CellUse : std::uint64_t { use_weight = 8, use_item, use_order, use_scale };

/// Trees are planted anew once they have so many patches for each surfel. A set needs about two for each of
/// its points.
constexpr std::size_t most_patches_a_surfel = 256;

/// Interpolated between the corners, in sRGB: gpu::CellPoint::colour.
std::uint32_t colour_at(const gpu::TraceTriangle& triangle, glm::vec2 b) {
    return glm::packUnorm4x8((1.0F - b.x - b.y) * glm::unpackUnorm4x8(triangle.colour_a) +
                             b.x * glm::unpackUnorm4x8(triangle.colour_b) +
                             b.y * glm::unpackUnorm4x8(triangle.colour_c));
}

template <class Values>
auto between(const Values& a, const Values& b, const Values& c, glm::vec2 weights) {
    return a + weights.x * (b - a) + weights.y * (c - a);
}

/// A colour, in sRGB, times what the image shows at `uv`.
std::uint32_t textured(std::uint32_t colour, const Image* image, glm::vec2 uv) {
    if (image == nullptr) return colour;
    const glm::vec4 own = glm::unpackUnorm4x8(colour);
    const glm::vec4 texel = glm::vec4(texel_at(*image, uv)) / 255.0F;
    const glm::vec3 product =
        glm::convertSRGBToLinear(glm::vec3(own)) * glm::convertSRGBToLinear(glm::vec3(texel));
    return glm::packUnorm4x8(glm::vec4(glm::convertLinearToSRGB(product), own.a * texel.a));
}

/// Whether the emission lies by second texture coordinates.
bool has_second_emission(const Material& material) {
    return material.second_uvs.emissive && material.emissive_texture != nullptr;
}

/// `area`: m², that the point of the part represents.
gpu::CellPoint cell_point(const PlacedMesh& mesh, const Patch& part, double area, std::uint32_t surfel) {
    const SurfacePoint& place = part.point;
    const Material& material = *mesh.drawn.primitive().material;
    const Triangle placed = mesh.triangle(place.triangle);
    const gpu::TraceTriangle triangle = mesh.traced(place.triangle, 0);
    const glm::vec2 b = place.weights;
    gpu::CellPoint point{.position = position_of(placed, b),
                         .material = triangle.material,
                         .normal = normal_of(placed, place.back),
                         .area = static_cast<float>(area),
                         .uv = between(triangle.uv_a, triangle.uv_b, triangle.uv_c, b),
                         .surfel = surfel,
                         .colour = colour_at(triangle, b),
                         .middle = part.has_middle ? part.centre : position_of(placed, b)};
    if (!has_second_emission(material)) return point;
    const std::array<glm::vec2, 3> second = mesh.second_uvs(place.triangle);
    point.colour = textured(point.colour, material.base_colour_texture.get(), point.uv);
    point.uv = between(second[0], second[1], second[2], b);
    return point;
}

/// Density of surfels at the place of a box where it is greatest.
float density_in(const Box& box, std::span<const Focus> foci) {
    float density = foci.empty() ? 1.0F : 0.0F;
    for (const Focus& focus : foci) {
        density = std::max(density, density_at({&focus, 1}, glm::clamp(focus.centre, box.lower, box.upper)));
    }
    return density;
}

std::span<const Focus> foci_of(std::uint32_t item, std::span<const std::vector<Focus>> foci) {
    return foci.empty() ? std::span<const Focus>() : std::span(foci[item]);
}

}  // namespace

SurfelPlacement::SurfelPlacement(SceneSurfaces surfaces, std::uint32_t seed)
    : surfaces_(std::move(surfaces)), seed_(seed), tree_(surfaces_) {
    plant();
}

void SurfelPlacement::plant() {
    tree_ = PatchTree(surfaces_);
    reflecting_ = roots_of(false);
    emitting_ = roots_of(true);
}

std::vector<std::uint32_t> SurfelPlacement::roots_of(bool emitting) {
    std::vector<std::uint32_t> roots;
    std::optional<std::uint32_t> last;
    for (const SceneSurfaces::Solid& solid : surfaces_.solids()) {
        if (solid.item == last || emits(solid.material()) != emitting) continue;
        last = solid.item;
        const std::uint64_t id = combine_ids(combine_ids(seed_, emitting ? 1 : 0), solid.item);
        if (const auto root = tree_.add_root(solid.item, emitting, id)) roots.push_back(*root);
    }
    return roots;
}

/// Area times density counts so much beside the shares of a guide: surfaces that send little light must also
/// gather, and the guide does not see all.
SurfelPlacement::Weights SurfelPlacement::weights_of(std::span<const std::vector<Focus>> foci,
                                                     std::span<const GuidePoint> guide) const {
    constexpr double weight_of_area = 0.2;
    Weights weights{.foci = foci, .guide = guide};
    double shares = 0.0, area = 0.0;
    for (const GuidePoint& point : guide) {
        const std::uint32_t item = surfaces_.solids()[point.place.solid].item;
        const glm::vec3 place =
            position_of(surfaces_.triangle(point.place.solid, point.place.triangle), point.place.weights);
        shares += static_cast<double>(point.share);
        area += static_cast<double>(point.area * density_at(foci_of(item, foci), place));
    }
    if (!(shares > 0.0) || !(area > 0.0)) return weights;
    weights.of_share = 1.0 / shares;
    weights.of_area = weight_of_area / area;
    return weights;
}

/// How much a cell is worth to be cut.
double SurfelPlacement::weight_of(const Cell& cell, const Weights& weights) const {
    constexpr double weight_of_bend = 4.0;
    const Patch& patch = tree_[cell.patch];
    const auto density = static_cast<double>(density_in(patch.box, foci_of(patch.item, weights.foci)));
    double share = 0.0;
    for (const std::uint32_t i : cell.guides) {
        const GuidePoint& point = weights.guide[i];
        share +=
            static_cast<double>(point.share) * std::min(patch.area / static_cast<double>(point.area), 1.0);
    }
    const double size = weights.of_share * share + weights.of_area * patch.area * cell.scale * density;
    return size * (1.0 + weight_of_bend * static_cast<double>(patch.bend));
}

/// Items that stand for all, about `most` of them: each is chosen with a probability, a power of 1/2, that is
/// proportional to its weight, and stands for the inverse of it. At least one.
std::vector<SurfelPlacement::Cell> SurfelPlacement::share_items(const std::vector<std::uint32_t>& roots,
                                                                double most, const Weights& by_size) const {
    std::vector<double> weights;
    double largest = 0.0;
    for (const std::uint32_t root : roots) {
        weights.push_back(weight_of({.patch = root}, by_size));
        largest = std::max(largest, weights.back());
    }
    // A weight of `whole` or more is chosen in any case.
    const auto scale_of = [](double weight, double whole) {
        return std::exp2(std::max(std::ceil(std::log2(whole / weight)), 0.0));
    };
    const auto expected = [&](double whole) {
        double sum = 0.0;
        for (const double weight : weights) sum += 1.0 / scale_of(weight, whole);
        return sum;
    };
    double whole = std::exp2(std::floor(std::log2(largest)) - 32.0);
    while (expected(whole) > most) whole *= 2.0;
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const double scale = scale_of(weights[i], whole);
        const bool is_chosen = random_of(tree_[roots[i]].id, use_item) * scale < 1.0;
        if (is_chosen) cells.push_back({.patch = roots[i], .scale = scale});
    }
    if (cells.empty()) {
        const auto first = static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
        cells.push_back({.patch = roots[first], .scale = scale_of(weights[first], whole)});
    }
    return cells;
}

/// Each item as a cell.
std::vector<SurfelPlacement::Cell> SurfelPlacement::whole_items(const std::vector<std::uint32_t>& roots,
                                                                const Weights& weights) const {
    std::map<std::uint32_t, std::vector<std::uint32_t>> guides;  // by item
    for (std::uint32_t i = 0; i < weights.guide.size(); ++i) {
        guides[surfaces_.solids()[weights.guide[i].place.solid].item].push_back(i);
    }
    std::vector<Cell> cells;
    cells.reserve(roots.size());
    for (const std::uint32_t root : roots) {
        cells.push_back({.patch = root, .guides = std::move(guides[tree_[root].item])});
    }
    return cells;
}

/// Replaces a cell, whose patch is cut, by its two halves.
void SurfelPlacement::split(std::vector<Cell>& cells, std::size_t index,
                            std::span<const GuidePoint> guide) const {
    const Cell whole = std::move(cells[index]);
    std::array<std::vector<std::uint32_t>, 2> guides;
    const Patch& patch = tree_[whole.patch];
    for (const std::uint32_t i : whole.guides) {
        // Both halves of a patch that is smaller than what the point stands for are parts of that.
        const bool is_within = patch.area <= static_cast<double>(guide[i].area);
        const std::uint32_t half = tree_.half_of(whole.patch, guide[i].place);
        if (is_within || half == 0) guides[0].push_back(i);
        if (is_within || half == 1) guides[1].push_back(i);
    }
    const std::uint32_t first = patch.first;
    cells[index] = {first, whole.scale, std::move(guides[0])};
    cells.push_back({first + 1, whole.scale, std::move(guides[1])});
}

/// Cuts cells, always the one of the greatest weight, until there are `count`.
template <class Weight>
std::vector<SurfelPlacement::Cell> SurfelPlacement::cut(std::vector<Cell> cells, std::uint32_t count,
                                                        const Weight& weigh, const Cutting& cutting) {
    // The id makes the order of equal weights independent of the tree's.
    using Entry = std::tuple<double, std::uint64_t, std::size_t>;
    std::priority_queue<Entry> next;
    const auto queue = [&](std::size_t i) {
        const std::uint64_t id = tree_[cells[i].patch].id;
        const double weight = weigh(cells[i]);
        if (cutting.record != nullptr) cutting.record->places[id] = {.weight = weight};
        if (cutting.within == nullptr || cutting.within->opens(id)) next.emplace(weight, id, i);
    };
    for (std::size_t i = 0; i < cells.size(); ++i) queue(i);
    while (cells.size() < count && !next.empty()) {
        const std::size_t i = std::get<2>(next.top());
        next.pop();
        const std::uint32_t patch = cells[i].patch;
        if (!tree_.cut(patch)) continue;
        if (cutting.record != nullptr) cutting.record->places[tree_[patch].id].opened = true;
        split(cells, i, cutting.guide);
        queue(i);
        queue(cells.size() - 1);
    }
    return cells;
}

/// The cells that `whole` were cut into, in the order in which their trees list them: neighbours follow each
/// other, so that surfels and pixels that gather from every n-th surfel gather from everywhere.
std::vector<SurfelPlacement::Cell> SurfelPlacement::in_order(std::vector<Cell> cells,
                                                             std::vector<std::uint32_t> whole) const {
    std::unordered_map<std::uint32_t, std::size_t> index_of;
    for (std::size_t i = 0; i < cells.size(); ++i) index_of.emplace(cells[i].patch, i);
    std::vector<Cell> ordered;
    ordered.reserve(cells.size());
    std::ranges::reverse(whole);
    while (!whole.empty()) {
        const std::uint32_t patch = whole.back();
        whole.pop_back();
        if (const auto found = index_of.find(patch); found != index_of.end()) {
            ordered.push_back(std::move(cells[found->second]));
        } else {
            whole.insert(whole.end(), {tree_[patch].first + 1, tree_[patch].first});
        }
    }
    return ordered;
}

/// Cuts items into `count` cells. `within`: null: wherever the weight is greatest.
SurfelPlacement::CutCells SurfelPlacement::cells_of(std::vector<Cell> whole, std::uint32_t count,
                                                    const Weights& weights, const PatchCut* within) {
    CutCells of;
    std::vector<std::uint32_t> items;
    for (const Cell& item : whole) {
        items.push_back(item.patch);
        of.cut.scales.emplace(tree_[item.patch].id, item.scale);
    }
    // Patches of equal size are not all cut at once: that would leave large areas of cells of twice the size.
    const auto weight = [&](const Cell& cell) {
        return weight_of(cell, weights) * std::exp2(random_of(tree_[cell.patch].id, use_weight));
    };
    const Cutting cutting{.guide = weights.guide, .within = within, .record = &of.cut};
    of.cells = in_order(cut(std::move(whole), count, weight, cutting), std::move(items));
    return of;
}

/// `chosen`: items, of `roots`.
SurfelPlacement::CutCells SurfelPlacement::cells_on(const std::vector<std::uint32_t>& roots,
                                                    const std::vector<Cell>& chosen, std::uint32_t count,
                                                    const Weights& weights, const LastCut& last) {
    CutCells wanted = cells_of(chosen, count, weights, nullptr);
    if (last.cut == nullptr) return wanted;
    const FollowedCut followed =
        follow(tree_, roots, {*last.cut, wanted.cut}, {count, last.most_new, last.gain});
    if (followed.left.all == 0) return wanted;
    std::vector<Cell> whole;
    for (const Cell& item : whole_items(roots, weights)) {
        const auto found = followed.cut.scales.find(tree_[item.patch].id);
        if (found == followed.cut.scales.end()) continue;
        whole.push_back(item);
        whole.back().scale = found->second;
    }
    CutCells of = cells_of(std::move(whole), count, weights, &followed.cut);
    of.left = followed.left;
    return of;
}

SurfelPlacement::CutCells SurfelPlacement::reflecting_cells(std::uint32_t count, const Weights& weights,
                                                            const LastCut& last) {
    if (count == 0 || reflecting_.empty()) return {};
    const std::vector<Cell> items = shares_items(reflecting_.size(), count)
                                        ? share_items(reflecting_, std::max(0.25 * count, 1.0), weights)
                                        : whole_items(reflecting_, weights);
    return cells_on(reflecting_, items, count, weights, last);
}

/// `count`: emitting_surfels.
SurfelPlacement::CutCells SurfelPlacement::emitting_cells(std::uint32_t count, const Weights& weights,
                                                          const LastCut& last) {
    if (count == 0 || emitting_.empty()) return {};
    const std::vector<Cell> items = emitting_.size() > most_emitting_items
                                        ? share_items(emitting_, most_emitting_items, weights)
                                        : whole_items(emitting_, weights);
    const auto first_ones = static_cast<std::uint32_t>(items.size());
    return cells_on(emitting_, items, count + first_ones - 1, weights, last);
}

/// Appends the surfel of a cell, unless all of its points are in holes.
void SurfelPlacement::append(SurfelSet& set, const Cell& cell, std::uint32_t points) {
    std::vector<Cell> parts = cut({{.patch = cell.patch, .scale = cell.scale}}, points,
                                  [&](const Cell& part) { return tree_[part.patch].area; }, {});
    // At random: neighbours in this order share sources of light among them.
    std::ranges::sort(parts, {},
                      [&](const Cell& part) { return random_of(tree_[part.patch].id, use_order); });
    const Patch& patch = tree_[cell.patch];
    const auto index = static_cast<std::uint32_t>(set.surfels.size());
    const std::size_t first = set.points.size();
    double area = 0.0;
    for (const Cell& part : parts) {
        const Patch& of_part = tree_[part.patch];
        const PlacedMesh mesh = surfaces_.mesh(of_part.point.solid);
        if (is_hole(mesh, of_part.point.triangle, of_part.point.weights)) continue;
        set.points.push_back(cell_point(mesh, of_part, of_part.area * cell.scale, index));
        set.point_places.push_back(of_part.point);
        area += of_part.area * cell.scale;
    }
    const std::span points_of_cell = std::span(set.points).subspan(first);
    if (points_of_cell.empty()) return;
    const auto middle = std::ranges::min_element(points_of_cell, {}, [&](const gpu::CellPoint& point) {
        return glm::distance(point.position, patch.centre);
    });
    const auto whole = static_cast<float>(patch.area * cell.scale);  // m²
    set.surfels.push_back({.position = middle->position,
                           .first_point = static_cast<std::uint32_t>(first),
                           .normal = middle->normal,
                           .point_count = static_cast<std::uint32_t>(points_of_cell.size()),
                           .area = static_cast<float>(area),
                           // The variance of a square's positions is a sixth of its area.
                           .width2 = std::max(whole, 6.0F * patch.spread2),
                           .own = static_cast<float>(1.0 / cell.scale)});
    set.surfel_places.push_back(
        set.point_places[first + static_cast<std::size_t>(middle - points_of_cell.begin())]);
    set.item_of.push_back(patch.item);
    set.patches.push_back(patch.id);
    set.ids.push_back(
        combine_ids(patch.id, combine_ids(std::bit_cast<std::uint64_t>(cell.scale), use_scale)));
}

SurfelSet SurfelPlacement::place(const SurfelCounts& counts, std::span<const std::vector<Focus>> foci,
                                 std::span<const GuidePoint> guide, const LastCut& last) {
    const std::size_t most_halves = most_patches_a_surfel * (counts.reflecting + counts.emitting);
    if (tree_.size() > reflecting_.size() + emitting_.size() + most_halves) plant();
    SurfelSet set;
    const auto append_all = [&](CutCells of, std::uint32_t points) {
        for (const Cell& cell : of.cells) append(set, cell, points);
        set.cut.merge(std::move(of.cut));
        set.left += of.left;
    };
    append_all(reflecting_cells(counts.reflecting, weights_of(foci, guide), last), points_a_surfel);
    const std::size_t reflecting = set.surfels.size();
    CutCells emitting = emitting_cells(counts.emitting, weights_of(foci, {}), last);
    const auto cells = static_cast<std::uint32_t>(std::max<std::size_t>(emitting.cells.size(), 1));
    append_all(std::move(emitting),
               std::clamp(points_an_emitter * counts.emitting / cells, points_a_surfel, points_an_emitter));
    set.emitting_count = static_cast<std::uint32_t>(set.surfels.size() - reflecting);
    return set;
}

}  // namespace candela
