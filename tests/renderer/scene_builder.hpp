#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/renderer.hpp>
#include <candela/scene/components.hpp>
#include "engine/bvh/bvh.hpp"
#include "renderer/gl/texture.hpp"
#include "tests/renderer/context_fixture.hpp"

namespace candela {

// Worlds for the tests of the renderer. Lengths are in metres.

/// A diffuse material without an image.
[[nodiscard]] std::shared_ptr<const Material> diffuse(glm::vec3 albedo, bool double_sided = false);

/// A material that emits this radiance, on its front.
[[nodiscard]] std::shared_ptr<const Material> emitter(glm::vec3 radiance, float albedo = 0.0F);

/// A square in the plane y = 0 that faces +Y, from -half to half. Its texture covers it once, u along x, v
/// along z.
[[nodiscard]] std::shared_ptr<const Mesh> square(float half, std::shared_ptr<const Material> material);
/// A cube around the origin whose faces look inwards.
[[nodiscard]] std::shared_ptr<const Mesh> box_inwards(float half, std::shared_ptr<const Material> material);
/// The same, facing outwards.
[[nodiscard]] std::shared_ptr<const Mesh> box_outwards(float half, std::shared_ptr<const Material> material);
/// An icosahedron with 20·4ⁿ triangles whose corners are on the sphere; faces and (radial) normals point
/// inwards.
[[nodiscard]] std::shared_ptr<const Mesh> sphere_inwards(float radius, int subdivisions,
                                                         std::shared_ptr<const Material> material);
/// `count` double-sided triangles of about this extent, scattered in a cube from -1 to 1.
[[nodiscard]] std::shared_ptr<const Mesh> soup(std::size_t count, std::uint32_t seed, float extent = 0.05F);

/// The transform at `from` whose -Z points to `at`.
[[nodiscard]] Transform looking(glm::vec3 from, glm::vec3 at, glm::vec3 up = {0.0F, 1.0F, 0.0F});

/// An entity with these components.
template <class... Components>
Entity add(World& world, Components... components) {
    const Entity entity = world.create();
    (world.set(entity, std::move(components)), ...);
    return entity;
}
[[nodiscard]] Transform at(glm::vec3 position);
/// The same, upside down: +Y becomes -Y.
[[nodiscard]] Transform upside_down_at(glm::vec3 position);

/// A world, its camera, and a light for the test to modify.
struct Scene {
    World world;
    Entity camera;
    Entity light;
};

/// The shipped Cornell box: sandbox/scenes/cornell.gltf.
[[nodiscard]] Scene cornell_box();
/// A closed box of uniform albedo, from -1 to 1, with a point light of 1 cd off its centre.
[[nodiscard]] Scene furnace_box(float albedo);
/// A ground of 8 m × 8 m at y = 0 with albedo 0.5 that fills the view, at a slant from above. `light` is an
/// entity that has no light component yet.
[[nodiscard]] Scene ground();

/// All triangles of a world, in world space.
[[nodiscard]] std::vector<Triangle> world_triangles(const World& world);

/// Linear radiance. Pixel (x, y) is `pixels[y * size.x + x]`; row 0 is at the bottom.
struct Picture {
    glm::uvec2 size{0};
    std::vector<glm::vec3> pixels;
    [[nodiscard]] glm::vec3 at(std::uint32_t x, std::uint32_t y) const { return pixels[y * size.x + x]; }
    bool operator==(const Picture&) const = default;
};
/// Whether all pixels are finite and none is negative.
[[nodiscard]] bool is_sane(const Picture& picture);
/// Mean of all pixels and channels.
[[nodiscard]] double mean(const Picture& picture);
/// The largest |a - b| / max(|b|, floor) over all pixels and channels; infinite if one is not a number.
[[nodiscard]] double worst_error(const Picture& a, const Picture& b, double floor);

/// Mean squared error relative to the reference's mean square.
[[nodiscard]] double relative_mean_square(const Picture& picture, const Picture& reference);

/// The line through the centre of a pixel, or so many pixels beside it, computed from the definition of the
/// camera, not from its matrices.
struct PixelRay {
    glm::dvec3 origin;
    glm::dvec3 direction;  ///< not unit length
};
[[nodiscard]] PixelRay pixel_ray(const Camera& camera, const Transform& pose, glm::uvec2 size,
                                 std::uint32_t x, std::uint32_t y, glm::dvec2 beside = glm::dvec2(0.0));

/// Drivers may round corners to 1/256 of a pixel before they draw: a pixel may show what is so far beside its
/// centre, in pixels.
inline constexpr std::array<glm::dvec2, 4> corner_rounding{{{-1.0 / 256.0, -1.0 / 256.0},
                                                            {-1.0 / 256.0, 1.0 / 256.0},
                                                            {1.0 / 256.0, -1.0 / 256.0},
                                                            {1.0 / 256.0, 1.0 / 256.0}}};

/// A picture of a plane: `radiance` of the point under each pixel of the scene's camera, or so many pixels
/// beside its centre; 0 where the plane is not seen.
[[nodiscard]] Picture expected_picture(const Scene& scene, glm::uvec2 size, glm::dvec3 point,
                                       glm::dvec3 normal,
                                       const std::function<glm::dvec3(glm::dvec3)>& radiance,
                                       glm::dvec2 beside = glm::dvec2(0.0));

inline constexpr std::uint64_t software_loops = 65'535;  ///< gl::Limits::loop_iterations of software drivers
inline constexpr std::uint64_t endless_loops = gl::Limits{}.loop_iterations;

/// What is declared from now on is that of a driver on the CPU, or of a GPU's. With the loops of software
/// drivers, such a driver shows right pictures in both cases.
void pretend(Renderer& renderer, bool software, std::uint64_t loop_iterations = software_loops);

/// A framebuffer of the host that can be read back.
class RenderTarget {
 public:
    RenderTarget(gl::Device& device, glm::uvec2 size, Format format = Format::rgba32f);
    [[nodiscard]] Target target() const { return {framebuffer_.name(), texture_.desc().size}; }
    [[nodiscard]] Picture read() const;

