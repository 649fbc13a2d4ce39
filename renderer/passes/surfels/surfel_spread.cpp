#include "renderer/passes/surfels/surfel_spread.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <unordered_map>
#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {
namespace {

std::vector<glm::mat3> shapes_of(const ScenePlacement& placement) {
    std::vector<glm::mat3> shapes;
    for (std::size_t i = 0; i < placement.world.size(); ++i) {
        shapes.push_back(shape_of(placement.world[i]));
    }
    return shapes;
}

/// Transform from an item's shape space to the world: a rotation, a translation, and the rounding error of
/// the shape matrix.
glm::mat4 world_from_shape(const glm::mat4& world, const glm::mat3& shape) {
    return world * glm::mat4(glm::inverse(shape));
}

/// Boxes around the solid parts of the items, world space.
std::vector<Box> item_boxes(const SceneLayout& layout, const ScenePlacement& placement) {
    std::vector<Box> boxes(placement.world.size());
    layout.visit_solids([&](std::uint32_t number) {
        const SceneLayout::Drawable& drawable = layout.drawables[number];
        boxes[drawable.item].grow(
            place_box(bounds_of(drawable, placement.deformed), placement.world[drawable.item]));
    });
    return boxes;
}

bool is_inside(const Focus& focus, const Box& box) {
    const glm::vec3 farthest =
        glm::max(glm::abs(box.lower - focus.centre), glm::abs(box.upper - focus.centre));
    return glm::length(farthest) <= focus.radius;
}

/// A focus in the shape space of an item. It is rounded, more so if the item is far from it, so that it stays
/// the same, bit for bit, while the item moves a little.
Focus rounded(const Focus& focus, const Box& item, const glm::mat4& shape_from_world) {
    const float distance = glm::distance(focus.centre, glm::clamp(focus.centre, item.lower, item.upper));
    const float step = 0.25F * std::exp2(std::floor(std::log2(std::max(focus.radius, distance))));
    const glm::vec3 centre(shape_from_world * glm::vec4(focus.centre, 1.0F));
    return {step * glm::round(centre / step), focus.radius};
}

/// The foci in the shape spaces of the items; none for an item inside one of them, and for flat items, which
/// have no inverse.
std::vector<std::vector<Focus>> foci_by_item(const SceneLayout& layout, const ScenePlacement& placement,
                                             const std::vector<glm::mat3>& shapes,
                                             const std::vector<Focus>& foci) {
    std::vector<std::vector<Focus>> local(shapes.size());
    if (foci.empty()) return local;
    const std::vector<Box> boxes = item_boxes(layout, placement);
    for (std::size_t i = 0; i < local.size(); ++i) {
        const auto contains = [&](const Focus& focus) { return is_inside(focus, boxes[i]); };
        const bool is_empty = !(boxes[i].lower.x <= boxes[i].upper.x);
        if (is_empty || glm::determinant(shapes[i]) == 0.0F || std::ranges::any_of(foci, contains)) continue;
        const glm::mat4 shape_from_world = glm::inverse(world_from_shape(placement.world[i], shapes[i]));
        for (const Focus& focus : foci) local[i].push_back(rounded(focus, boxes[i], shape_from_world));
    }
    return local;
}

/// What the surfels of a frame are placed by.
struct Wishes {
    const std::vector<Focus>& foci;
    const SurfelGuide* guide;  // null: none
    SurfelCounts counts;
    std::uint32_t most_new;  // surfels; 0: any number
    bool moves;              // anything does
};

/// Surfels that are others also give another error: while things move, they stay where others are worth
/// little more.
constexpr double gain_in_motion = 2.0;

SpreadSurfels spread(const SpreadSurfels* last, const SceneLayout& layout, const ScenePlacement& placement,
                     const Wishes& wishes, std::uint32_t seed) {
    SpreadSurfels now;
    now.placement_key = {layout.geometry, shapes_of(placement), seed};
    now.key = {.counts = wishes.counts,
               .foci = foci_by_item(layout, placement, now.placement_key.shapes, wishes.foci),
               .guide = {}};
    if (wishes.guide != nullptr && wishes.guide->is_of(now.placement_key))
        now.key.guide = wishes.guide->points;
    const bool same_items = last != nullptr && last->placement_key == now.placement_key;
    const auto is_done = [&](const ChangesLeft& left) { return (wishes.moves ? left.gains : left.all) == 0; };
    if (same_items && last->key == now.key && is_done(last->set->left)) return *last;
    now.placement =
        same_items ? last->placement
                   : std::make_shared<SurfelPlacement>(SceneSurfaces(layout, now.placement_key.shapes), seed);
    LastCut last_cut;
    if (last != nullptr && wishes.most_new > 0)
        last_cut = {&last->set->cut, wishes.most_new, wishes.moves ? gain_in_motion : 1.0};
    now.set = std::make_shared<const SurfelSet>(
        now.placement->place(wishes.counts, now.key.foci, now.key.guide, last_cut));
    return now;
}

/// Leads from the space of an item's shape to the world.
struct ItemTransform {
    glm::mat4 matrix;
    glm::mat3 normal_matrix;

