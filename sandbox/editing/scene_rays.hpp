#pragma once

#include <future>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include <glm/mat4x4.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include "sandbox/candela_private.hpp"
#include "sandbox/editing/viewport.hpp"

namespace candela::sandbox {

/// Where a ray meets a surface; world space, metres.
struct SurfaceHit {
    Entity entity;  ///< with the MeshInstance
    glm::vec3 point{0.0F};
    glm::vec3 normal{0.0F};  ///< of the triangle, unit length, towards the origin of the ray
    float distance = 0.0F;
};

/// Finds surfaces of a world along rays, on the CPU. A surface is what a picture shows: the backs of
/// single-sided materials are none. Deformed meshes count as undeformed, and holes of masks as surface.
///
/// Each mesh has a hierarchy of its own, in its local space, built in another thread; until that is done, the
/// mesh is not found. Moving an object only changes the small hierarchy over all objects.
class SceneRays {
 public:
    SceneRays() = default;
    /// Stops the other thread within a few hundredths of a second.
    ~SceneRays();
    SceneRays(const SceneRays&) = delete;
    SceneRays& operator=(const SceneRays&) = delete;

    /// Brings the searched surfaces up to date with the world, as far as their hierarchies have been built.
    /// Takes no time if no mesh or transform has changed since the last call.
    void update(const World& world);
    /// The same, but waits until all hierarchies have been built.
    void update_and_wait(const World& world);
    /// Whether hierarchies are being built.
    [[nodiscard]] bool building() const { return building_.valid(); }

    /// The first surface along the ray, within `most` metres. Entities in `ignored` (ascending) are skipped.
    [[nodiscard]] std::optional<SurfaceHit> first_hit(
        const Ray& ray, std::span<const Entity> ignored = {},
        float most = std::numeric_limits<float>::infinity()) const;

    /// Whether a surface hides `to` from `from`; world space. Materials that blend hide nothing.
    [[nodiscard]] bool blocked(const glm::vec3& from, const glm::vec3& to) const;

 private:
    /// Triangles of one material in the mesh's local space, few enough to be built without a noticeable wait.
    struct Patch {
        std::vector<Triangle> triangles;
        Bvh bvh;
        bool double_sided = false;
        bool blends = false;
    };
    using Patches = std::vector<Patch>;
    using Meshes = std::map<std::shared_ptr<const Mesh>, std::shared_ptr<const Patches>>;

    /// A patch of an entity's mesh. Its mesh is kept by `meshes_`.
    struct Placed {
        Entity entity;
        const Patch* patch = nullptr;
        glm::mat4 world_from_local{1.0F};
        glm::mat4 local_from_world{1.0F};
        bool operator==(const Placed&) const = default;
    };

    struct Found {
        float t;
        const Placed* placed;
        const Triangle* triangle;
    };

    static Meshes build(const std::vector<std::shared_ptr<const Mesh>>& meshes, const std::stop_token& stop);
    static Patches build_patches(const Mesh& mesh, const std::stop_token& stop);
    void take_built();
    void build_missing(const World& world);
    void place(const World& world);
    template <class Accepts>
    [[nodiscard]] std::optional<Found> search(const candela::Ray& ray, Accepts&& accepts) const;

    std::optional<Tick> meshes_at_;      ///< revision of the instances whose meshes are built or being built
    std::optional<Tick> transforms_at_;  ///< revision of the transforms in `placed_`
    Meshes meshes_;
    std::vector<Placed> placed_;
    Bvh top_;  ///< over the boxes of `placed_`
    std::stop_source stop_;
    std::future<Meshes> building_;
};

}  // namespace candela::sandbox
