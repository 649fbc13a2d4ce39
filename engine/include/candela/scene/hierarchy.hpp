#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include <glm/mat4x4.hpp>

#include <candela/api.hpp>
#include <candela/ecs/world_reader.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/scene_error.hpp>

namespace candela {

/// Local-to-parent matrix T·R·S of a transform, column vectors, metres.
[[nodiscard]] CANDELA_API glm::mat4 local_matrix(const Transform& transform);

/// A live entity as messages call it: by its Name, or by its index if it has none.
[[nodiscard]] CANDELA_API std::string describe(const WorldReader& world, Entity entity);

/// Local-to-world matrix of a live entity: the product of the local matrices from its topmost ancestor down.
/// An entity without a Transform has the identity. Takes time linear in the entity's depth, which is not
/// limited; for many entities use WorldMatrices. Throws SceneError, which names an entity, if an ancestor was
/// destroyed or if the ancestors form a cycle.
[[nodiscard]] CANDELA_API glm::mat4 world_matrix(const WorldReader& world, Entity entity);

/// World matrices of many entities, bit for bit those of `world_matrix`, in time linear in their number: the
/// matrices of parents are computed once. `world` must outlive it, and its Transforms must not change.
class CANDELA_API WorldMatrices {
 public:
    explicit WorldMatrices(const WorldReader& world) : world_(world) {}

    /// Throws like `world_matrix`.
    [[nodiscard]] glm::mat4 operator()(Entity entity);

 private:
    [[nodiscard]] glm::mat4 of_parent(Entity entity, const Transform& transform);

    WorldReader world_;
    std::unordered_map<std::uint32_t, glm::mat4> parents_;  // by index of the entity
    std::vector<Entity> ahead_;                             // of the last climb; kept for its capacity
};

}  // namespace candela
