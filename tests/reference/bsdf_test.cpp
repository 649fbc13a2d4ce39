#include "renderer/tools/reference/bsdf.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "renderer/tools/reference/hemispherical_albedo.hpp"
#include "renderer/tools/reference/sampling.hpp"
#include "tests/reference/gltf_model.hpp"

TEST_SUITE("reference: BSDF") {

using namespace candela;
using reference::Bsdf;
using reference::Gloss;
using reference::GltfModel;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::vec3 up(0, 0, 1);

/// With an index of refraction of 1.5, and no KHR_materials_specular.
Gloss gloss_of(const GltfModel& model) {
    const auto metal = static_cast<float>(model.metalness);
    const auto base = static_cast<float>(model.base_colour);
    const auto roughness = static_cast<float>(model.roughness);
    return {glm::vec3((1.0F - metal) * base), glm::vec3(0.04F + metal * (base - 0.04F)), 1.0F,
            roughness * roughness};
}

glm::vec3 direction(double cosine, double angle) {
    const double sine = std::sqrt(1.0 - cosine * cosine);
    return glm::vec3(glm::dvec3(sine * std::cos(angle), sine * std::sin(angle), cosine));
}

/// Above the surface, no flatter than 2°: there, floats have too few digits to compare.
glm::vec3 random_direction(reference::Sampler& sampler) {
    const double cosine = 0.035 + 0.965 * static_cast<double>(sampler.next());
    return direction(cosine, 2.0 * pi * static_cast<double>(sampler.next()));
}

/// Metal, plastic, and something between.
std::vector<GltfModel> models(double roughness) {
    return {{.base_colour = 0.7, .metalness = 1.0, .roughness = roughness},
            {.base_colour = 0.7, .metalness = 0.0, .roughness = roughness},
            {.base_colour = 0.7, .metalness = 0.4, .roughness = roughness}};
}

/// Directions in bands of equal height, from below to above, and sectors.
struct Bins {
    static constexpr int bands = 24;
    static constexpr int sectors = 16;

    static std::size_t bin_of(glm::vec3 towards) {
        const double band = (static_cast<double>(towards.z) + 1.0) / 2.0 * bands;
        const auto angle = static_cast<double>(std::atan2(towards.y, towards.x));
        const double sector = (angle / (2.0 * pi) + 0.5) * sectors;
        return static_cast<std::size_t>(std::min(static_cast<int>(band), bands - 1) * sectors +
                                        std::min(static_cast<int>(sector), sectors - 1));
    }

    /// The integral of the density over each bin.
    static std::vector<double> expected(const Bsdf& bsdf) {
        constexpr int steps = 48;  // in each dimension of a bin
        std::vector<double> sums(std::size_t{bands} * sectors, 0.0);
        for (int i = 0; i < bands * steps; ++i) {
            for (int j = 0; j < sectors * steps; ++j) {
                const double cosine = 2.0 * (i + 0.5) / (bands * steps) - 1.0;
                const double angle = 2.0 * pi * ((j + 0.5) / (sectors * steps) - 0.5);
                const glm::vec3 towards = direction(cosine, angle);
                sums[bin_of(towards)] += static_cast<double>(bsdf.density(towards));
            }
        }
        for (double& sum : sums) sum *= 4.0 * pi / (double(bands) * sectors * steps * steps);
        return sums;
    }
};

}  // namespace

TEST_CASE("it is the one of glTF's specification") {
    reference::Sampler sampler(7);
    // At a roughness of 0.1, rounding shifts the angle of a microfacet by 1e-5 of the lobe's width, and
    // the slope of GGX doubles that.
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
        for (const GltfModel& model : models(roughness)) {
            for (int i = 0; i < 1000; ++i) {
                const glm::vec3 view = random_direction(sampler), light = random_direction(sampler);
                const double truth = model.reflected(glm::dvec3(view), glm::dvec3(light));
                CHECK(static_cast<double>(Bsdf(gloss_of(model), up, view).value(light).g) ==
                      doctest::Approx(truth).epsilon(1e-4));
            }
        }
    }
}

TEST_CASE("it is reciprocal") {
    reference::Sampler sampler(8);
    for (const double roughness : {0.02, 0.1, 0.5, 1.0}) {
        for (const GltfModel& model : models(roughness)) {
            for (int i = 0; i < 1000; ++i) {
                const glm::vec3 a = random_direction(sampler), b = random_direction(sampler);
                const float from_b = Bsdf(gloss_of(model), up, a).value(b).g / b.z;
                const float from_a = Bsdf(gloss_of(model), up, b).value(a).g / a.z;
                CHECK(from_a == doctest::Approx(from_b).epsilon(1e-4));
            }
        }
    }
}

