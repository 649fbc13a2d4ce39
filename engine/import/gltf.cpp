#include <candela/scene/gltf.hpp>

#include <utility>
#include <variant>

#include "engine/import/file_names.hpp"
#include "engine/import/gltf_animations.hpp"
#include "engine/import/gltf_document.hpp"
#include "engine/import/gltf_environment.hpp"
#include "engine/import/gltf_figures.hpp"
#include "engine/import/gltf_materials.hpp"
#include "engine/import/gltf_meshes.hpp"
#include "engine/import/gltf_nodes.hpp"
#include "engine/import/naming.hpp"

namespace candela {

namespace {

std::uint64_t count_triangles(const Mesh& mesh) {
    std::uint64_t triangles = 0;
    for (const Primitive& primitive : mesh.primitives) {
        triangles += primitive.indices.size() / 3;
    }
    return triangles;
}

std::vector<bool> used_meshes(const gltf::Document& document, const std::vector<gltf::StagedEntity>& staged) {
    std::vector<bool> used(document.all("meshes").size());
    for (const gltf::StagedEntity& entity : staged) {
        if (entity.mesh >= 0) used[static_cast<std::size_t>(entity.mesh)] = true;
    }
    return used;
}

void add_player(gltf::ReadAnimations animations, World& world, ImportReport& report) {
    if (animations.clips.empty()) return;
    Animations shared{std::move(animations.clips), {}};
    for (const std::size_t target : animations.targets) shared.targets.push_back(report.entities[target]);
    report.entities.push_back(world.create());
    world.set(report.entities.back(), Name{"animations"});
    world.set(report.entities.back(),
              AnimationPlayer{.animations = std::make_shared<const Animations>(std::move(shared))});
}

/// A node, with all that it becomes.
struct StagedNode {
    gltf::StagedEntity source;
    std::shared_ptr<const Mesh> mesh;  // null without one
    gltf::Figure figure{};             // of the mesh
};

std::vector<StagedNode> stage_nodes(std::vector<gltf::StagedEntity> staged,
                                    const std::vector<std::shared_ptr<const Mesh>>& meshes,
                                    const gltf::Figures& figures) {
    std::vector<StagedNode> nodes;
    for (gltf::StagedEntity& source : staged) {
        const auto mesh = source.mesh < 0 ? nullptr : meshes[static_cast<std::size_t>(source.mesh)];
        gltf::Figure figure = mesh ? figures.read(source, *mesh) : gltf::Figure{};
        nodes.push_back({std::move(source), mesh, std::move(figure)});
    }
    return nodes;
}

void create_nodes(std::vector<StagedNode> nodes, const gltf::Figures& figures, World& world,
                  ImportReport& report) {
    for (StagedNode& node : nodes) {
        gltf::StagedEntity& source = node.source;
        const Entity entity = report.entities.emplace_back(world.create());
        if (source.parent) source.transform.parent = report.entities[*source.parent];
        world.set(entity, Name{std::move(source.name)});
        world.set(entity, source.transform);
        if (node.mesh) {
            report.triangles += count_triangles(*node.mesh);
            world.set(entity, MeshInstance{node.mesh});
        }
        if (source.camera) world.set(entity, *source.camera);
        if (source.light) std::visit([&](const auto& light) { world.set(entity, light); }, *source.light);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        figures.add(std::move(nodes[i].figure), report.entities[i], report.entities, world);
    }
}

void add_environment(const gltf::NamedEnvironment& environment, World& world, ImportReport& report) {
    report.entities.push_back(world.create());
    world.set(report.entities.back(), Name{environment.name});
    world.set(report.entities.back(), environment.environment);
}

ImportReport import_document(gltf::Bytes bytes, const std::filesystem::path& base_directory, World& into,
                             gltf::ImportBudget& budget, const ImportOptions& options) {
    const gltf::Progress progress(options);
    progress("reading files", 0, 1);
    gltf::ImportFiles files(base_directory, options.root.empty() ? base_directory : options.root, budget);
    gltf::Document document = gltf::read_document(bytes, files, budget);
    std::vector<gltf::StagedEntity> staged = gltf::read_nodes(document, budget, progress);
    const std::vector<bool> used = used_meshes(document, staged);
    const auto materials = gltf::read_materials(document, used, files, budget, progress);
    const gltf::Skinned skinned = gltf::find_skinned(document, staged);
    const auto meshes = gltf::read_meshes(document, used, skinned.meshes, materials, budget, progress);
    const gltf::Figures figures(document, staged, skinned, budget);
    gltf::ReadAnimations animations = gltf::read_animations(document, staged, budget);
    const auto environment = gltf::read_environment(document, files, budget);
    progress("creating entities", 0, 1);
    std::vector<StagedNode> nodes = stage_nodes(std::move(staged), meshes, figures);
    ImportReport report;
    report.entities.reserve(nodes.size() + 2);  // so that each entity that is created stands in the report
    report.warnings = std::move(document.warnings);
    try {
        create_nodes(std::move(nodes), figures, into, report);
        add_player(std::move(animations), into, report);
        if (environment) add_environment(*environment, into, report);
        gltf::deform_once(into, report);
    } catch (...) {  // only memory can be lacking now
        for (const Entity entity : report.entities) into.destroy(entity);
        throw;
    }
    return report;
}

}  // namespace

ImportReport import_gltf(const std::filesystem::path& path, World& into, const ImportOptions& options) {
    return gltf::naming_file(gltf::utf8_of(path), [&] {
        gltf::ImportBudget budget(options.limits);
        const std::vector<unsigned char> bytes = gltf::read_file(path, "the file", budget);
        return import_document(bytes, path.parent_path(), into, budget, options);
    });
}

ImportReport import_gltf(std::span<const unsigned char> bytes, const std::filesystem::path& base_directory,
                         std::string_view name, World& into, const ImportOptions& options) {
    return gltf::naming_file(name, [&] {
        gltf::ImportBudget budget(options.limits);
        budget.add_file(bytes.size());
        return import_document(bytes, base_directory, into, budget, options);
    });
}

}  // namespace candela
