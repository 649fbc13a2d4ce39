#include "renderer/tools/reference/bsdf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderer/tools/reference/constants.hpp"
#include "renderer/tools/reference/sampling.hpp"

namespace candela::reference {

namespace {

constexpr float mirror_alpha = 1e-4F;
constexpr float least_view_cosine = 1e-3F;
// Each part is drawn at least this often if there are both: which one reflects more depends on the direction.
constexpr float least_share = 0.1F;

float largest(glm::vec3 v) {
    return std::max({v.r, v.g, v.b});
}

/// GGX. The square of the sine comes from the cross product: 1 - cosine² has too few digits for mirrors.
float distribution(float alpha, glm::vec3 normal, glm::vec3 microfacet) {
    const glm::vec3 across = glm::cross(normal, microfacet);
    const float cosine = glm::dot(normal, microfacet);
    if (cosine <= 0.0F) return 0.0F;
    const float squared = alpha * alpha;
    const float stretched = glm::dot(across, across) / squared + cosine * cosine;
    return 1.0F / (pi * squared * stretched * stretched);
}

/// cosine · √(1 + α² tan²): Smith's Λ is (this / cosine - 1) / 2.
float smith(float alpha, float cosine) {
    return std::sqrt(alpha * alpha + (1.0F - alpha * alpha) * cosine * cosine);
}

/// Smith's factor for both directions, correlated by height, divided by 4 times both cosines.
float visibility(float alpha, float a, float b) {
    return 0.5F / (a * smith(alpha, b) + b * smith(alpha, a));
}

glm::vec3 raised(glm::vec3 view, glm::vec3 normal) {
    const float cosine = glm::dot(view, normal);
    if (cosine >= least_view_cosine) return view;
    const glm::vec3 level = glm::normalize(view - cosine * normal);
    return std::sqrt(1.0F - least_view_cosine * least_view_cosine) * level + least_view_cosine * normal;
}

}  // namespace

Bsdf::Bsdf(const Gloss& gloss, glm::vec3 normal, glm::vec3 view)
    : gloss_(gloss),
      normal_(normal),
      view_(view),
      raised_view_(raised(view, normal)),
      view_cosine_(std::max(glm::dot(normal, view), least_view_cosine)),
      mirror_share_(1.0F) {
    gloss_.alpha = std::max(gloss.alpha, mirror_alpha);
    if (gloss.diffuse == glm::vec3(0.0F)) return;
    const float interface = largest(fresnel(view_cosine_));
    const float below = (1.0F - interface) * largest(gloss.diffuse);
    mirror_share_ = std::clamp(interface / (interface + below), least_share, 1.0F - least_share);
}

Bsdf Bsdf::mirror_part() const {
    Bsdf part = *this;
    part.gloss_.diffuse = glm::vec3(0.0F);
    part.mirror_share_ = 1.0F;
    return part;
}

Bsdf Bsdf::diffuse_part() const {
    Bsdf part = *this;
    part.mirrors_ = false;
    part.mirror_share_ = 0.0F;
    return part;
}

Bsdf Bsdf::seen_from(glm::vec3 view) const {
    return {gloss_, normal_, view};
}

glm::vec3 Bsdf::fresnel(float cosine) const {
    const float rest = 1.0F - std::clamp(cosine, 0.0F, 1.0F);
    const float squared = rest * rest;
    return gloss_.f0 + (gloss_.f90 - gloss_.f0) * (squared * squared * rest);
}

glm::vec3 Bsdf::value(glm::vec3 towards, float least_alpha) const {
    const float cosine = glm::dot(normal_, towards);
    if (cosine <= 0.0F) return glm::vec3(0.0F);
    const glm::vec3 microfacet = glm::normalize(view_ + towards);
    const glm::vec3 reflectance = fresnel(glm::dot(view_, microfacet));
    glm::vec3 sum = gloss_.diffuse * ((1.0F - largest(reflectance)) / pi);
    if (mirrors_) {
        const float alpha = std::max(gloss_.alpha, least_alpha);
        sum += reflectance *
               (distribution(alpha, normal_, microfacet) * visibility(alpha, cosine, view_cosine_));
    }
    return sum * cosine;
}

glm::vec3 Bsdf::draw(float which, glm::vec2 u) const {
    if (which >= mirror_share_) return cosine_direction(normal_, u);
    const glm::vec3 microfacet = visible_microfacet(u);
    return glm::normalize(2.0F * glm::dot(raised_view_, microfacet) * microfacet - raised_view_);
}

float Bsdf::density(glm::vec3 towards) const {
    const float cosine = std::max(glm::dot(normal_, towards), 0.0F);
    const float diffuse = (1.0F - mirror_share_) * cosine / pi;
    if (mirror_share_ == 0.0F) return diffuse;
    // Of visible normals: D · G1 · (view · microfacet) / (normal · view), and of reflected directions that by
    // 4 (view · microfacet), where G1 = 2 (normal · view) / (normal · view + smith).
    const glm::vec3 microfacet = glm::normalize(raised_view_ + towards);
    const float mirrored = distribution(gloss_.alpha, normal_, microfacet) /
                           (2.0F * (view_cosine_ + smith(gloss_.alpha, view_cosine_)));
    return diffuse + mirror_share_ * mirrored;
}

/// Section 3 of Heitz's paper: the microfacets are stretched to a hemisphere, whose projection along the view
/// is two half ellipses.
glm::vec3 Bsdf::visible_microfacet(glm::vec2 u) const {
    const glm::vec3 tangent = across(normal_, 1.0F, 0.0F);
    const glm::vec3 bitangent = glm::cross(normal_, tangent);
    const float alpha = gloss_.alpha;
    const glm::vec3 view = glm::normalize(glm::vec3(alpha * glm::dot(raised_view_, tangent),
                                                    alpha * glm::dot(raised_view_, bitangent), view_cosine_));
    const float length = std::hypot(view.x, view.y);
    const glm::vec3 level =
        length > 0.0F ? glm::vec3(-view.y, view.x, 0.0F) / length : glm::vec3(1.0F, 0.0F, 0.0F);
    const glm::vec3 upwards = glm::cross(view, level);

    const float radius = std::sqrt(u.x);
    const float angle = 2.0F * pi * u.y;
    const float x = radius * std::cos(angle);
    const float share = 0.5F * (1.0F + view.z);
    const float y = (1.0F - share) * std::sqrt(1.0F - x * x) + share * radius * std::sin(angle);
    const float z = std::sqrt(std::max(1.0F - x * x - y * y, 0.0F));
    const glm::vec3 stretched = x * level + y * upwards + z * view;
    return glm::normalize(alpha * stretched.x * tangent + alpha * stretched.y * bitangent +
                          std::max(stretched.z, 0.0F) * normal_);
}

}  // namespace candela::reference
