#include "renderer/passes/scene/scene_hierarchy.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <span>
#include <utility>

#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {
namespace {

constexpr float rebuild_above = 1.5F;  // times the SAH cost at the last build

/// The deformed vertices of an item; null: it has those of the mesh.
std::shared_ptr<const DeformedMesh::Vertices> deformed_vertices(const Deformations& deformed,
                                                                std::uint32_t item) {
    const Deformation* const found = find_deformation(deformed, item);
    return found == nullptr ? nullptr : found->vertices;
}

/// The same drawable, in the way that it was last made from.
bool is_made_from(const ObjectHierarchy::Source& source, const SceneLayout& layout,
                  const SceneLayout::Drawable& drawable, const ScenePlacement& placement) {
    return source.is_made && source.mirrored == layout.geometry.items[drawable.item].mirrored &&
           source.world == placement.world[drawable.item] &&
           source.vertices == deformed_vertices(placement.deformed, drawable.item);
}

double area_of(std::span<const Triangle> triangles) {
    double sum = 0.0;
    for (const Triangle& t : triangles) {
        sum += 0.5 * static_cast<double>(glm::length(glm::cross(t.b - t.a, t.c - t.a)));
    }
    return sum;
}

/// Returns whether the hierarchy was built again.
bool fit(ObjectHierarchy& object, std::span<const Triangle> triangles) {
    if (object.bvh.order.size() == triangles.size()) {
        refit(object.bvh, triangles);
        if (sah_cost(object.bvh) <= rebuild_above * object.built_cost) return false;
    }
    object.bvh = build_bvh(triangles, object_max_depth);
    object.built_cost = sah_cost(object.bvh);
    object.nodes = {.count = static_cast<std::uint32_t>(object.bvh.nodes.size() / 2)};
    return true;
}

/// In place of the hierarchies of drawables that have none.
const Bvh empty_bvh{};

}  // namespace

void SceneHierarchy::update(const SceneLayout& layout, const ScenePlacement& placement) {
    changed_.clear();
    std::vector<std::uint32_t> candidates = take_over(layout);
    const std::vector<std::uint32_t> moved = moved_solids(layout, placement_, placement);
    candidates.insert(candidates.end(), moved.begin(), moved.end());
    std::ranges::sort(candidates);
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    placement_ = placement;
    fit_top(fit_objects(layout, placement, candidates));
    add_up();
}

/// Makes `objects` those of the layout's drawables. Returns the numbers of those that were added, or whose
/// item has another number.
std::vector<std::uint32_t> SceneHierarchy::take_over(const SceneLayout& layout) {
    objects.resize(layout.drawables.size());
    placed_.resize(objects.size(), {.bvh = &empty_bvh});
    std::vector<std::uint32_t> added;
    std::vector<std::uint32_t> renumbered;
    visit_changes(drawables_, layout.drawables, [&](std::size_t i) {
        const auto object = static_cast<std::uint32_t>(i);
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        const bool is_solid = SceneLayout::is_solid(drawable);
        const bool stays = objects[i] && is_solid && objects[i]->drawn == drawable.drawn &&
                           objects[i]->entity == drawable.entity;
        if (stays) return renumbered.push_back(object);
        if (objects[i]) remove(object);
        if (is_solid) added.push_back(object);
    });
    std::ranges::sort(added, {}, [&](std::uint32_t object) {
        const SceneLayout::Drawable& drawable = layout.drawables[object];
        return key_of(drawable.entity, *drawable.drawn);
    });
    for (const std::uint32_t object : added) add(object, layout);
    drawables_ = layout.drawables;
    added.insert(added.end(), renumbered.begin(), renumbered.end());
    return added;
}

void SceneHierarchy::remove(std::uint32_t object) {
    top.remove(object);
    ids.remove(objects[object]->key());
    freed_.nodes.push_back(objects[object]->nodes);
    freed_.triangles.push_back(objects[object]->triangles);
    objects[object] = nullptr;
    placed_[object] = {.bvh = &empty_bvh};
    removed_.push_back(object);
}

