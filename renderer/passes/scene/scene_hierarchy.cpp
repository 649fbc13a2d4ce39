#include "renderer/passes/scene/scene_hierarchy.hpp"

#include <algorithm>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>

#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {
namespace {

constexpr float rebuild_above = 1.5F;  // times the SAH cost at the last build

/// The drawables of two layouts that are the same: one primitive of one entity.
struct Identity {
    Entity entity;
    const Primitive* primitive;
    bool operator==(const Identity&) const = default;
};

struct IdentityHash {
    std::size_t operator()(const Identity& identity) const {
        return std::hash<const Primitive*>()(identity.primitive) * 31 + identity.entity.index;
    }
};

ObjectHierarchy::Source source_of(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                                  const ScenePlacement& placement) {
    const SceneGeometry::Item& item = layout.geometry.items[drawable.item];
    const auto deformed = placement.deformed.find(drawable.item);
    return {.entity = item.entity,
            .primitive = drawable.primitive,
            .material = drawable.material,
            .mirrored = item.mirrored,
            .world = placement.world[drawable.item],
            .vertices = deformed == placement.deformed.end() ? nullptr : deformed->second.vertices};
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

constexpr std::uint32_t no_id = std::numeric_limits<std::uint32_t>::max();

/// The positions of a longest increasing subsequence of the objects' first ids (Schensted, 1961).
std::vector<std::size_t> longest_rise(const std::vector<ObjectHierarchy>& objects) {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> last;  // position of the smallest last id of the subsequences of each length
    std::vector<std::size_t> before(objects.size(), none);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (objects[i].first_id == no_id) continue;
        const auto at = std::ranges::lower_bound(last, objects[i].first_id, {},
                                                 [&](std::size_t p) { return objects[p].first_id; });
        before[i] = at == last.begin() ? none : *(at - 1);
        if (at == last.end()) {
            last.push_back(i);
        } else {
            *at = i;
        }
    }
    std::vector<std::size_t> rise;
    for (std::size_t i = last.empty() ? none : last.back(); i != none; i = before[i]) {
        rise.push_back(i);
    }
    std::ranges::reverse(rise);
    return rise;
}

std::uint32_t triangle_count(const ObjectHierarchy& object) {
    return static_cast<std::uint32_t>(object.source.primitive->indices.size() / 3);
}

void set_first_id(ObjectHierarchy& object, std::uint32_t id) {
    object.triangles.uploaded &= object.first_id == id;
    object.first_id = id;
}

/// Gives ids to those that have none, between their neighbours'. Returns false where there are too few
/// between.
bool fill_in_ids(std::vector<ObjectHierarchy>& objects) {
    std::uint32_t next = 0;
    for (ObjectHierarchy& object : objects) {
        if (object.first_id == no_id) set_first_id(object, next);
        if (object.first_id < next) return false;
        next = object.first_id + triangle_count(object);
    }
    return next < TRIANGLE_MASKED;
}

/// Makes the ids of the triangles increase from object to object, so that of two triangles at the same
/// distance the same one is hit whatever has come and gone before. Changes few ids: as many as possible stay,
/// and there is room before and between them.
void order_ids(std::vector<ObjectHierarchy>& objects) {
    std::vector<bool> stays(objects.size());
    for (const std::size_t i : longest_rise(objects)) {
        stays[i] = true;
    }
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        sum += triangle_count(objects[i]);
        if (!stays[i]) set_first_id(objects[i], no_id);
    }
    if (std::ranges::find(stays, true) != stays.end() && fill_in_ids(objects)) return;
    const auto room = static_cast<std::uint32_t>((TRIANGLE_MASKED - sum) / (objects.size() + 1));
    std::uint32_t next = room;
    for (ObjectHierarchy& object : objects) {
        set_first_id(object, next);
        next += triangle_count(object) + room;
    }
}

}  // namespace

/// Makes `objects` those of the layout's drawables, and keeps what was made for the same ones. Returns
/// whether any is new or gone.
bool SceneHierarchy::take_over(const SceneLayout& layout) {
    std::unordered_map<Identity, std::size_t, IdentityHash> known;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        known.emplace(Identity{objects[i].source.entity, objects[i].source.primitive}, i);
    }
    std::vector<ObjectHierarchy> taken;
    bool same = true;
    for (const SceneLayout::Drawable& drawable : layout.solids()) {
        const SceneGeometry::Item& item = layout.geometry.items[drawable.item];
        const auto found = known.find({item.entity, drawable.primitive});
        if (found != known.end()) {
            same &= found->second == taken.size();
            taken.push_back(std::move(objects[found->second]));
            continue;
        }
        same = false;
        ObjectHierarchy object;
        object.mesh = item.mesh;
        object.source.primitive = drawable.primitive;
        object.first_id = no_id;
        taken.push_back(std::move(object));
    }
    same &= taken.size() == objects.size();
    objects = std::move(taken);
    order_ids(objects);
    return !same;
}

void SceneHierarchy::update(const SceneLayout& layout, const ScenePlacement& placement, bool other_layout) {
    bool other_topology = other_layout && take_over(layout);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        ObjectHierarchy& object = objects[i];
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        const ObjectHierarchy::Source source = source_of(layout, drawable, placement);
        if (object.source == source) continue;
        object.source = source;
        const std::vector<Triangle> triangles =
            place_triangles(layout, drawable, vertices_of(drawable, placement.deformed), source.world);
        other_topology |= fit(object, triangles);
        object.area = area_of(triangles);
        // The second texture coordinates follow as triangles of their own.
        const std::uint32_t records = traces_second_uvs(*drawable.primitive) ? 2 : 1;
        object.triangles.count = records * static_cast<std::uint32_t>(triangles.size());
        object.nodes.uploaded = object.triangles.uploaded = false;
    }

    const std::vector<PlacedBvh> placed = placed_objects();
    if (!other_topology) {
        refit_top(top, placed);
        other_topology = sah_cost(top.bvh) > rebuild_above * top_cost_;
    }
    if (other_topology) {
        top = build_top(placed);
        top_cost_ = sah_cost(top.bvh);
    }
}

SceneMetrics SceneHierarchy::metrics(const SceneLayout& layout) const {
    SceneMetrics metrics;
    Box bounds;
    double area_sum = 0.0;
    double reflecting_sum = 0.0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        metrics.triangles += objects[i].bvh.order.size();
        if (!objects[i].bvh.nodes.empty()) {
            const BvhNode& root = objects[i].bvh.nodes.front();
            bounds.grow(Box{root.lower, root.upper});
        }
        area_sum += objects[i].area;
        reflecting_sum += objects[i].area * static_cast<double>(layout.drawables[i].albedo);
    }
    if (metrics.triangles == 0) return metrics;
    metrics.lower = bounds.lower;
    metrics.upper = bounds.upper;
    metrics.area = static_cast<float>(area_sum);
    metrics.mean_albedo = area_sum > 0.0 ? static_cast<float>(reflecting_sum / area_sum) : 0.0F;
    return metrics;
}

std::vector<PlacedBvh> SceneHierarchy::placed_objects() const {
    std::vector<PlacedBvh> placed;
    placed.reserve(objects.size());
    for (const ObjectHierarchy& object : objects) {
        placed.push_back({&object.bvh, object.nodes.first, object.triangles.first});
    }
    return placed;
}

}  // namespace candela
