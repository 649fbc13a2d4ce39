#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include <glm/vec2.hpp>

#include <candela/tools/picture.hpp>
#include "renderer/tools/reference/scene.hpp"

namespace candela::reference {

/// Deliberate defects, with which tests verify that the checks detect them.
enum class Defect : std::uint8_t {
    none,
    drop_cosine,  ///< surfaces receive light as if they always faced the light
    drop_pi,      ///< surfaces reflect albedo instead of albedo / π of the light from lights
    drop_bounce   ///< indirect light lacks its first bounce: light → surface → seen surface
};

struct Settings {
    glm::uvec2 size{1};          ///< pixels, neither side 0
    std::uint32_t samples = 64;  ///< paths per pixel; even, as half of them go into each half
    /// Paths per pixel that were traced before, with the same seed; even. Parts of the samples, traced one
    /// after the other, have the mean, weighted by their samples, that all of them have at once.
    std::uint32_t first_sample = 0;
    glm::dvec2 offset{0.0};  ///< of the points seen from the centres of the pixels; pixels, +x right, +y down
    /// Bounces of indirect light: 0 none, 1 light → surface → seen surface. Unlimited if not set.
    std::optional<std::uint32_t> bounces{};
    std::uint32_t seed = 0;
    unsigned threads = 0;  ///< 0: one per core; the result does not depend on it
    Defect defect = Defect::none;
    /// Whether glossy surfaces bundle the light that they reflect to others. If not, Lambertian ones of equal
    /// albedo (for light from all sides) stand for them on paths that have left a surface by its diffuse
    /// part, or by a lobe of a roughness above 0.3: there is less noise, and real-time renderers do the same.
    /// What smooth surfaces show is exact in both cases.
    bool caustics = true;
};

/// Linear radiance, without tone mapping. Where nothing is hit, `direct` shows the sky, and the others are
/// black.
struct Estimate {
    /// Exact for points and directions; that of emitting surfaces and of the sky is sampled, `samples` times
    /// a pixel.
    tools::Picture direct;
    tools::Picture indirect;               ///< the mean of both halves
    std::array<tools::Picture, 2> halves;  ///< independent estimates of the indirect light
    std::vector<std::uint8_t> hit;         ///< 1 where the pixel shows a surface
    std::vector<std::uint8_t> edge;        ///< 1 within `edge_radius` pixels of a silhouette or a shadow edge
    double seconds = 0.0;                  ///< wall time
};

/// The reach of `Estimate::edge` around an edge, in pixels along x and along y.
inline constexpr int edge_radius = 2;

/// Traces what the camera sees through the centres of its pixels, or points beside them. Direct light: every
/// light at the first surface, with a shadow ray. Indirect light: unclamped paths that continue from there,
/// and that sample the light by looking around and by looking from the lights (see lighting.hpp). Russian
/// roulette ends paths without bias. Normal and occlusion textures count at the first surface: occlusion dims
/// all of its light but that of points and directions. Throws std::invalid_argument if the number of samples
/// is odd or 0 or if the picture is empty, and SceneError if `camera` is not a camera of the scene. Once
/// `stop` is requested, it returns within the time of a pixel, and what it returns is incomplete.
///
/// Differences from the renderer: a triangle that faces away from a light is never lit, whatever the normals
/// of the mesh; images are sampled at these points, without mip maps; blended surfaces are sorted per
/// pixel.
[[nodiscard]] Estimate trace(const Scene& scene, Entity camera, const Settings& settings,
                             const std::stop_token& stop = {});

/// Direct and indirect light together.
[[nodiscard]] tools::Picture total(const Estimate& estimate);

}  // namespace candela::reference
