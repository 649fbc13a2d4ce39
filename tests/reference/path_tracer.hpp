#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "sandbox/picture.hpp"
#include "tests/reference/scene.hpp"

namespace candela::reference {

/// What tests break on purpose, to see that the checks notice.
enum class Defect : std::uint8_t {
    none,
    drop_cosine,  ///< surfaces receive light as if they always faced the light
    drop_pi,      ///< surfaces reflect albedo in place of albedo / π of what they receive from lights
    drop_bounce   ///< indirect light lacks its first bounce: light → surface → seen surface
};

struct Settings {
    glm::uvec2 size{1};          ///< pixels, neither side 0
    std::uint32_t samples = 64;  ///< paths a pixel, even: half of them go into each half
    /// Of indirect light: 0 none, 1 light → surface → seen surface. Without a value any number.
    std::optional<std::uint32_t> bounces{};
    std::uint32_t seed = 0;
    unsigned threads = 0;  ///< 0: as many as the machine has cores; the result does not depend on it
    Defect defect = Defect::none;
};

/// Linear radiance, no tone mapping; where nothing is hit all pictures are black.
struct Estimate {
    sandbox::Picture direct;                 ///< exact: every light of a scene is a point or a direction
    sandbox::Picture indirect;               ///< the mean of both halves
    std::array<sandbox::Picture, 2> halves;  ///< independent estimates of the indirect light
    std::vector<std::uint8_t> hit;           ///< 1 where the pixel's centre shows a surface
    std::vector<std::uint8_t> edge;  ///< 1 within `edge_radius` pixels of a silhouette or a shadow's edge
    double seconds = 0.0;            ///< of wall time
};

/// Pixels, along x and along y, that `Estimate::edge` reaches from an edge.
inline constexpr int edge_radius = 2;

/// Traces what the camera sees through the centres of its pixels. Direct light: every light at the first
/// surface, with a shadow ray. Indirect light: paths that go on from there, unclamped, and find the light by
/// looking around and by looking from the lights (see lighting.hpp); ended by roulette, which leaves the mean
/// as it is. Throws std::invalid_argument for odd or no samples and for an empty picture, SceneError if
/// `camera` is no camera of the scene.
///
/// Where it differs from the renderer: the mesh's normals never lighten what its triangles face away from;
/// images are sampled at the pixel's centre, without mip maps; blended surfaces are ordered pixel by pixel.
[[nodiscard]] Estimate trace(const Scene& scene, Entity camera, const Settings& settings);

/// Direct and indirect light together.
[[nodiscard]] sandbox::Picture total(const Estimate& estimate);

}  // namespace candela::reference
