#include "engine/import/gltf_figures.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <candela/scene/animate.hpp>
#include <candela/scene/animation.hpp>
#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_morphs.hpp"
#include "engine/import/naming.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

std::uint64_t memory_to_deform(const Mesh& mesh) {
    std::uint64_t bytes = 0;
    for (const Primitive& primitive : mesh.primitives) {
        constexpr std::size_t by_influences = 4 * 2 * sizeof(float);
        bytes += primitive.vertices.size() * (sizeof(Vertex) + primitive.influences.size() * by_influences);
    }
    return bytes;
}

}  // namespace

Skinned find_skinned(Document& document, std::vector<StagedEntity>& staged) {
    Skinned skinned{std::vector<bool>(document.all("skins").size()),
                    std::vector<bool>(document.all("meshes").size())};
    bool is_ignored = false;
    for (StagedEntity& entity : staged) {
        if (entity.skin < 0) continue;
        if (entity.mesh < 0) {
            is_ignored = true;
            entity.skin = -1;
            continue;
        }
        skinned.skins[static_cast<std::size_t>(entity.skin)] = true;
        skinned.meshes[static_cast<std::size_t>(entity.mesh)] = true;
    }
    if (is_ignored) {
        document.warnings.emplace_back("skins of nodes without a mesh, or with instances, are ignored");
    }
    return skinned;
}

Figures::Figures(Document& document, const std::vector<StagedEntity>& staged, const Skinned& skinned,
                 ImportBudget& budget)
    : document_(document),
      budget_(budget),
      skins_(read_skins(document, skinned.skins, budget)),
      places_(document.all("nodes").size()) {
    for (std::size_t i = 0; i < staged.size(); ++i) {
        if (staged[i].is_node) places_[static_cast<std::size_t>(staged[i].node)] = i;
    }
    for (std::size_t i = 0; i < skins_.size(); ++i) {
        if (!skins_[i]) continue;
        const std::vector<int>& joints = skins_[i]->joints;
        const auto lost = std::ranges::find_if(
            joints, [&](int joint) { return !places_[static_cast<std::size_t>(joint)]; });
        if (lost == joints.end()) continue;
        document.warnings.push_back(
            fmt::format("skin {} is ignored: its joint, node {}, is not in the scene", i, *lost));
        skins_[i].reset();
    }
}

Figure Figures::read(const StagedEntity& source, const Mesh& mesh) const {
    const std::size_t targets = mesh.morph_weights.size();
    budget_.add_memory(2 * targets * sizeof(float));
    Figure figure{.weights = naming(fmt::format("node {}", source.node), [&] {
                      return read_morph_weights(document_.at("nodes", source.node), targets,
                                                mesh.morph_weights);
                  })};
    const bool has_skin = source.skin >= 0 && skins_[static_cast<std::size_t>(source.skin)];
    if (has_skin || targets > 0) budget_.add_memory(memory_to_deform(mesh));
    if (!has_skin) return figure;
    figure.skin = &*skins_[static_cast<std::size_t>(source.skin)];
    // Of the joints, and of their matrices when the mesh is deformed.
    budget_.add_memory(figure.skin->joints.size() * (sizeof(Entity) + 2 * sizeof(glm::mat4)));
    return figure;
}

void Figures::add(Figure figure, Entity entity, const std::vector<Entity>& created, World& world) const {
    if (!figure.weights.empty()) world.set(entity, MorphWeights{std::move(figure.weights)});
    if (figure.skin == nullptr) return;
    Skin component{{}, figure.skin->inverse_bind_matrices};
    for (const int joint : figure.skin->joints) {
        component.joints.push_back(created[*places_[static_cast<std::size_t>(joint)]]);
    }
    world.set(entity, std::move(component));
}

void deform_once(World& world, ImportReport& report) {
    const AnimationFaults faults = MeshDeformer().update(world, report.entities);
    if (faults.empty()) return;
    const std::string others =
        faults.size() > 1 ? fmt::format("; so do {} others", faults.size() - 1) : std::string();
    report.warnings.push_back(
        fmt::format("{}; it keeps the shape of its mesh{}", readable(faults[0], longest_message), others));
}

}  // namespace candela::gltf
