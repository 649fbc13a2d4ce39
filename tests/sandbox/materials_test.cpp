#include "sandbox/editing/materials.hpp"

#include <doctest/doctest.h>

#include <candela/scene/gltf.hpp>
#include <candela/scene/gltf_export.hpp>
#include "tests/sandbox/editing_scene.hpp"
#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("materials of objects") {

namespace {

std::shared_ptr<const Material> named(const char* name) {
    Material material;
    material.name = name;
    return std::make_shared<const Material>(std::move(material));
}

/// The mesh with one more primitive of each of these materials.
std::shared_ptr<const Mesh> mesh_with(const std::vector<std::shared_ptr<const Material>>& materials) {
    const auto mesh = std::make_shared<Mesh>();
    for (const auto& material : materials) {
        mesh->primitives.push_back(square(1.0F)->primitives.front());
        mesh->primitives.back().material = material;
    }
    return mesh;
}

const Mesh* mesh_at(const World& world, Entity entity) {
    return world.get<MeshInstance>(entity).mesh.get();
}

const Material& material_at(const World& world, Entity entity, std::size_t primitive = 0) {
    return *mesh_at(world, entity)->primitives[primitive].material;
}

Material rough(const Material& material, float roughness) {
    Material changed = material;
    changed.roughness = roughness;
    return changed;
}

}  // namespace

TEST_CASE("a mesh lists each of its materials once") {
    const auto a = named("a");
    const auto b = named("b");
    CHECK(materials_of(*mesh_with({b, a, b, b, a})) == std::vector{b, a});
}

TEST_CASE("all surfaces of the material change, and all else is shared as before") {
    const auto old = named("old");
    const auto other = named("old");  // an equal one is another material
    const auto shared = mesh_with({other, old});
    const auto untouched = mesh_with({other});
    World world;
    const Entity first = add_mesh(world, shared);
    const Entity second = add_mesh(world, shared);
    const Entity third = add_mesh(world, mesh_with({old}));
    const Entity fourth = add_mesh(world, untouched);
    CHECK(users_of(world, *old) == std::vector{first, second, third});

    replace_material(world, *old, rough(*old, 0.25F));
    CHECK(users_of(world, *old).empty());
    CHECK(mesh_at(world, first) != shared.get());
    CHECK(mesh_at(world, first) == mesh_at(world, second));
    CHECK(mesh_at(world, fourth) == untouched.get());
    CHECK(material_at(world, first, 1).roughness == 0.25F);
    CHECK(&material_at(world, first, 1) == &material_at(world, third));
    CHECK(&material_at(world, first, 0) == other.get());
    CHECK(mesh_at(world, first)->primitives[1].vertices == shared->primitives[1].vertices);
    CHECK(mesh_at(world, first)->primitives[1].indices == shared->primitives[1].indices);
    // The mesh itself is what it was.
    CHECK(shared->primitives[1].material == old);
}

TEST_CASE("a material that nothing but the replaced mesh keeps") {
    World world;
    const Entity entity = add_mesh(world, mesh_with({named("only")}));
    const Entity other = add_mesh(world, world.get<MeshInstance>(entity).mesh);
    const Material& from = material_at(world, entity);
    replace_material(world, from, rough(from, 0.5F));
    CHECK(material_at(world, entity).name == "only");
    CHECK(material_at(world, other).roughness == 0.5F);
}

TEST_CASE("a gesture is one edit, whose undo and redo bring back the meshes themselves") {
    const auto old = named("gold");
    World world;
    History history;
    MaterialEdit edit;
    const auto mesh = mesh_with({old});
    const Entity first = add_mesh(world, mesh);
    const Entity second = add_mesh(world, mesh_with({old}));
    for (const float roughness : {0.9F, 0.8F, 0.7F}) {
        const auto now = mesh_at(world, first)->primitives[0].material;
        edit.change(now, rough(*now, roughness));
        edit.apply(world, history, false);
        CHECK(material_at(world, first).roughness == roughness);
        CHECK(material_at(world, second).roughness == roughness);
    }
    edit.apply(world, history, true);
    CHECK(history.undo_count() == 1);
    CHECK(history.undo_name() == "change gold");
    const Mesh* const changed = mesh_at(world, first);
    history.undo(world);
    CHECK(mesh_at(world, first) == mesh.get());
    CHECK(material_at(world, second).roughness == 1.0F);
    history.redo(world);
    CHECK(mesh_at(world, first) == changed);
}

TEST_CASE("gestures that have ended do not join") {
    World world;
    History history;
    MaterialEdit edit;
    const Entity entity = add_mesh(world, mesh_with({named("gold")}));
    for (const float roughness : {0.9F, 0.8F}) {
        const auto now = mesh_at(world, entity)->primitives[0].material;
        edit.change(now, rough(*now, roughness));
        edit.apply(world, history, true);
    }
    CHECK(history.undo_count() == 2);
}

TEST_CASE("large meshes change when the control is released, and show the value before") {
    Mesh large = *mesh_with({named("gold")});
    large.primitives[0].indices.resize(3 * (MaterialEdit::most_triangles_at_once + 1));
    const auto mesh = std::make_shared<const Mesh>(std::move(large));
    World world;
    History history;
    MaterialEdit edit;
    const Entity entity = add_mesh(world, mesh);
    const auto old = mesh->primitives[0].material;
    edit.change(old, rough(*old, 0.5F));
    edit.apply(world, history, false);
    CHECK(mesh_at(world, entity) == mesh.get());
    CHECK(edit.shown(old).roughness == 0.5F);
    edit.apply(world, history, true);
    CHECK(material_at(world, entity).roughness == 0.5F);
    CHECK(edit.shown(old).roughness == 1.0F);
    CHECK(history.undo_count() == 1);
}

TEST_CASE("a change of a material that is gone does nothing") {
    World world;
    History history;
    MaterialEdit edit;
    const auto old = named("gold");
    const Entity entity = add_mesh(world, mesh_with({old}));
    edit.change(old, rough(*old, 0.5F));
    world.remove<MeshInstance>(entity);
    edit.apply(world, history, true);
    CHECK(history.undo_count() == 0);
}

TEST_CASE("a saved scene has the material as it was changed") {
    const TemporaryFolder folder;
    World world;
    const auto old = named("gold");
    const Entity entity = add_mesh(world, mesh_with({old}));
    Material gold = *old;
    gold.base_colour = {0.75F, 0.5F, 0.25F, 1.0F};
    gold.metalness = 0.5F;
    gold.roughness = 0.25F;
    gold.specular = 0.75F;
    gold.emissive = {1.0F, 2.0F, 4.0F};
    replace_material(world, *old, gold);
    CHECK(export_gltf(world, folder / "gold.gltf").empty());
    World loaded;
    import_gltf(folder / "gold.gltf", loaded);
    REQUIRE(loaded.count<MeshInstance>() == 1);
    for (auto [found, instance] : loaded.view<MeshInstance>()) {
        const Material& material = *instance.mesh->primitives.at(0).material;
        CHECK(material.name == "gold");
        CHECK(material.base_colour == gold.base_colour);
        CHECK(material.metalness == gold.metalness);
        CHECK(material.roughness == gold.roughness);
        CHECK(material.specular == gold.specular);
        CHECK(material.emissive == gold.emissive);
    }
    CHECK(material_at(world, entity).metalness == 0.5F);
}
}  // TEST_SUITE("materials of objects")

}  // namespace candela::sandbox
