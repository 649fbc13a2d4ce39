#pragma once

#include <array>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include "renderer/tools/reference/embree.hpp"
#include "renderer/tools/reference/materials.hpp"

namespace candela::reference {

/// In world space, counter-clockwise as seen from the front.
struct Triangle {
    struct Corner {
        glm::vec3 position;
        glm::vec3 normal;  ///< as in the mesh, not of unit length
        glm::vec2 uv;
        glm::vec4 colour;  ///< multiplies that of the material
    };
    std::array<Corner, 3> corners;
    glm::vec3 front;               ///< unit normal of the plane
    std::uint32_t material;        ///< index
    std::uint32_t part;            ///< one number per primitive of each placed mesh
    std::uint32_t tangents;        ///< index; only if the material has a normal texture
    std::uint32_t second_uvs = 0;  ///< index; only if the material needs them
};

/// Tangents of a triangle's corners in world space, not of unit length; w as in Vertex::tangent.
using Tangents = std::array<glm::vec4, 3>;
/// Second texture coordinates of a triangle's corners.
using SecondUvs = std::array<glm::vec2, 3>;

struct Ray {
    glm::vec3 origin;
    glm::vec3 direction;
    float nearest = 0.0F;  ///< in units of the direction's length
    float farthest;
};

struct Hit {
    float distance;          ///< in units of the ray's direction
    std::uint32_t triangle;  ///< index
    glm::vec2 weights;       ///< of the second and the third corner
};

/// What a camera sees along a ray.
struct Sight {
    std::vector<Hit> blended;  ///< in front of the solid surface, the nearest first
    std::optional<Hit> solid;
};

/// A sphere around all triangles; radius 0 if there are none.
struct Sphere {
    glm::vec3 centre{0.0F};  ///< metres
    float radius = 0.0F;     ///< metres
};

/// All triangles of a scene and Embree's hierarchies over them.
class Geometry {
 public:
    /// Throws SceneError for invalid transforms and std::runtime_error if Embree fails.
    explicit Geometry(const World& world);
    Geometry(const Geometry&) = delete;  // Embree stores its address
    Geometry& operator=(const Geometry&) = delete;
    ~Geometry() = default;

    /// The nearest opaque or masked surface, from either side.
    [[nodiscard]] std::optional<Hit> closest(const Ray& ray) const;
    /// Whether the ray hits an opaque or masked surface.
    [[nodiscard]] bool is_blocked(const Ray& ray) const;
    /// What a camera sees: backs of single-sided surfaces are invisible.
    [[nodiscard]] Sight look(const Ray& ray) const;

    [[nodiscard]] const Triangle& triangle(std::uint32_t index) const { return triangles_[index]; }
    [[nodiscard]] std::uint32_t triangle_count() const {
        return static_cast<std::uint32_t>(triangles_.size());
    }
    [[nodiscard]] const SurfaceMaterial& material(const Triangle& triangle) const {
        return materials_[triangle.material];
    }
    /// Of a triangle whose material has a normal texture.
    [[nodiscard]] const Tangents& tangents(const Triangle& triangle) const {
        return tangents_[triangle.tangents];
    }
    /// Where the images of its material lie.
    [[nodiscard]] ImagePlace image_place(const Triangle& triangle, glm::vec2 weights) const;
    /// The distance in metres at which rays start above a surface: about 100 times the rounding of positions.
    [[nodiscard]] float ray_offset() const { return 1e-5F * bounds_.radius; }
    [[nodiscard]] const Sphere& bounds() const { return bounds_; }

 private:
    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
    using Accelerator = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;

    /// The triangles of one alpha mode, which are consecutive. The index of the group is Embree's geometry
    /// id.
    struct Group {
        std::uint32_t first;
        std::uint32_t count;
        const Geometry* geometry;
    };

    void gather(const World& world);
    void add(const Primitive& primitive, const glm::mat4& to_world, std::uint32_t material,
             std::uint32_t part);
    void group_by_alpha();
    void measure();
    [[nodiscard]] Accelerator accelerate(std::size_t groups, int flags);
    void attach(RTCScene scene, std::size_t index);
    [[nodiscard]] std::optional<Hit> to_hit(const RTCRayHit& query) const;

    static void skip_holes(const RTCFilterFunctionNArguments* arguments);
    static void skip_unseen(const RTCFilterFunctionNArguments* arguments);

    std::vector<SurfaceMaterial> materials_;
    std::vector<Triangle> triangles_;
    std::vector<Tangents> tangents_;
    std::vector<SecondUvs> second_uvs_;
    std::array<Group, 3> groups_{};  // opaque, masked, blended
    Sphere bounds_;
    Device device_;
    Accelerator solids_;
    Accelerator all_;
};

/// The position in metres; `weights` are those of the second and third corner.
[[nodiscard]] glm::vec3 position_at(const Triangle& triangle, glm::vec2 weights);
[[nodiscard]] glm::vec3 normal_at(const Triangle& triangle, glm::vec2 weights);
[[nodiscard]] glm::vec4 tangent_at(const Tangents& tangents, glm::vec2 weights);
[[nodiscard]] glm::vec2 uv_at(const Triangle& triangle, glm::vec2 weights);
/// Linear colour and alpha of the surface.
[[nodiscard]] glm::vec4 colour_at(const Triangle& triangle, const SurfaceMaterial& material,
                                  glm::vec2 weights);

}  // namespace candela::reference
