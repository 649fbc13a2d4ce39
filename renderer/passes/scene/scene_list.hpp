#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include <candela/ecs/world_reader.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/hierarchy.hpp>
#include "engine/bvh/box.hpp"
#include "engine/scene/child_links.hpp"
#include "engine/shared_array.hpp"
#include "renderer/passes/scene/scene_check.hpp"

namespace candela {

/// The meshes of the world: an item for each MeshInstance, in the order of the world's view.
struct SceneGeometry {
    struct Item {
        Entity entity;
        std::shared_ptr<const Mesh> mesh;  ///< null if SceneCheck does not accept the entity
        bool mirrored = false;             ///< the world matrix reverses the winding of its triangles
        bool deformed = false;             ///< its entity has a DeformedMesh
        bool operator==(const Item&) const = default;
    };
    SharedArray<Item> items;
    bool operator==(const SceneGeometry&) const = default;
};

/// The vertices of a DeformedMesh, and the box around those of each primitive; local space.
struct Deformation {
    std::shared_ptr<const DeformedMesh::Vertices> vertices;
    std::vector<Box> bounds;
    bool operator==(const Deformation&) const = default;
};
/// By item; only of those that are deformed.
using Deformations = std::map<std::uint32_t, Deformation>;
/// Null if the item is not deformed.
[[nodiscard]] inline const Deformation* find_deformation(const Deformations& deformed, std::uint32_t item) {
    const auto found = deformed.find(item);
    return found == deformed.end() ? nullptr : &found->second;
}

/// Where the surfaces of the items are.
struct ScenePlacement {
    SharedArray<glm::mat4> world;  ///< local-to-world matrix of each item, by index; metres
    Deformations deformed;
    bool operator==(const ScenePlacement&) const = default;
};

/// The items of a world, kept from frame to frame: an update takes time in proportion to what has changed.
class SceneList {
 public:
    /// `check` must outlive it.
    explicit SceneList(SceneCheck& check) : check_(&check) {}

    /// Brings the items up to date with the world; throws as SceneCheck and WorldMatrices do. After that, the
    /// list must not be used any more.
    void update(const WorldReader& world);

    [[nodiscard]] const SceneGeometry& geometry() const { return geometry_; }
    [[nodiscard]] const ScenePlacement& placement() const { return placement_; }

 private:
    static constexpr std::uint32_t none = ChildLinks::none;

    void clear();
    void note_meshes(const WorldReader& world, std::span<const Change> changes);
    void note_shapes(const WorldReader& world, std::span<const Change> changes);
    void note_transforms(const WorldReader& world, std::span<const Change> changes);
    void touch_below(std::uint32_t entity);
    void refresh(const WorldReader& world, std::uint32_t item, WorldMatrices& matrices);
    [[nodiscard]] std::uint32_t item_of(std::uint32_t entity) const {
        return entity < item_of_.size() ? item_of_[entity] : none;
    }

    SceneCheck* check_;
    SceneGeometry geometry_;
    ScenePlacement placement_;
    std::vector<std::uint32_t> item_of_;  // by the entity's index
    ChildLinks children_;
    std::vector<std::uint32_t> touched_;  // items that may have changed, and places that may no longer exist
    std::vector<std::uint32_t> visited_;  // by the entity's index: the round in which touch_below was there
    std::uint32_t round_ = 0;
    // Revisions of the components in the last update.
    Tick meshes_at_ = 0;
    Tick shapes_at_ = 0;
    Tick transforms_at_ = 0;
};

}  // namespace candela