    [[nodiscard]] glm::vec3 place(const glm::vec3& position) const {
        return glm::vec3(matrix * glm::vec4(position, 1.0F));
    }
    [[nodiscard]] glm::vec3 direction(const glm::vec3& normal) const {
        return glm::normalize(normal_matrix * normal);
    }
};

/// Moves surfels and points to where their items are, or with the triangles that they were placed on, where
/// these are deformed.
class SurfelMover {
 public:
    SurfelMover(const SpreadSurfels& spread, const ScenePlacement& placement)
        : spread_(spread), placement_(placement) {}

    void apply(SurfelSet& set, std::size_t i) {
        const std::uint32_t item = set.item_of[i];
        const Deformation* const deformation = find_deformation(placement_.deformed, item);
        if (deformation != nullptr) {
            deform(set, i, *deformation);
            return;
        }
        const ItemTransform& transform = transform_of(item);
        gpu::Surfel& surfel = set.surfels[i];
        surfel.position = transform.place(surfel.position);
        surfel.normal = transform.direction(surfel.normal);
        for (std::uint32_t p = surfel.first_point; p < surfel.first_point + surfel.point_count; ++p) {
            gpu::CellPoint& point = set.points[p];
            point.position = transform.place(point.position);
            point.middle = transform.place(point.middle);
            point.normal = transform.direction(point.normal);
        }
    }

 private:
    /// Where a point of a triangle is now.
    struct Moved {
        Triangle triangle;  // in world space
        glm::vec3 position;
        glm::vec3 normal;  // unit; 0 if the triangle has no area
        float stretch;     // area of the triangle / that in the mesh
    };

    const ItemTransform& transform_of(std::uint32_t item) {
        const auto [found, is_new] = transforms_.try_emplace(item);
        if (is_new) {
            const glm::mat4 matrix =
                world_from_shape(placement_.world[item], spread_.placement_key.shapes[item]);
            found->second = {matrix, glm::transpose(glm::inverse(glm::mat3(matrix)))};
        }
        return found->second;
    }

    [[nodiscard]] Moved moved(const SurfacePoint& point, const Deformation& deformation) const {
        PlacedMesh mesh = spread_.placement->surfaces().mesh(point.solid);
        mesh.matrix = placement_.world[spread_.placement->surfaces().solids()[point.solid].item];
        const Triangle in_mesh = mesh.triangle(point.triangle);
        mesh.vertices = (*deformation.vertices)[mesh.drawn.index_in_mesh];
        const Triangle t = mesh.triangle(point.triangle);
        const glm::vec3 cross = glm::cross(t.b - t.a, t.c - t.a);
        const float size = glm::length(cross);
        const glm::vec3 front = size > 0.0F ? cross / size : glm::vec3(0.0F);
        return {.triangle = t,
                .position = position_of(t, point.weights),
                .normal = point.back ? -front : front,
                .stretch = size / glm::length(glm::cross(in_mesh.b - in_mesh.a, in_mesh.c - in_mesh.a))};
    }

