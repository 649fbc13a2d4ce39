#pragma once

#include "renderer/tools/reference/path_tracer.hpp"

namespace candela::reference {

// Checks of the path tracer against closed forms. Each returns whether the tracer, with this defect, agrees
// within its own noise (four standard errors, which random errors exceed once in 16,000 times) or within
// floating-point error.

/// A plane of albedo 1/2 under a light: radiance ρ/π · E at every pixel.
[[nodiscard]] bool plane_under_point_light(Defect defect = Defect::none);
[[nodiscard]] bool plane_under_ranged_light(Defect defect = Defect::none);
[[nodiscard]] bool plane_under_spot_light(Defect defect = Defect::none);
[[nodiscard]] bool plane_under_directional_light(Defect defect = Defect::none);

/// A plane of albedo 1/2 under a rectangle that emits light: Lambert's formula, in the mean of the picture.
[[nodiscard]] bool plane_under_rectangle();
/// The same where the left half of the rectangle is the hole of a mask.
[[nodiscard]] bool plane_under_half_a_rectangle();

/// The middle of a plane of albedo 1/2 under a uniform sky: ρ L. Beside an endless wall of height h, at a
/// distance d: the wall hides (1 - d / √(d² + h²)) / 2 of it. Under a sky with one bright texel: its tent of
/// radiance, integrated.
[[nodiscard]] bool plane_under_uniform_sky();
[[nodiscard]] bool plane_beside_wall();
[[nodiscard]] bool plane_under_bright_texel();

/// A closed sphere of this albedo that emits light everywhere: radiance L / (1 - ρ), everywhere, of which L
/// is emitted, ρ L direct and the rest indirect.
[[nodiscard]] bool glowing_sphere(double albedo);

/// A sphere lit from its centre: after B bounces the indirect light is direct · (ρ + ... + ρᴮ), and with
/// unlimited bounces the total is direct / (1 - ρ), everywhere.
[[nodiscard]] bool sphere_furnace(double albedo, Defect defect = Defect::none);

/// A closed box of uniform albedo: the flux that arrives at all walls is the light's flux / (1 - ρ).
[[nodiscard]] bool box_furnace(double albedo, Defect defect = Defect::none);

/// Two coaxial parallel discs, one of them lit uniformly: the radiance of the other one follows the form
/// factor, at every point and in the mean.
[[nodiscard]] bool parallel_discs(Defect defect = Defect::none);

/// Whether the noise that the halves predict for the discs is the actual noise.
[[nodiscard]] bool noise_of_discs();

}  // namespace candela::reference
