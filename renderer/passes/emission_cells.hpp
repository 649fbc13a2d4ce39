#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/gpu_types.hpp"

namespace candela {

/// Where the starts of a light's paths lie so that equal areas send equal flux: on the unit sphere, or on its
/// half z ≥ 0.
enum class EmissionDomain : std::uint8_t { sphere, upper_half };

[[nodiscard]] EmissionDomain emission_domain(gpu::LightKind kind);
/// In sr.
[[nodiscard]] double area_of(EmissionDomain domain);

/// Takes a start in the unit square (shaders/emission.glsl) to the light's domain, areas in proportion. A
/// point light's start goes to its direction; a spot's to the direction whose z is the share of flux farther
/// from the axis; a place on a directional light's footprint to the disc, concentrically (Shirley and Chiu,
/// "A Low Distortion Map Between Disk and Square", 1997), and up onto the half sphere.
[[nodiscard]] glm::dvec3 to_emission_domain(gpu::LightKind kind, glm::dvec2 start);
/// The inverse; gives a start in [0, 1)².
[[nodiscard]] glm::dvec2 from_emission_domain(gpu::LightKind kind, glm::dvec3 point);

/// A circle with no point in it.
struct EmptyCircle {
    glm::dvec3 centre{0.0, 0.0, 1.0};
    double cosine = -1.0;  ///< of its angular radius
};

/// The spherical Voronoi diagram of unit vectors: parts of the domain that are nearest to each.
struct EmissionCells {
    std::vector<double> areas;         ///< of each point's cell, sr; they sum to that of the domain
    std::vector<EmptyCircle> corners;  ///< around the cells' corners: the largest empty circle is among them
};

/// Equal points share a cell evenly. Takes time in proportion to n·√n for points spread evenly, and n² at
/// worst.
[[nodiscard]] EmissionCells emission_cells(std::span<const glm::dvec3> points, EmissionDomain domain);

/// Centres of the largest empty circles, the largest first, each with those before it taken for points: at
/// most `count`. The first is exact; later ones are sought among the corners of the points' own cells.
[[nodiscard]] std::vector<EmptyCircle> thinnest_places(const EmissionCells& cells, std::size_t count);

}  // namespace candela
