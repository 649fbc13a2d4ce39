#include "tests/reference/gltf_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace candela::reference {

namespace {

constexpr int steps = 128;  // in each of both dimensions

double middle(int i) {
    return (i + 0.5) / steps;
}

double square(double x) {
    return x * x;
}

/// Schlick's.
double fresnel(const GltfModel& model, double half_cosine) {
    const double dielectric = model.specular * std::min(square((model.ior - 1.0) / (model.ior + 1.0)), 1.0);
    const double f0 = glm::mix(dielectric, model.base_colour, model.metalness);
    const double f90 = glm::mix(model.specular, 1.0, model.metalness);
    return f0 + (f90 - f0) * std::pow(1.0 - half_cosine, 5.0);
}

double diffuse(const GltfModel& model, double half_cosine) {
    return (1.0 - fresnel(model, half_cosine)) * (1.0 - model.metalness) * model.base_colour /
           std::numbers::pi;
}

double alpha_of(const GltfModel& model) {
    return square(model.roughness);
}

double distribution(double alpha, double cosine) {
    return square(alpha) / (std::numbers::pi * square(square(cosine) * (square(alpha) - 1.0) + 1.0));
}

double visibility(double alpha, double light, double viewer) {
    const auto term = [&](double cosine) {
        return std::sqrt(square(alpha) + (1.0 - square(alpha)) * square(cosine));
    };
    return 0.5 / (light * term(viewer) + viewer * term(light));
}

glm::dvec3 direction(double cosine, double angle) {
    const double sine = std::sqrt(1.0 - square(cosine));
    return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

}  // namespace

double GltfModel::reflected(glm::dvec3 viewer, glm::dvec3 light) const {
    if (light.z <= 0.0) return 0.0;
    const glm::dvec3 half = glm::normalize(viewer + light);
    const double half_cosine = glm::dot(half, viewer);
    const double alpha = alpha_of(*this);
    const double mirrored =
        fresnel(*this, half_cosine) * distribution(alpha, half.z) * visibility(alpha, light.z, viewer.z);
    return (diffuse(*this, half_cosine) + mirrored) * light.z;
}

glm::dvec3 viewer_at(double cosine) {
    return direction(cosine, 0.3);
}

double over_microfacets(double alpha, const std::function<double(glm::dvec3)>& function) {
    // D · cosine has the distribution function α² … of the squared tangent t: t / (t + α²).
    double sum = 0.0;
    for (int i = 0; i < steps * steps; ++i) {
        const double share = middle(i % steps);
        const double squared_tangent = square(alpha) * share / (1.0 - share);
        sum += function(
            direction(1.0 / std::sqrt(1.0 + squared_tangent), 2.0 * std::numbers::pi * middle(i / steps)));
    }
    return sum / square(steps);
}

double reflected_light(const GltfModel& model, glm::dvec3 viewer,
                       const std::function<double(glm::dvec3)>& radiance) {
    const double alpha = alpha_of(model);
    // The solid angle of light is 4 (viewer · half) times that of the microfacets that mirror it.
    const double mirrored = over_microfacets(alpha, [&](glm::dvec3 half) {
        const double half_cosine = glm::dot(half, viewer);
        const glm::dvec3 light = 2.0 * half_cosine * half - viewer;
        if (half_cosine <= 0.0 || light.z <= 0.0) return 0.0;
        return fresnel(model, half_cosine) * visibility(alpha, light.z, viewer.z) * light.z * 4.0 *
               half_cosine / half.z * radiance(light);
    });
    // The square of the cosine of cosine-distributed light is even.
    double below = 0.0;
    for (int i = 0; i < steps * steps; ++i) {
        const glm::dvec3 light =
            direction(std::sqrt(middle(i % steps)), 2.0 * std::numbers::pi * middle(i / steps));
        below += std::numbers::pi * diffuse(model, glm::dot(glm::normalize(light + viewer), viewer)) *
                 radiance(light);
    }
    return mirrored + below / square(steps);
}

double directional_albedo(const GltfModel& model, double viewer_cosine) {
    return reflected_light(model, viewer_at(viewer_cosine), [](glm::dvec3) { return 1.0; });
}

double mean_albedo(const GltfModel& model) {
    constexpr int viewers = 48;
    double sum = 0.0;
    for (int i = 0; i < viewers; ++i) sum += directional_albedo(model, std::sqrt((i + 0.5) / viewers));
    return sum / viewers;
}

}  // namespace candela::reference
