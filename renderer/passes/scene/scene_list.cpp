#include "renderer/passes/scene/scene_list.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <glm/matrix.hpp>

#include "renderer/passes/scene/mesh_upload.hpp"

namespace candela {
namespace {

Deformation deformation_of(const DeformedMesh& deformed) {
    Deformation deformation{deformed.vertices, {}};
    for (const std::vector<Vertex>& vertices : *deformed.vertices) {
        deformation.bounds.push_back(box_around(vertices));
    }
    return deformation;
}

/// All entities that have a C, as if each had just got it.
template <Component C>
std::vector<Change> all_of(const WorldReader& world) {
    std::vector<Change> all;
    for (const Entity entity : world.entities<C>()) all.push_back({0, entity});
    return all;
}

}  // namespace

void SceneList::update(const WorldReader& world) {
    auto meshes = world.changes_since<MeshInstance>(meshes_at_);
    auto shapes = world.changes_since<DeformedMesh>(shapes_at_);
    auto transforms = world.changes_since<Transform>(transforms_at_);
    std::vector<Change> all_meshes;
    std::vector<Change> all_transforms;
    if (!meshes || !shapes || !transforms) {
        clear();
        all_meshes = all_of<MeshInstance>(world);
        all_transforms = all_of<Transform>(world);
        meshes = all_meshes;
        shapes = std::span<const Change>();
        transforms = all_transforms;
    }
    touched_.clear();
    note_meshes(world, *meshes);
    note_shapes(world, *shapes);
    note_transforms(world, *transforms);
    std::ranges::sort(touched_);
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());

    const std::size_t count = world.count<MeshInstance>();
    geometry_.items.resize(count);
    placement_.world.resize(count);
    placement_.deformed.erase(placement_.deformed.lower_bound(static_cast<std::uint32_t>(count)),
                              placement_.deformed.end());
    WorldMatrices matrices(world);
    for (const std::uint32_t item : touched_) {
        if (item < count) refresh(world, item, matrices);
    }
    meshes_at_ = world.revision<MeshInstance>();
    shapes_at_ = world.revision<DeformedMesh>();
    transforms_at_ = world.revision<Transform>();
}

void SceneList::clear() {
    *this = SceneList(*check_);
}

/// Where a component goes, the pool moves the last one there. So the places with other entities than before
/// are among the old and the new places of those that came or went.
void SceneList::note_meshes(const WorldReader& world, std::span<const Change> changes) {
    for (const Change& change : changes) {
        const std::uint32_t before = item_of(change.entity.index);
        if (before != none) touched_.push_back(before);
        const auto now = world.alive(change.entity) ? world.place<MeshInstance>(change.entity) : std::nullopt;
        if (now) {
            touched_.push_back(*now);
        } else if (before != none) {
            item_of_[change.entity.index] = none;
        }
    }
}

void SceneList::note_shapes(const WorldReader& world, std::span<const Change> changes) {
    for (const Change& change : changes) {
        if (!world.alive(change.entity)) continue;
        if (const auto item = world.place<MeshInstance>(change.entity)) touched_.push_back(*item);
    }
}

void SceneList::note_transforms(const WorldReader& world, std::span<const Change> changes) {
    ++round_;
    for (const Change& change : changes) {
        const auto* const transform =
            world.alive(change.entity) ? world.find<Transform>(change.entity) : nullptr;
        const bool has_parent = transform != nullptr && transform->parent;
        children_.set_parent(change.entity.index, has_parent ? transform->parent.index : none);
    }
    for (const Change& change : changes) touch_below(change.entity.index);
}

/// Marks the item of an entity and those of all that are placed relative to it.
void SceneList::touch_below(std::uint32_t entity) {
    std::vector<std::uint32_t> ahead{entity};
    while (!ahead.empty()) {
        const std::uint32_t at = ahead.back();
        ahead.pop_back();
        if (at >= visited_.size()) visited_.resize(at + std::size_t{1});
        if (std::exchange(visited_[at], round_) == round_) continue;
        if (item_of(at) != none) touched_.push_back(item_of(at));
        children_.visit_children(at, [&](std::uint32_t child) { ahead.push_back(child); });
    }
}

void SceneList::refresh(const WorldReader& world, std::uint32_t item, WorldMatrices& matrices) {
    const Entity entity = world.entities<MeshInstance>()[item];
    if (entity.index >= item_of_.size()) item_of_.resize(entity.index + std::size_t{1}, none);
    item_of_[entity.index] = item;

    const auto& instance = world.get<MeshInstance>(entity);
    const glm::mat4 matrix = matrices(entity);
    if (!check_->accepts(world, entity, instance) || !check_->accepts_at(world, entity, instance, matrix)) {
        geometry_.items.set(item, {.entity = entity, .mesh = nullptr});
        placement_.world.set(item, glm::mat4(1.0F));
        placement_.deformed.erase(item);
        return;
    }
    const auto* const deformed = world.find<DeformedMesh>(entity);
    geometry_.items.set(
        item, {entity, instance.mesh, glm::determinant(glm::mat3(matrix)) < 0.0F, deformed != nullptr});
    placement_.world.set(item, matrix);
    if (deformed == nullptr) {
        placement_.deformed.erase(item);
    } else if (Deformation& last = placement_.deformed[item]; last.vertices != deformed->vertices) {
        last = deformation_of(*deformed);
    }
}

}  // namespace candela
