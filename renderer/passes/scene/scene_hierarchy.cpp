#include "renderer/passes/scene/scene_hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>
#include <utility>

#include <glm/common.hpp>
#include <glm/gtx/component_wise.hpp>
#include <glm/matrix.hpp>

namespace candela {
namespace {

constexpr float rebuild_above = 1.5F;  // times the SAH cost at the last build

/// The deformed vertices of an item; null: it has those of the mesh.
std::shared_ptr<const DeformedMesh::Vertices> deformed_vertices(const Deformations& deformed,
                                                                std::uint32_t item) {
    const Deformation* const found = find_deformation(deformed, item);
    return found == nullptr ? nullptr : found->vertices;
}

double area_of(std::span<const Triangle> triangles) {
    double sum = 0.0;
    for (const Triangle& t : triangles) {
        sum += 0.5 * static_cast<double>(glm::length(glm::cross(t.b - t.a, t.c - t.a)));
    }
    return sum;
}

/// Whether rays can enter the space that a matrix leads from: rounding there must not grow beyond what the
/// offset of rays bears. The product is at least the matrix's condition number.
bool has_good_inverse(const glm::mat4& world) {
    constexpr float most = 1e4F;
    const auto size = [](const glm::mat3& m) {
        return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
    };
    const glm::mat3 matrix(world);
    return size(matrix) * size(glm::inverse(matrix)) < most;  // not if there is none
}

/// What the area of surfaces is multiplied by; nullopt: not the same factor for all.
std::optional<double> factor_of_areas(const glm::mat4& world) {
    constexpr float rounding = 1e-5F;
    const glm::mat3 matrix(world);
    const glm::mat3 squared = glm::transpose(matrix) * matrix;
    const float factor = squared[0][0];
    const glm::mat3 rest = squared - glm::mat3(factor);
    for (glm::length_t i = 0; i < 3; ++i) {
        if (!(glm::compMax(glm::abs(rest[i])) <= rounding * factor)) return std::nullopt;
    }
    return static_cast<double>(factor);
}

float area_in_world(const SceneObject& object) {
    if (const auto factor = factor_of_areas(object.world_from_mesh))
        return static_cast<float>(*factor * object.mesh->area);
    PlacedMesh placed = object.mesh->placed();
    placed.matrix = object.world_from_mesh;  // the hierarchy is in the mesh's space: others have the factor 1
    return static_cast<float>(area_of(placed.triangles()));
}

/// Adds the box around a node's triangles, from those of nodes so many levels below: the box around a turned
/// box is larger than need be.
void grow_by_node(Box& box, const Bvh& bvh, std::uint32_t index, const glm::mat4& world, int levels) {
    const BvhNode& node = bvh.nodes[index];
    if (node.count > 0 || levels == 0) return box.grow(place_box({node.lower, node.upper}, world));
    grow_by_node(box, bvh, node.first, world, levels - 1);
    grow_by_node(box, bvh, node.first + 1, world, levels - 1);
}

/// The box around an object, world space.
Box box_of(const SceneObject& object) {
    const Bvh& bvh = object.mesh->bvh;
    Box box;
    if (bvh.nodes.empty()) return box;
    constexpr int levels = 4;
    grow_by_node(box, bvh, 0, object.world_from_mesh, levels);
    return box;
}

}  // namespace

PlacedMesh MeshHierarchy::placed() const {
    const std::vector<Vertex>& own =
        vertices ? (*vertices)[drawn->index_in_mesh] : drawn->primitive().vertices;
    return {.drawn = *drawn, .vertices = own, .matrix = matrix, .mirrored = mirrored};
}

std::vector<MeshHierarchy*> SceneHierarchy::meshes_of(std::span<const std::uint32_t> which) const {
    std::vector<MeshHierarchy*> meshes;
    std::unordered_set<const MeshHierarchy*> known;
    for (const std::uint32_t i : which) {
        MeshHierarchy* const mesh = objects[i]->mesh.get();
        if (known.insert(mesh).second) meshes.push_back(mesh);
    }
    return meshes;
}

void SceneHierarchy::update(const SceneLayout& layout, const ScenePlacement& placement) {
    changed_.clear();
    std::vector<std::uint32_t> candidates = take_over(layout);
    const std::vector<std::uint32_t> moved = moved_solids(layout, placement_, placement);
    candidates.insert(candidates.end(), moved.begin(), moved.end());
    std::ranges::sort(candidates);
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    placement_ = placement;
    make_objects(layout, placement, candidates);
    free_meshes();
    fit_top();
    add_up();
}

/// Makes `objects` those of the layout's drawables. Returns the numbers of those that were added, or whose
/// item has another number.
std::vector<std::uint32_t> SceneHierarchy::take_over(const SceneLayout& layout) {
    objects.resize(layout.drawables.size());
    boxes_.resize(objects.size());
    std::vector<std::uint32_t> changed;
    visit_changes(drawables_, layout.drawables, [&](std::size_t i) {
        const auto object = static_cast<std::uint32_t>(i);
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        const bool is_solid = SceneLayout::is_solid(drawable);
        const bool stays = objects[i] && is_solid && objects[i]->drawn == drawable.drawn &&
                           objects[i]->entity == drawable.entity;
        if (objects[i] && !stays) remove(object);
        if (!is_solid) return;
        changed.push_back(object);
        if (!stays) objects[i] = std::make_unique<SceneObject>(SceneObject{drawable.entity, drawable.drawn});
    });
    drawables_ = layout.drawables;
    return changed;
}

void SceneHierarchy::remove(std::uint32_t object) {
    release(objects[object]->mesh);
    objects[object] = nullptr;
    boxes_[object] = {};
    top.set(object, {});
    removed_.push_back(object);
}

void SceneHierarchy::make_objects(const SceneLayout& layout, const ScenePlacement& placement,
                                  const std::vector<std::uint32_t>& candidates) {
    for (const std::uint32_t i : candidates) {
        SceneObject& object = *objects[i];
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        SceneObject::Source source{placement.world[drawable.item],
                                   deformed_vertices(placement.deformed, drawable.item)};
        if (object.mesh && object.source == source) continue;
        object.source = std::move(source);
        make(object, layout.geometry.items[drawable.item].mirrored);
        boxes_[i] = box_of(object);
        changed_.push_back(i);
    }
}

/// Makes an object from its source. `mirrored`: its matrix reverses the winding.
void SceneHierarchy::make(SceneObject& object, bool mirrored) {
    const std::shared_ptr<MeshHierarchy> last = object.mesh;
    const glm::mat4& world = object.source.world;
    const bool enters = has_good_inverse(world);
    if (!enters) {
        object.mesh = own_mesh(object, world, mirrored);
    } else if (object.source.vertices) {
        object.mesh = own_mesh(object, glm::mat4(1.0F), false);
    } else {
        object.mesh = shared_mesh(object);
    }
    object.world_from_mesh = enters ? world : glm::mat4(1.0F);
    object.mesh_from_world = glm::inverse(object.world_from_mesh);
    if (object.mesh != last) {
        ++object.mesh->users;
        release(last);
    }
    object.area = area_in_world(object);
}

std::shared_ptr<MeshHierarchy> SceneHierarchy::shared_mesh(const SceneObject& object) {
    std::shared_ptr<MeshHierarchy>& mesh = shared_[object.drawn.get()];
    if (!mesh) {
        mesh = std::make_shared<MeshHierarchy>();
        mesh->drawn = object.drawn;
        mesh->is_shared = true;
        fit(*mesh);
    }
    return mesh;
}

std::shared_ptr<MeshHierarchy> SceneHierarchy::own_mesh(const SceneObject& object, const glm::mat4& matrix,
                                                        bool mirrored) {
    const bool has_own = object.mesh && !object.mesh->is_shared;
    auto mesh = has_own ? object.mesh : std::make_shared<MeshHierarchy>();
    mesh->drawn = object.drawn;
    mesh->vertices = object.source.vertices;
    mesh->matrix = matrix;
    mesh->mirrored = mirrored;
    fit(*mesh);
    return mesh;
}

/// Fits a hierarchy to its triangles, or builds it.
void SceneHierarchy::fit(MeshHierarchy& mesh) {
    const std::vector<Triangle> triangles = mesh.placed().triangles();
    const bool has_been_built = mesh.bvh.order.size() == triangles.size();
    if (has_been_built) refit(mesh.bvh, triangles);
    if (!has_been_built || sah_cost(mesh.bvh) > rebuild_above * mesh.built_cost) {
        mesh.bvh = build_bvh(triangles, mesh_max_depth);
        mesh.built_cost = sah_cost(mesh.bvh);
        freed_.nodes.push_back(mesh.nodes);
        mesh.nodes = {.count = static_cast<std::uint32_t>(mesh.bvh.nodes.size() / 2)};
    }
    mesh.area = area_of(triangles);
    // The second texture coordinates follow as triangles of their own.
    const std::uint32_t records = traces_second_uvs(mesh.drawn->primitive()) ? 2 : 1;
    mesh.triangles.count = records * static_cast<std::uint32_t>(triangles.size());
    mesh.nodes.uploaded = mesh.triangles.uploaded = false;
}

/// One object fewer has the hierarchy. Null: the object had none.
void SceneHierarchy::release(const std::shared_ptr<MeshHierarchy>& mesh) {
    if (!mesh) return;
    --mesh->users;
    released_.push_back(mesh);
}

/// Frees the hierarchies that no object is made of any more. At the end of an update, since others may have
/// come.
void SceneHierarchy::free_meshes() {
    for (const std::shared_ptr<MeshHierarchy>& mesh : std::exchange(released_, {})) {
        if (mesh->users > 0) continue;
        freed_.nodes.push_back(std::exchange(mesh->nodes, {}));
        freed_.triangles.push_back(std::exchange(mesh->triangles, {}));
        if (mesh->is_shared) shared_.erase(mesh->drawn.get());
    }
}

void SceneHierarchy::fit_top() {
    const bool builds = changed_.size() > objects.size() / 4;
    for (std::size_t i = 0; !builds && i < changed_.size(); ++i) top.set(changed_[i], boxes_[changed_[i]]);
    if (builds || top.is_worn()) top.build(boxes_);
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
            sums.triangles += objects[i]->mesh->bvh.order.size();
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
    if (top.tree().nodes.empty()) return metrics;
    const BvhNode& root = top.tree().nodes.front();
    metrics.lower = root.lower;
    metrics.upper = root.upper;
    metrics.area = static_cast<float>(all.area);
    metrics.mean_albedo = all.area > 0.0 ? static_cast<float>(all.reflecting / all.area) : 0.0F;
    return metrics;
}

}  // namespace candela