void SceneHierarchy::add(std::uint32_t object, const SceneLayout& layout) {
    const SceneLayout::Drawable& drawable = layout.drawables[object];
    objects[object] = std::make_unique<ObjectHierarchy>();
    objects[object]->entity = drawable.entity;
    objects[object]->drawn = drawable.drawn;
    note_place(object);
    const auto triangles = static_cast<std::uint32_t>(drawable.primitive().indices.size() / 3);
    if (ids.insert(objects[object]->key(), triangles)) return;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        if (!objects[i] || !objects[i]->source.is_made) continue;
        objects[i]->triangles.uploaded = false;
        changed_.push_back(i);
    }
}

SceneHierarchy::Fitted SceneHierarchy::fit_objects(const SceneLayout& layout, const ScenePlacement& placement,
                                                   const std::vector<std::uint32_t>& candidates) {
    Fitted fitted;
    for (const std::uint32_t i : candidates) {
        ObjectHierarchy& object = *objects[i];
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        if (is_made_from(object.source, layout, drawable, placement)) continue;
        object.source = {.is_made = true,
                         .mirrored = layout.geometry.items[drawable.item].mirrored,
                         .world = placement.world[drawable.item],
                         .vertices = deformed_vertices(placement.deformed, drawable.item)};
        const std::vector<Triangle> triangles =
            place_triangles(layout, drawable, vertices_of(drawable, placement.deformed), object.source.world);
        const BufferRange nodes = object.nodes;
        (fit(object, triangles) ? fitted.built : fitted.refitted).push_back(i);
        if (object.nodes.first != nodes.first) freed_.nodes.push_back(nodes);
        object.area = static_cast<float>(area_of(triangles));
        // The second texture coordinates follow as triangles of their own.
        const std::uint32_t records = traces_second_uvs(drawable.primitive()) ? 2 : 1;
        object.triangles.count = records * static_cast<std::uint32_t>(triangles.size());
        object.nodes.uploaded = object.triangles.uploaded = false;
        changed_.push_back(i);
    }
    std::ranges::sort(changed_);
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    return fitted;
}

void SceneHierarchy::fit_top(const Fitted& fitted) {
    const bool builds = fitted.built.size() > objects.size() / 4;
    if (!builds) {
        for (const std::uint32_t i : fitted.built) {
            top.remove(i);
            top.insert(placed_, i);
        }
        top.refit(placed_, fitted.refitted);
    }
    if (builds || top.is_worn()) top.build(placed_);
}

/// Areas are floats, so that sums of them in doubles are exact, or nearly so: they must not depend on the
/// numbers that objects happen to have.
void SceneHierarchy::add_up() {
    removed_.insert(removed_.end(), changed_.begin(), changed_.end());
    std::vector<std::size_t> blocks;
    for (const std::uint32_t i : std::exchange(removed_, {})) blocks.push_back(i / block_size);
    std::ranges::sort(blocks);
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    sums_.resize((objects.size() + block_size - 1) / block_size);
    for (const std::size_t block : blocks) {
        Sums& sums = sums_[block] = {};
        const std::size_t end = std::min(objects.size(), (block + 1) * block_size);
        for (std::size_t i = block * block_size; i < end; ++i) {
            if (!objects[i]) continue;
            sums.triangles += objects[i]->bvh.order.size();
            sums.area += static_cast<double>(objects[i]->area);
            sums.reflecting += static_cast<double>(objects[i]->area * objects[i]->drawn->albedo);
        }
    }
}

SceneMetrics SceneHierarchy::metrics() const {
    SceneMetrics metrics;
    Sums all;
    for (const Sums& sums : sums_) {
        all.triangles += sums.triangles;
        all.area += sums.area;
        all.reflecting += sums.reflecting;
    }
    metrics.triangles = all.triangles;
    if (metrics.triangles == 0) return metrics;
    const BvhNode& root = top.top().bvh.nodes.front();
    metrics.lower = root.lower;
    metrics.upper = root.upper;
    metrics.area = static_cast<float>(all.area);
    metrics.mean_albedo = all.area > 0.0 ? static_cast<float>(all.reflecting / all.area) : 0.0F;
    return metrics;
}

void SceneHierarchy::note_place(std::uint32_t object) {
    const ObjectHierarchy& hierarchy = *objects[object];
    placed_[object] = {&hierarchy.bvh, hierarchy.nodes.first, hierarchy.triangles.first};
}

}  // namespace candela
