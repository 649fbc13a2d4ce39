#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <candela/scene/gltf.hpp>
#include "engine/import/gltf_document.hpp"
#include "engine/import/gltf_nodes.hpp"
#include "engine/import/gltf_skins.hpp"

namespace candela::gltf {

/// The skins of staged entities that have a mesh, by index, and the meshes that have a skin.
struct Skinned {
    std::vector<bool> skins;
    std::vector<bool> meshes;
};

/// Takes the skin from entities without a mesh, with a warning.
[[nodiscard]] Skinned find_skinned(Document& document, std::vector<StagedEntity>& staged);

/// The morph weights and the skin of an entity, as the file has them.
struct Figure {
    std::vector<float> weights{};    ///< of the mesh's morph targets
    const ReadSkin* skin = nullptr;  ///< null without one; owned by the Figures
};

/// Gives entities their skins and the weights of their morph targets.
class Figures {
 public:
    /// Reads the skins. One that needs other nodes than those of the scene is left out with a warning. Throws
    /// SceneError.
    Figures(Document& document, const std::vector<StagedEntity>& staged, const Skinned& skinned,
            ImportBudget& budget);

    /// Of a staged entity with this mesh. Also counts the memory that deform_once needs. Throws SceneError.
    [[nodiscard]] Figure read(const StagedEntity& source, const Mesh& mesh) const;
    /// Sets the components of an entity. `created` are the entities that all staged ones have become.
    void add(Figure figure, Entity entity, const std::vector<Entity>& created, World& world) const;

 private:
    const Document& document_;
    ImportBudget& budget_;
    std::vector<std::optional<ReadSkin>> skins_;
    std::vector<std::optional<std::size_t>> places_;  // of nodes, among the staged entities
};

/// Gives the imported figures their shape in the file, for hosts that know nothing of animations. What is
/// wrong with some of them is one warning.
void deform_once(World& world, ImportReport& report);

}  // namespace candela::gltf