 private:
    gl::Texture texture_;
    gl::Framebuffer framebuffer_;
};

/// A configuration that writes linear radiance, with few VPLs, small maps, and without VPL visibility: tests
/// that need more say so, and all others are faster without it.
[[nodiscard]] Configuration linear_configuration(ShadingPath path = ShadingPath::deferred);

/// A renderer in its own context.
class RenderFixture : public GlFixture {
 protected:
    /// Configures, which must succeed.
    void configure(const Configuration& configuration);
    [[nodiscard]] Picture render(const World& world, Entity camera, glm::uvec2 size);
    [[nodiscard]] Picture render(const Scene& scene, glm::uvec2 size) {
        return render(scene.world, scene.camera, size);
    }
    /// Renders the scene until nothing waits any more.
    [[nodiscard]] Picture settled_picture(const Scene& scene, glm::uvec2 size);
    /// The picture of the scene by a new renderer with the same configuration, but with everything traced at
    /// once: without VplSettings::updates.
    [[nodiscard]] Picture fresh_picture(const Scene& scene, glm::uvec2 size);
    /// The same by a renderer that is kept and invalidated, so that it need not compile its shaders again.
    [[nodiscard]] Picture from_scratch(const Scene& scene, glm::uvec2 size);
    /// Depth, normal and albedo that the last frame has kept, as surfaces of a host in Candela's own
    /// conventions.
    [[nodiscard]] HostSurfaces own_surfaces() const;
    /// Whether the pass ran in the last frame; the graph must have it.
    [[nodiscard]] bool ran(std::string_view pass) const;

    TestedRenderer renderer{context->get_proc()};

 private:
    std::unique_ptr<Renderer> other_;  // of from_scratch, which has nothing to verify
};

}  // namespace candela
