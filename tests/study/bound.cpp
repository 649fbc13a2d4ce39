#include <fmt/format.h>
#include <algorithm>
#include <limits>

#include "engine/scene/gltf.hpp"
#include "renderer/context/headless.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

constexpr glm::uvec2 size(128, 128);
// Software drivers end a loop after 65,536 turns.
constexpr std::uint32_t reference_vpls = 60'000;
constexpr std::uint32_t seeds = 4;

std::vector<float> indirect(Bench& bench, std::uint32_t vpls, float bound, std::uint32_t seed) {
    Configuration configuration;
    configuration.show = Show::indirect;
    configuration.vpls.count = vpls;
    configuration.vpls.seed = seed;
    configuration.geometry_bound = bound;
    bench.configure(configuration);
    bench.frame({});
    return bench.pixels();
}

struct Errors {
    double relative_mse = 0.0;
    double bias = 0.0;
    double spike = 0.0;
};

/// relMSE = mean(|a - r|² / (|r|² + 0.01 |m|²)), bias = Σ(a - r) / Σr, spike = largest channel over the
/// reference's largest, over the pixels that show a surface; m is the reference's mean.
Errors compare(const std::vector<float>& picture, const std::vector<float>& reference) {
    glm::dvec3 mean(0.0);
    double largest = 0.0;
    double pixels = 0.0;
    const auto rgb = [](const std::vector<float>& image, std::size_t i) {
        return glm::dvec3(image[i], image[i + 1], image[i + 2]);
    };
    const auto each_pixel = [&](auto visit) {
        for (std::size_t i = 0; i < reference.size(); i += 4) {
            if (reference[i + 3] > 0.0F) {
                visit(rgb(picture, i), rgb(reference, i));
            }
        }
    };
    each_pixel([&](glm::dvec3, glm::dvec3 r) {
        mean += r;
        largest = std::max({largest, r.r, r.g, r.b});
        pixels += 1.0;
    });
    mean /= pixels;
    Errors errors;
    double difference = 0.0;
    double total = 0.0;
    each_pixel([&](glm::dvec3 a, glm::dvec3 r) {
        const glm::dvec3 d = a - r;
        errors.relative_mse += glm::dot(d, d) / (glm::dot(r, r) + 0.01 * glm::dot(mean, mean)) / pixels;
        errors.spike = std::max({errors.spike, a.r / largest, a.g / largest, a.b / largest});
        difference += d.r + d.g + d.b;
        total += r.r + r.g + r.b;
    });
    errors.bias = difference / total;
    return errors;
}

}  // namespace

int bound(const std::filesystem::path& scene) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    World world;
    import_gltf(scene, world);
    Bench bench(context->get_proc(), world, size);
    const std::vector<float> reference = indirect(bench, reference_vpls, 1.0F, seeds);
    fmt::print("{}: indirect light against {} VPLs, mean of {} seeds\n", scene.filename().string(),
               reference_vpls, seeds);
    fmt::print("{:>6} {:>8} {:>10} {:>8} {:>8}\n", "VPLs", "bound", "relMSE", "bias", "spike");
    for (const std::uint32_t vpls : {64U, 256U, 1024U}) {
        for (const float factor :
             {0.02F, 0.05F, 0.1F, 0.2F, 0.5F, 1.0F, std::numeric_limits<float>::infinity()}) {
            Errors mean;
            for (std::uint32_t seed = 0; seed < seeds; ++seed) {
                const Errors errors = compare(indirect(bench, vpls, factor, seed), reference);
                mean.relative_mse += errors.relative_mse / seeds;
                mean.bias += errors.bias / seeds;
                mean.spike = std::max(mean.spike, errors.spike);
            }
            fmt::print("{:>6} {:>8} {:>10.4f} {:>8.3f} {:>8.2f}\n", vpls, factor, mean.relative_mse,
                       mean.bias, mean.spike);
        }
    }
    return 0;
}

}  // namespace candela::study
