#include "renderer/passes/scene/scene_hierarchy.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <numeric>
#include <optional>
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
    return source.is_made && source.material == drawable.material &&
           source.mirrored == layout.geometry.items[drawable.item].mirrored &&
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

/// The positions of a longest increasing subsequence of the first ids (Schensted, 1961).
std::vector<std::size_t> longest_rise(const std::vector<IdRange>& ids) {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> last;  // position of the smallest last id of the subsequences of each length
    std::vector<std::size_t> before(ids.size(), none);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (ids[i].first == IdRange::unset) continue;
        const bool is_largest = last.empty() || ids[last.back()].first < ids[i].first;
        const auto at = is_largest ? last.end()
                                   : std::ranges::lower_bound(last, ids[i].first, {},
                                                              [&](std::size_t p) { return ids[p].first; });
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

/// Gives ids to those that have none, between their neighbours'. Returns false where there are too few
/// between.
bool fill_in_ids(std::vector<IdRange>& ids) {
    std::uint32_t next = 0;
    for (IdRange& range : ids) {
        if (range.first == IdRange::unset) range.first = next;
        if (range.first < next) return false;
        next = range.first + range.count;
    }
    return next < TRIANGLE_MASKED;
}

/// Makes the ids of the triangles increase from object to object, so that of two triangles at the same
/// distance the same one is hit whatever has come and gone before. Changes few ids: as many as possible stay,
/// and there is room before and between them.
void order_ids(std::vector<IdRange>& ids) {
    std::vector<bool> stays(ids.size());
    for (const std::size_t i : longest_rise(ids)) {
        stays[i] = true;
    }
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        sum += ids[i].count;
        if (!stays[i]) ids[i].first = IdRange::unset;
    }
    if (std::ranges::find(stays, true) != stays.end() && fill_in_ids(ids)) return;
    const auto room = static_cast<std::uint32_t>((TRIANGLE_MASKED - sum) / (ids.size() + 1));
    std::uint32_t next = room;
    for (IdRange& range : ids) {
        range.first = next;
        next += range.count + room;
    }
}

/// Numbers of the elements of lists that have no other key than the index of an entity.
class ByEntity {
 public:
    void add(Entity entity) {
        if (entity.index >= first_.size()) first_.resize(entity.index + std::size_t{1}, none);
        next_.push_back(std::exchange(first_[entity.index], static_cast<std::uint32_t>(next_.size())));
    }
    /// The first number for which `is_it(number)` holds; nullopt if there is none.
    template <class IsIt>
    [[nodiscard]] std::optional<std::uint32_t> find(Entity entity, IsIt is_it) const {
        if (entity.index >= first_.size()) return std::nullopt;
        for (std::uint32_t i = first_[entity.index]; i != none; i = next_[i]) {
            if (is_it(i)) return i;
        }
        return std::nullopt;
    }

 private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> first_;  // by the entity's index
    std::vector<std::uint32_t> next_;   // by number
};

}  // namespace

/// Makes `objects` those of the layout's drawables, and keeps what was made for the same ones.
void SceneHierarchy::take_over(const SceneLayout& layout) {
    ByEntity known;
    for (const Identity& identity : identities_) known.add(identity.entity);
    std::vector<std::uint32_t> now(objects.size(), KeptTop::gone);
    std::vector<std::unique_ptr<ObjectHierarchy>> taken;
    std::vector<IdRange> taken_ids;
    std::vector<Identity> identities;
    for (const SceneLayout::Drawable& drawable : layout.solids()) {
        const SceneGeometry::Item& item = layout.geometry.items[drawable.item];
        identities.push_back({item.entity, drawable.primitive});
        const auto found =
            known.find(item.entity, [&](std::uint32_t i) { return identities_[i] == identities.back(); });
        if (found) {
            now[*found] = static_cast<std::uint32_t>(taken.size());
            taken.push_back(std::move(objects[*found]));
            taken_ids.push_back(ids[*found]);
        } else {
            taken.push_back(std::make_unique<ObjectHierarchy>());
            taken.back()->mesh = item.mesh;
            taken_ids.push_back(
                {.count = static_cast<std::uint32_t>(drawable.primitive->indices.size() / 3)});
        }
    }
    top.renumber(now, taken.size());
    objects = std::move(taken);
    identities_ = std::move(identities);
    ids = taken_ids;
    order_ids(ids);
    placed_.resize(objects.size());
    for (std::uint32_t i = 0; i < ids.size(); ++i) {
        if (ids[i].first != taken_ids[i].first) objects[i]->triangles.uploaded = false;
        note_place(i);
    }
}

void SceneHierarchy::update(const SceneLayout& layout, const ScenePlacement& placement, bool other_layout) {
    changed_.clear();
    std::vector<std::uint32_t> candidates;
    if (other_layout) {
        take_over(layout);
        candidates.resize(objects.size());
        std::iota(candidates.begin(), candidates.end(), 0U);
    } else {
        candidates = moved_solids(layout, placement_, placement);
    }
    placement_ = placement;
    fit_top(fit_objects(layout, placement, candidates));
    add_up(layout, other_layout);
}

SceneHierarchy::Fitted SceneHierarchy::fit_objects(const SceneLayout& layout, const ScenePlacement& placement,
                                                   const std::vector<std::uint32_t>& candidates) {
    Fitted fitted;
    for (const std::uint32_t i : candidates) {
        ObjectHierarchy& object = *objects[i];
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        if (is_made_from(object.source, layout, drawable, placement)) {
            if (!object.triangles.uploaded) changed_.push_back(i);
            continue;
        }
        object.source = {.is_made = true,
                         .material = drawable.material,
                         .mirrored = layout.geometry.items[drawable.item].mirrored,
                         .world = placement.world[drawable.item],
                         .vertices = deformed_vertices(placement.deformed, drawable.item)};
        const std::vector<Triangle> triangles =
            place_triangles(layout, drawable, vertices_of(drawable, placement.deformed), object.source.world);
        (fit(object, triangles) ? fitted.built : fitted.refitted).push_back(i);
        object.area = area_of(triangles);
        // The second texture coordinates follow as triangles of their own.
        const std::uint32_t records = traces_second_uvs(*drawable.primitive) ? 2 : 1;
        object.triangles.count = records * static_cast<std::uint32_t>(triangles.size());
        object.nodes.uploaded = object.triangles.uploaded = false;
        changed_.push_back(i);
    }
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

void SceneHierarchy::add_up(const SceneLayout& layout, bool all) {
    sums_.resize((objects.size() + block_size - 1) / block_size);
    for (std::size_t block = 0; all && block < sums_.size(); ++block) add_up_block(layout, block);
    std::size_t last = sums_.size();
    for (const std::uint32_t i : changed_) {
        if (!all && std::exchange(last, i / block_size) != i / block_size) add_up_block(layout, last);
    }
}

void SceneHierarchy::add_up_block(const SceneLayout& layout, std::size_t block) {
    Sums& sums = sums_[block] = {};
    const std::size_t end = std::min(objects.size(), (block + 1) * block_size);
    for (std::size_t i = block * block_size; i < end; ++i) {
        sums.triangles += objects[i]->bvh.order.size();
        sums.area += objects[i]->area;
        sums.reflecting += objects[i]->area * static_cast<double>(layout.drawables[i].albedo);
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