TEST_CASE("directions are drawn with the stated density, which integrates to 1") {
    constexpr std::uint32_t draws = 1U << 18U;
    reference::Sampler sampler(9);
    for (const double roughness : {0.4, 0.7, 1.0}) {
        for (const double cosine : {0.15, 0.6, 1.0}) {
            for (const GltfModel& model : models(roughness)) {
                CAPTURE(roughness);
                CAPTURE(cosine);
                CAPTURE(model.metalness);
                const Bsdf bsdf(gloss_of(model), up, direction(cosine, 0.4));
                const std::vector<double> expected = Bins::expected(bsdf);
                double sum = 0.0;
                for (const double share : expected) sum += share;
                CHECK(sum == doctest::Approx(1.0).epsilon(1e-3));

                std::vector<double> drawn(expected.size(), 0.0);
                for (std::uint32_t i = 0; i < draws; ++i) {
                    const float which = sampler.next();
                    const float u = sampler.next();
                    drawn[Bins::bin_of(bsdf.draw(which, {u, sampler.next()}))] += 1.0;
                }
                // Pearson's statistic: its mean is the number of bins, its variance twice that.
                double statistic = 0.0;
                double bins = 0.0;
                for (std::size_t i = 0; i < expected.size(); ++i) {
                    const double mean = expected[i] * draws;
                    if (mean < 10.0) continue;
                    statistic += (drawn[i] - mean) * (drawn[i] - mean) / mean;
                    bins += 1.0;
                }
                CHECK(statistic < bins + 5.0 * std::sqrt(2.0 * bins));
            }
        }
    }
}

TEST_CASE("the density of smooth lobes integrates to 1, too") {
    for (const float alpha : {1e-4F, 1e-2F}) {
        for (const double cosine : {0.2, 0.9}) {
            CAPTURE(alpha);
            CAPTURE(cosine);
            const glm::dvec3 view = reference::viewer_at(cosine);
            const Bsdf bsdf({glm::vec3(0.0F), glm::vec3(1.0F), 1.0F, alpha}, up, glm::vec3(view));
            const auto wide = static_cast<double>(alpha);
            const double sum = reference::over_microfacets(wide, [&](glm::dvec3 half) {
                const double half_cosine = glm::dot(half, view);
                if (half_cosine <= 0.0) return 0.0;
                const glm::dvec3 towards = 2.0 * half_cosine * half - view;
                const double squared = half.z * half.z * (wide * wide - 1.0) + 1.0;
                const double weight = wide * wide / (pi * squared * squared) * half.z;  // D · cosine
                return static_cast<double>(bsdf.density(glm::vec3(towards))) * 4.0 * half_cosine / weight;
            });
            // Rounding moves a direction by up to 1e-7, of a lobe of 1e-4 rad.
            CHECK(sum == doctest::Approx(1.0).epsilon(5e-3));
        }
    }
}

TEST_CASE("both parts add up") {
    reference::Sampler sampler(10);
    const Gloss gloss{{0.5F, 0.4F, 0.3F}, glm::vec3(0.1F), 1.0F, 0.2F};
    for (int i = 0; i < 100; ++i) {
        const Bsdf bsdf(gloss, up, random_direction(sampler));
        const glm::vec3 light = random_direction(sampler);
        const glm::vec3 sum = bsdf.mirror_part().value(light) + bsdf.diffuse_part().value(light);
        CHECK(glm::length(sum - bsdf.value(light)) < 1e-6F * glm::length(sum));
        const float share = bsdf.mirror_share();
        CHECK(share * bsdf.mirror_part().density(light) +
                  (1.0F - share) * bsdf.diffuse_part().density(light) ==
              doctest::Approx(bsdf.density(light)));
    }
}

TEST_CASE("no metal reflects more than arrives, nor does any coloured surface on average") {
    // The diffuse part of glTF's model takes no account of how much the microfacets reflect to the
    // viewer: a dielectric may reflect more at a glancing view, and a perfectly white one 4 % more on
    // average.
    for (const double roughness : {0.05, 0.2, 0.4, 0.7, 1.0}) {
        for (const double cosine : {0.02, 0.1, 0.5, 1.0}) {
            const GltfModel metal{.base_colour = 1.0, .metalness = 1.0, .roughness = roughness};
            CHECK(reference::directional_albedo(metal, cosine) < 1.0 + 1e-3);
            const Bsdf bsdf(gloss_of(metal), up, direction(cosine, 0.0));
            double sum = 0.0;
            for (int i = 0; i < 64 * 64; ++i) {
                const glm::vec2 u((glm::vec2(i % 64, i / 64) + 0.5F) / 64.0F);
                const glm::vec3 towards = bsdf.draw(0.0F, u);
                const float density = bsdf.density(towards);
                if (density > 0.0F) sum += static_cast<double>(bsdf.value(towards).g / density);
            }
            CHECK(sum / (64.0 * 64.0) < 1.0 + 1e-3);
        }
        for (const double metalness : {0.0, 0.3, 1.0}) {
            const Gloss gloss =
                gloss_of({.base_colour = 0.95, .metalness = metalness, .roughness = roughness});
            CHECK(reference::hemispherical_albedo(gloss).g < 1.0F);
        }
    }
}

TEST_CASE("the albedo of a Lambertian stand-in is the integral of the BSDF") {
    for (const double roughness : {0.05, 0.17, 0.33, 0.5, 0.77, 1.0}) {
        for (const GltfModel& model : models(roughness)) {
            CAPTURE(roughness);
            CAPTURE(model.metalness);
            const double truth = reference::mean_albedo(model);
            // The stated error, and that of the sum.
            CHECK(std::abs(static_cast<double>(reference::hemispherical_albedo(gloss_of(model)).g) - truth) <
                  0.003);
        }
    }
}

}  // TEST_SUITE("reference: BSDF")
