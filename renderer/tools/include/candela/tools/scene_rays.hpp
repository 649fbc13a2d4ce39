#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include <candela/api.hpp>
#include <candela/ecs/world.hpp>
#include <candela/tools/ray.hpp>

namespace candela::tools {

/// Where a ray meets a surface; world space, metres.
struct SurfaceHit {
    Entity entity;  ///< with the MeshInstance
    glm::vec3 point{0.0F};
    glm::vec3 normal{0.0F};  ///< of the triangle, unit length, towards the origin of the ray
    float distance = 0.0F;
};

/// Finds surfaces of a world along rays, on the CPU. A surface is what a picture shows: the backs of
/// single-sided materials are none, and neither are meshes that Renderer::render leaves out. Deformed meshes
/// count as undeformed, and holes of masks as surface.
///
/// Each mesh has a hierarchy of its own, in its local space, built in another thread; until that is done, the
/// mesh is not found. Moving an object only changes the small hierarchy over all objects.
class CANDELA_API SceneRays {
 public:
    SceneRays();
    /// Stops the other thread within a few hundredths of a second.
    ~SceneRays();
    SceneRays(const SceneRays&) = delete;
    SceneRays& operator=(const SceneRays&) = delete;

    /// Brings the searched surfaces up to date with the world, as far as their hierarchies have been built.
    /// Takes no time if no mesh or transform has changed since the last call. Throws SceneError if an
    /// entity's parents form a cycle or were destroyed.
    void update(const World& world);
    /// The same, but waits until all hierarchies have been built.
    void update_and_wait(const World& world);
    /// Whether hierarchies are being built.
    [[nodiscard]] bool building() const;

    /// The first surface along the ray, within `most` metres. Entities in `ignored` (ascending) are skipped.
    [[nodiscard]] std::optional<SurfaceHit> first_hit(
        const Ray& ray, std::span<const Entity> ignored = {},
        float most = std::numeric_limits<float>::infinity()) const;

    /// Whether a surface hides `to` from `from`; world space. Materials that blend hide nothing.
    [[nodiscard]] bool blocked(const glm::vec3& from, const glm::vec3& to) const;

    /// The object that a point is inside of, from where no light gets out: in each of 14 directions the
    /// nearest triangle, or one as near, shows its back, and is of a single-sided material that does not
    /// blend. Of several such objects the nearest one; world space.
    [[nodiscard]] std::optional<Entity> enclosing(const glm::vec3& point) const;

 private:
    class State;

    std::unique_ptr<State> state_;
};

}  // namespace candela::tools
