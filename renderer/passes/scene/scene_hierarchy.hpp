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
#include <utility>
#include <vector>

#include "engine/bvh/kept_top.hpp"
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/passes/scene/scene_layout.hpp"
#include "renderer/passes/scene/triangle_ids.hpp"

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

/// The hierarchy over the triangles of one solid drawable, in world space, and its place on the GPU.
struct ObjectHierarchy {
    /// What triangles and nodes are made from, besides the primitive.
    struct Source {
        bool is_made = false;
        bool mirrored = false;
        glm::mat4 world{1.0F};
        std::shared_ptr<const DeformedMesh::Vertices> vertices;  ///< null: those of the mesh
    };
    Entity entity;
    std::shared_ptr<const DrawnPrimitive> drawn;
    Source source;
    Bvh bvh;
    float built_cost = 0.0F;  ///< SAH cost at the last build
    float area = 0.0F;        ///< of the triangles, one side each, m²
    BufferRange nodes;        ///< wide ones
    BufferRange triangles;

    [[nodiscard]] PrimitiveKey key() const { return key_of(entity, *drawn); }
};

/// The hierarchy over the triangles of all solid drawables, kept from frame to frame: one for each, joined by
/// a top (engine/bvh/kept_top.hpp). What has moved is refitted, and built again once its SAH cost
/// exceeds 1.5 times that of the last build. An update takes no time for what has not changed.
class SceneHierarchy {
 public:
    /// Brings everything up to date with the scene. The ranges of what has changed are not `uploaded` then.
    void update(const SceneLayout& layout, const ScenePlacement& placement);

    /// Numbers of the objects that the last update has changed or added, ascending.
    [[nodiscard]] const std::vector<std::uint32_t>& changed() const { return changed_; }
    /// The ranges that have no object any more since the last call.
    struct Freed {
        std::vector<BufferRange> nodes;
        std::vector<BufferRange> triangles;
    };
    [[nodiscard]] Freed take_freed() { return std::exchange(freed_, {}); }

    [[nodiscard]] SceneMetrics metrics() const;
    /// The objects, and where they are in the buffers by the last call of note_place.
    [[nodiscard]] const std::vector<PlacedBvh>& placed() const { return placed_; }
    /// Takes over where the object's ranges are.
    void note_place(std::uint32_t object);

    std::vector<std::unique_ptr<ObjectHierarchy>> objects;  ///< by drawable; null unless it is solid
    TriangleIds ids;
    KeptTop top;

 private:
    /// What a block of objects adds to the metrics.
    struct Sums {
        double area = 0.0;
        double reflecting = 0.0;
        std::uint64_t triangles = 0;
    };
    static constexpr std::size_t block_size = 64;
    /// Numbers of the objects whose hierarchies have other boxes.
    struct Fitted {
        std::vector<std::uint32_t> refitted;  // with the topology that they had
        std::vector<std::uint32_t> built;
    };

    [[nodiscard]] std::vector<std::uint32_t> take_over(const SceneLayout& layout);
    void remove(std::uint32_t object);
    void add(std::uint32_t object, const SceneLayout& layout);
    [[nodiscard]] Fitted fit_objects(const SceneLayout& layout, const ScenePlacement& placement,
                                     const std::vector<std::uint32_t>& candidates);
    void fit_top(const Fitted& fitted);
    void add_up();

    std::vector<PlacedBvh> placed_;                 // by object
    SharedArray<SceneLayout::Drawable> drawables_;  // in the last update
    ScenePlacement placement_;                      // in the last update
    std::vector<std::uint32_t> changed_;
    std::vector<std::uint32_t> removed_;  // since the last call of add_up
    Freed freed_;
    std::vector<Sums> sums_;  // by block of objects
};

}  // namespace candela