    void deform(SurfelSet& set, std::size_t i, const Deformation& deformation) const {
        gpu::Surfel& surfel = set.surfels[i];
        const Moved centre = moved(set.surfel_places[i], deformation);
        surfel.position = centre.position;
        surfel.normal = centre.normal;
        const float area_before = surfel.area;
        surfel.area = 0.0F;
        for (std::uint32_t p = surfel.first_point; p < surfel.first_point + surfel.point_count; ++p) {
            const SurfacePoint& place = set.point_places[p];
            const Moved at = moved(place, deformation);
            gpu::CellPoint& point = set.points[p];
            // The middle moves with the plane of the triangle.
            const Triangle before = spread_.placement->surfaces().triangle(place.solid, place.triangle);
            const glm::vec2 weights(weights_at(corners_of(before), glm::dvec3(point.middle)));
            point.middle = position_of(at.triangle, weights);
            point.position = at.position;
            point.normal = at.normal;
            point.area *= at.stretch;
            surfel.area += point.area;
        }
        surfel.width2 *= surfel.area / area_before;
    }

    const SpreadSurfels& spread_;
    const ScenePlacement& placement_;
    std::unordered_map<std::uint32_t, ItemTransform> transforms_;  // of items that have surfels
};

}  // namespace

glm::mat3 shape_of(const glm::mat4& world) {
    const glm::dmat3 m(world);
    const glm::dmat3 gram = glm::transpose(m) * m;
    glm::dmat3 u(0.0);  // column-major: u[column][row]
    u[0][0] = std::sqrt(gram[0][0]);
    u[1][0] = gram[1][0] / u[0][0];
    u[2][0] = gram[2][0] / u[0][0];
    u[1][1] = std::sqrt(std::max(gram[1][1] - u[1][0] * u[1][0], 0.0));
    u[2][1] = (gram[2][1] - u[1][0] * u[2][0]) / u[1][1];
    u[2][2] = std::sqrt(std::max(gram[2][2] - u[2][0] * u[2][0] - u[2][1] * u[2][1], 0.0));
    if (glm::determinant(m) < 0.0) {
        u[0][0] = -u[0][0];
        u[1][0] = -u[1][0];
        u[2][0] = -u[2][0];
    }
    const double largest = std::max({std::abs(u[0][0]), u[1][1], u[2][2]});
    const double step = std::exp2(std::floor(std::log2(largest) + 0.3) - 14.0);
    const glm::dmat3 rounded(step * glm::round(u[0] / step), step * glm::round(u[1] / step),
                             step * glm::round(u[2] / step));
    // A flat item has no inverse; its matrix is used unchanged.
    const bool is_flat = !(std::abs(glm::determinant(rounded)) > 1e-12 * largest * largest * largest);
    return is_flat ? glm::mat3(world) : glm::mat3(rounded);
}

SurfelSet placed_in_world(const SpreadSurfels& spread, const ScenePlacement& placement) {
    SurfelMover mover(spread, placement);
    SurfelSet set = *spread.set;
    for (std::size_t i = 0; i < set.surfels.size(); ++i) {
        mover.apply(set, i);
        set.surfels[i].seed = static_cast<std::uint32_t>(set.ids[i]);
    }
    return set;
}

ValueHandle<SpreadSurfels> add_surfel_spread(FrameGraph& graph, const SceneData& scene,
                                             const SurfelSetChoice& set, const SpreadInputs& inputs,
                                             const VplSettings& settings) {
    return graph.add("surfel-spread", [&](Pass& pass) {
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(inputs.foci);
        if (inputs.guide) pass.read(*inputs.guide);
        if (inputs.clock) pass.read(*inputs.clock);
        set.read(pass);
        const SurfelCounts counts{.reflecting = settings.bounces > 0 ? settings.count : 0,
                                  .emitting = emitting_surfels(settings.count)};
        pass.parameter(counts);
        pass.parameter(settings.seed);
        pass.keeps_state();
        const auto out = pass.update(graph.value<SpreadSurfels>("spread surfels"));
        pass.run([=, layout = scene.layout, placement = scene.placement](Execution& run) {
            const SurfelGuide* const guide = inputs.guide ? &run.value(*inputs.guide) : nullptr;
            const UpdateClock clock = inputs.clock ? run.value(*inputs.clock) : UpdateClock{};
            const Wishes wishes{.foci = run.value(inputs.foci),
                                .guide = guide,
                                .counts = counts,
                                .most_new = clock.limit < settings.count ? (clock.limit + 1) / 2 : 0,
                                .moves = clock.moves};
            run.set(out, spread(run.previous(out), run.value(layout), run.value(placement), wishes,
                                settings.seed + set.number(run)));
        });
        return out;
    });
}

}  // namespace candela
