#pragma once

#include <functional>

#include <glm/vec3.hpp>

namespace candela::reference {

// glTF's metallic-roughness model (glTF 2.0, appendix B.3) in double precision, in the words of the
// specification, for one channel, and integrals of it by the midpoint rule. Directions are unit vectors, and
// the normal is +Z.

struct GltfModel {
    double base_colour = 1.0;
    double metalness = 0.0;
    double roughness = 1.0;
    double specular = 1.0;  ///< of KHR_materials_specular
    double ior = 1.5;       ///< of KHR_materials_ior

    /// The BSDF times the cosine of the light's direction.
    [[nodiscard]] double reflected(glm::dvec3 viewer, glm::dvec3 light) const;
};

/// The viewer at this cosine from the normal.
[[nodiscard]] glm::dvec3 viewer_at(double cosine);

/// The integral over light's directions of what the model reflects to the viewer, without occlusion.
/// `radiance` of a direction.
[[nodiscard]] double reflected_light(const GltfModel& model, glm::dvec3 viewer,
                                     const std::function<double(glm::dvec3)>& radiance);

/// The same of radiance 1 from all sides.
[[nodiscard]] double directional_albedo(const GltfModel& model, double viewer_cosine);

/// The mean over cosine-distributed viewers: of the light that arrives equally from all sides, the share that
/// is reflected.
[[nodiscard]] double mean_albedo(const GltfModel& model);

/// The integral of a function of the microfacet's direction times GGX's D · cosine, whose own integral is 1.
[[nodiscard]] double over_microfacets(double alpha, const std::function<double(glm::dvec3)>& function);

}  // namespace candela::reference
