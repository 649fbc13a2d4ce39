#pragma once

#include "tests/reference/path_tracer.hpp"

namespace candela::reference {

// Checks of the path tracer against closed forms. Each tells whether the tracer, with this defect, agrees
// within its own noise: four standard errors, which chance exceeds once in 16,000 times, or what floats
// leave.

/// A plane of albedo 1/2 under a light: ρ/π · E at every pixel.
[[nodiscard]] bool plane_under_point_light(Defect defect = Defect::none);
[[nodiscard]] bool plane_under_ranged_light(Defect defect = Defect::none);
[[nodiscard]] bool plane_under_spot_light(Defect defect = Defect::none);
[[nodiscard]] bool plane_under_directional_light(Defect defect = Defect::none);

/// A sphere lit from its centre: after B bounces the indirect light is direct · (ρ + ... + ρᴮ), and with all
/// of them the total is direct / (1 - ρ), everywhere.
[[nodiscard]] bool sphere_furnace(double albedo, Defect defect = Defect::none);

/// A closed box of one albedo: what arrives at all its walls is the light's flux / (1 - ρ).
[[nodiscard]] bool box_furnace(double albedo, Defect defect = Defect::none);

/// Two coaxial parallel discs, one of which is lit evenly: the other shows the form factor, point by point
/// and in the mean.
[[nodiscard]] bool parallel_discs(Defect defect = Defect::none);

/// What the halves say of the discs' noise is what it is.
[[nodiscard]] bool noise_of_discs();

}  // namespace candela::reference
