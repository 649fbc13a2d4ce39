#include <candela/scene/gltf.hpp>

#include <utility>
#include <variant>

#include "engine/import/gltf_document.hpp"
#include "engine/import/gltf_environment.hpp"
#include "engine/import/gltf_materials.hpp"
#include "engine/import/gltf_meshes.hpp"
#include "engine/import/gltf_nodes.hpp"
#include "engine/import/naming_file.hpp"

namespace candela {

namespace {

void set_light(World&, Entity, std::monostate) {}

template <class Light>
void set_light(World& world, Entity entity, const Light& light) {
    world.set(entity, light);
}

std::uint64_t count_triangles(const Mesh& mesh) {
    std::uint64_t triangles = 0;
    for (const Primitive& primitive : mesh.primitives) {
        triangles += primitive.indices.size() / 3;
    }
    return triangles;
}

ImportReport create_entities(std::vector<gltf::StagedEntity> staged, World& world) {
    ImportReport report;
    for (gltf::StagedEntity& source : staged) {
        const Entity entity = world.create();
        if (source.parent) {
            source.transform.parent = report.entities[*source.parent];
        }
        world.set(entity, Name{std::move(source.name)});
        world.set(entity, source.transform);
        if (source.mesh) {
            report.triangles += count_triangles(*source.mesh);
            world.set(entity, MeshInstance{std::move(source.mesh)});
        }
        if (source.camera) {
            world.set(entity, *source.camera);
        }
        std::visit([&](const auto& light) { set_light(world, entity, light); }, source.light);
        report.entities.push_back(entity);
    }
    return report;
}

ImportReport import_document(gltf::Document document, const std::filesystem::path& base_directory,
                             World& into) {
    const auto materials = gltf::read_materials(document, base_directory);
    const auto meshes = gltf::read_meshes(document, materials);
    const auto environment = gltf::read_environment(document.model, base_directory);
    World grown = into;  // a copy, so that running out of memory halfway leaves the world as it was
    ImportReport report = create_entities(gltf::read_nodes(document, meshes), grown);
    if (environment) {
        report.entities.push_back(grown.create());
        grown.set(report.entities.back(), Name{environment->name});
        grown.set(report.entities.back(), environment->environment);
    }
    report.warnings = std::move(document.warnings);
    into = std::move(grown);
    return report;
}

}  // namespace

ImportReport import_gltf(const std::filesystem::path& path, World& into) {
    return gltf::naming_file(path.string(), [&] {
        const std::filesystem::path directory = path.parent_path();
        return import_document(gltf::read_document(gltf::read_file(path, "the file"), directory), directory,
                               into);
    });
}

ImportReport import_gltf(std::span<const unsigned char> bytes, const std::filesystem::path& base_directory,
                         std::string_view name, World& into) {
    return gltf::naming_file(name, [&] {
        return import_document(gltf::read_document(bytes, base_directory), base_directory, into);
    });
}

}  // namespace candela
