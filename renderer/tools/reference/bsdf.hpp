#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace candela::reference {

/// What glTF's metallic-roughness model says about a point of a surface: glTF 2.0, appendix B.3, with
/// KHR_materials_specular and KHR_materials_ior.
struct Gloss {
    glm::vec3 diffuse;  ///< albedo of the part below the interface
    glm::vec3 f0;       ///< reflectance of the interface for light that arrives along a microfacet's normal
    float f90;          ///< the same for light that grazes it
    float alpha;        ///< of the GGX distribution of microfacets: the roughness squared, in [0, 1]
};

/// The BSDF of a glossy surface, seen from one direction: microfacets with the GGX distribution,
/// height-correlated Smith shadowing and Schlick's Fresnel factor F, and below them a diffuse surface, which
/// reflects 1 - max F of what a Lambertian one does. The cosine between the normal and the viewer counts as
/// at least 1e-3. A mirror has an alpha of 1e-4: its lobe is as wide as a millimetre is at 10 metres.
class Bsdf {
 public:
    /// `normal` and `view`, which points to the viewer, are unit vectors.
    Bsdf(const Gloss& gloss, glm::vec3 normal, glm::vec3 view);

    /// The BSDF times the cosine, for light from the unit vector `towards`; alpha counts as at least
    /// `least_alpha`.
    [[nodiscard]] glm::vec3 value(glm::vec3 towards, float least_alpha = 0.0F) const;

    /// A unit vector that is either the mirror direction at one of the microfacets that the viewer sees
    /// (Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018) or cosine-distributed. It may
    /// point below the surface. `which` and both components of `u` are in [0, 1).
    [[nodiscard]] glm::vec3 draw(float which, glm::vec2 u) const;
    /// The density per solid angle (1/sr) with which a direction is drawn, in whichever of both ways.
    [[nodiscard]] float density(glm::vec3 towards) const;

    /// The probability with which a drawn direction is that of a microfacet.
    [[nodiscard]] float mirror_share() const { return mirror_share_; }
    /// The BSDF is the sum of both parts.
    [[nodiscard]] Bsdf mirror_part() const;
    [[nodiscard]] Bsdf diffuse_part() const;
    [[nodiscard]] Bsdf seen_from(glm::vec3 view) const;
    [[nodiscard]] const Gloss& gloss() const { return gloss_; }

 private:
    [[nodiscard]] glm::vec3 fresnel(float cosine) const;
    [[nodiscard]] glm::vec3 visible_microfacet(glm::vec2 u) const;

    Gloss gloss_;
    glm::vec3 normal_;
    glm::vec3 view_;
    glm::vec3 raised_view_;  ///< the view, raised so that its cosine is the least one
    float view_cosine_;
    float mirror_share_;
    bool mirrors_ = true;  ///< whether it has the part of the microfacets
};

}  // namespace candela::reference
