#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/bvh/kept_top.hpp"
#include "engine/bvh/wide.hpp"
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/passes/scene/scene_layout.hpp"
#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {

/// Properties of the whole scene that lighting uses, in world space. They cover the surfaces that stop light,
/// opaque and masked; holes in masks count as surface.
struct SceneMetrics {
    glm::vec3 lower{0.0F};  ///< corner of the bounding box, metres
    glm::vec3 upper{0.0F};
    float area = 0.0F;         ///< of all triangles, one side each, m²
    float mean_albedo = 0.0F;  ///< area-weighted mean of the strongest channel of each material's mean albedo
    std::uint64_t triangles = 0;
    bool operator==(const SceneMetrics&) const = default;

    [[nodiscard]] glm::vec3 centre() const { return (lower + upper) * 0.5F; }
    /// Radius of the bounding sphere of the box in metres; 0 for an empty scene.
    [[nodiscard]] float radius() const { return glm::length(upper - lower) * 0.5F; }
    /// Offset along the normal at which rays start, in metres: some hundred times the rounding error of
    /// positions, and four times it if the scene is far from the origin.
    [[nodiscard]] float ray_offset() const { return std::max(2e-5F * scale(), 4.0F * coordinate_step()); }
    /// Whether the scene is so far from the origin, for its size, that rounding determines the offset.
    [[nodiscard]] bool is_far() const { return ray_offset() > 2e-5F * scale(); }
    /// Distance between neighbouring floats at the scene's largest coordinate, metres.
    [[nodiscard]] float coordinate_step() const {
        const glm::vec3 most = glm::max(glm::abs(lower), glm::abs(upper));
        const float largest = std::max({most.x, most.y, most.z});
        return std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest;
    }
    /// The radius rounded down to a power of two, so that it rarely changes while objects move.
    [[nodiscard]] float scale() const {
        return radius() > 0.0F ? std::exp2(std::floor(std::log2(radius()))) : 0.0F;
    }
};

/// The hierarchy over the triangles of a primitive, and its place on the GPU. All objects of a primitive
/// share it. One that is deformed has its own, and so has one whose matrix has no good inverse, as of a flat
/// one: this is in world space.
struct MeshHierarchy {
    std::shared_ptr<const DrawnPrimitive> drawn;
    std::shared_ptr<const DeformedMesh::Vertices> vertices;  ///< null: those of the mesh
    glm::mat4 matrix{1.0F};  ///< leads from the mesh's space to that of the triangles
    bool mirrored = false;   ///< it reverses the winding
    bool is_shared = false;
    std::uint32_t users = 0;  ///< objects
    Bvh bvh;
    float built_cost = 0.0F;  ///< SAH cost at the last build
    double area = 0.0;        ///< of the triangles, one side each, m²
    BufferRange nodes;        ///< wide ones
    BufferRange triangles;

    [[nodiscard]] PlacedMesh placed() const;
    [[nodiscard]] MeshPlace place() const { return {nodes.first, triangles.first}; }
};

/// A solid drawable.
struct SceneObject {
    /// What it is made from, besides the primitive.
    struct Source {
        glm::mat4 world{1.0F};
        std::shared_ptr<const DeformedMesh::Vertices> vertices;  ///< null: those of the mesh
        bool operator==(const Source&) const = default;
    };
    Entity entity;
    std::shared_ptr<const DrawnPrimitive> drawn;
    Source source{};
    std::shared_ptr<MeshHierarchy> mesh{};  ///< null: it is not made yet
    glm::mat4 world_from_mesh{1.0F};  ///< leads from the space of the hierarchy's triangles to the world
    glm::mat4 mesh_from_world{1.0F};  ///< its inverse
    float area = 0.0F;                ///< of the triangles in world space, one side each, m²
};

/// The hierarchy over the triangles of all solid drawables, kept from frame to frame: a top over the objects
/// (engine/bvh/kept_top.hpp), and a hierarchy of each mesh. What is deformed is refitted, and built again
/// once its SAH cost exceeds 1.5 times that of the last build. An update takes no time for what has not
/// changed.
class SceneHierarchy {
 public:
    /// Brings everything up to date with the scene. The ranges of what has changed are not `uploaded` then.
    void update(const SceneLayout& layout, const ScenePlacement& placement);

    /// Numbers of the objects that the last update has changed or added, ascending.
    [[nodiscard]] const std::vector<std::uint32_t>& changed() const { return changed_; }
    /// The hierarchies of these objects, each once.
    [[nodiscard]] std::vector<MeshHierarchy*> meshes_of(std::span<const std::uint32_t> which) const;
    /// The ranges that have no mesh any more since the last call.
    struct Freed {
        std::vector<BufferRange> nodes;
        std::vector<BufferRange> triangles;
    };
    [[nodiscard]] Freed take_freed() { return std::exchange(freed_, {}); }

    [[nodiscard]] SceneMetrics metrics() const;

    std::vector<std::unique_ptr<SceneObject>> objects;  ///< by drawable; null unless it is solid
    KeptTop top;

 private:
    /// What a block of objects adds to the metrics.
    struct Sums {
        double area = 0.0;
        double reflecting = 0.0;
        std::uint64_t triangles = 0;
    };
    static constexpr std::size_t block_size = 64;

    [[nodiscard]] std::vector<std::uint32_t> take_over(const SceneLayout& layout);
    void remove(std::uint32_t object);
    void make_objects(const SceneLayout& layout, const ScenePlacement& placement,
                      const std::vector<std::uint32_t>& candidates);
    void make(SceneObject& object, bool mirrored);
    [[nodiscard]] std::shared_ptr<MeshHierarchy> shared_mesh(const SceneObject& object);
    [[nodiscard]] std::shared_ptr<MeshHierarchy> own_mesh(const SceneObject& object, const glm::mat4& matrix,
                                                          bool mirrored);
    void fit(MeshHierarchy& mesh);
    void release(const std::shared_ptr<MeshHierarchy>& mesh);
    void free_meshes();
    void fit_top();
    void add_up();

    std::unordered_map<const DrawnPrimitive*, std::shared_ptr<MeshHierarchy>> shared_;
    std::vector<std::shared_ptr<MeshHierarchy>> released_;  // by an object, in this update
    std::vector<Box> boxes_;                                // by object; empty: it is not in the top
    SharedArray<SceneLayout::Drawable> drawables_;          // in the last update
    ScenePlacement placement_;                              // in the last update
    std::vector<std::uint32_t> changed_;
    std::vector<std::uint32_t> removed_;  // since the last call of add_up
    Freed freed_;
    std::vector<Sums> sums_;  // by block of objects
};

}  // namespace candela
