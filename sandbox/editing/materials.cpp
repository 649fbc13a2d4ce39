#include "sandbox/editing/materials.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace candela::sandbox {

namespace {

bool has_material(const Mesh& mesh, const Material& material) {
    return std::ranges::any_of(
        mesh.primitives, [&](const Primitive& primitive) { return primitive.material.get() == &material; });
}

std::shared_ptr<const Mesh> with_material(const Mesh& mesh, const Material& from,
                                          const std::shared_ptr<const Material>& to) {
    const auto copy = std::make_shared<Mesh>(mesh);
    for (Primitive& primitive : copy->primitives) {
        if (primitive.material.get() == &from) primitive.material = to;
    }
    return copy;
}

/// Of all different meshes of the entities.
std::size_t triangles_of(const World& world, const std::vector<Entity>& entities) {
    std::set<const Mesh*> meshes;
    for (const Entity entity : entities) meshes.insert(world.get<MeshInstance>(entity).mesh.get());
    std::size_t indices = 0;
    for (const Mesh* const mesh : meshes) {
        for (const Primitive& primitive : mesh->primitives) indices += primitive.indices.size();
    }
    return indices / 3;
}

}  // namespace

std::vector<std::shared_ptr<const Material>> materials_of(const Mesh& mesh) {
    std::vector<std::shared_ptr<const Material>> materials;
    for (const Primitive& primitive : mesh.primitives) {
        if (std::ranges::find(materials, primitive.material) == materials.end()) {
            materials.push_back(primitive.material);
        }
    }
    return materials;
}

std::vector<Entity> users_of(const World& world, const Material& material) {
    std::vector<Entity> users;
    for (auto [entity, instance] : world.view<MeshInstance>()) {
        if (has_material(*instance.mesh, material)) users.push_back(entity);
    }
    return users;
}

void replace_material(World& world, const Material& from, Material to) {
    const auto replacement = std::make_shared<const Material>(std::move(to));
    // Also keeps `from` until all have been replaced.
    std::map<std::shared_ptr<const Mesh>, std::shared_ptr<const Mesh>> copies;
    for (const Entity entity : users_of(world, from)) {
        const std::shared_ptr<const Mesh> mesh = world.get<MeshInstance>(entity).mesh;
        std::shared_ptr<const Mesh>& copy = copies[mesh];
        if (!copy) copy = with_material(*mesh, from, replacement);
        world.set(entity, MeshInstance{copy});
    }
}

const Material& MaterialEdit::shown(const std::shared_ptr<const Material>& material) const {
    return change_ && change_->from == material ? change_->to : *material;
}

void MaterialEdit::change(const std::shared_ptr<const Material>& material, Material to) {
    change_ = Change{material, std::move(to)};
}

void MaterialEdit::apply(World& world, History& history, bool released) {
    if (!change_) return;
    const std::vector<Entity> users = users_of(world, *change_->from);
    if (!released && triangles_of(world, users) > most_triangles_at_once) return;
    Change change = *std::exchange(change_, std::nullopt);
    EntityStates before = states_of(world, users);
    std::string name =
        change.to.name.empty() ? "change a material" : fmt::format("change {}", change.to.name);
    replace_material(world, *change.from, std::move(change.to));
    history.record(world, std::move(name), std::move(before));
    if (released) history.end_of_gesture();
}

}  // namespace candela::sandbox
