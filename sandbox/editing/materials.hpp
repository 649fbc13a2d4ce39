#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include "sandbox/editing/history.hpp"

namespace candela::sandbox {

/// The materials of a mesh, each of them once, in the order of its primitives.
[[nodiscard]] std::vector<std::shared_ptr<const Material>> materials_of(const Mesh& mesh);

/// The entities whose meshes have the material: that object, not an equal one.
[[nodiscard]] std::vector<Entity> users_of(const World& world, const Material& material);

/// Gives all surfaces that have the material `from` the material `to` instead. A mesh with it is replaced by
/// a copy, which its entities share as they shared the mesh; all other meshes stay as they are.
void replace_material(World& world, const Material& from, Material to);

/// What a user changes in a material, as far as it is not in the world yet. Meshes are copied for each
/// change: if they are large, that waits until the user has released the control.
class MaterialEdit {
 public:
    /// Most triangles of meshes that are copied while a control is held.
    static constexpr std::size_t most_triangles_at_once = 20'000;

    /// The material with the change.
    [[nodiscard]] const Material& shown(const std::shared_ptr<const Material>& material) const;
    /// Replaces an earlier change. `material` is one of the world's.
    void change(const std::shared_ptr<const Material>& material, Material to);
    /// Call this in each frame: changes the world, and keeps that in the history. All changes until
    /// `released` are one edit.
    void apply(World& world, History& history, bool released);

 private:
    struct Change {
        std::shared_ptr<const Material> from;
        Material to;
    };
    std::optional<Change> change_;
};

}  // namespace candela::sandbox
