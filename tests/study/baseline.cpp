#include <thread>

#include "sandbox/scene/scene.hpp"
#include "tests/study/bench.hpp"
#include "tests/study/reference_files.hpp"
#include "tests/study/scene_hash.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

struct TracedSample {
    tools::Picture indirect;
    tools::Picture total;
    double ms = 0.0;
};

/// The tracer requires an even number of samples. For an odd number, traces twice as many, and uses one of
/// the halves and half of the time.
TracedSample sample(const reference::Scene& scene, Entity camera, reference::Settings settings) {
    const bool odd = settings.samples % 2 != 0;
    settings.samples *= odd ? 2 : 1;
    reference::Estimate estimate = reference::trace(scene, camera, settings);
    tools::Picture indirect = std::move(odd ? estimate.halves[0] : estimate.indirect);
    tools::Picture total = sum(std::move(estimate.direct), indirect);
    return {std::move(indirect), std::move(total), estimate.seconds * (odd ? 500.0 : 1000.0)};
}

struct Baseline {
    std::vector<double> ms;
    std::vector<Errors> indirect;
    std::vector<Errors> total;
};

Baseline run_rounds(const reference::Scene& scene, Entity camera, const Reference& reference,
                    std::uint32_t samples, std::uint32_t rounds) {
    const reference::Estimate& truth = reference.estimate;
    const Halves total = halves_of_total(truth);
    Baseline baseline;
    for (std::uint32_t round = 0; round < rounds; ++round) {
        // Seeds differ from the reference's, so that errors are independent of those of the reference.
        const TracedSample now = sample(scene, camera,
                                        {.size = reference.request.size,
                                         .samples = samples,
                                         .bounces = reference.request.bounces,
                                         .seed = reference.request.seed + 1 + round});
        baseline.ms.push_back(now.ms);
        baseline.indirect.push_back(measure(now.indirect, truth.halves, truth.hit));
        baseline.total.push_back(measure(now.total, total, truth.hit));
    }
    return baseline;
}

}  // namespace

int baseline(const BaselineStudy& study) {
    const Reference reference = read_reference_of(study.scene, study.reference);
    const sandbox::Scene scene = sandbox::load_scene(study.scene);
    const reference::Scene traced(scene.world);
    const Entity camera = first_camera(scene.world);
    for (const std::uint32_t samples : study.samples) {
        const Baseline found = run_rounds(traced, camera, reference, samples, study.rounds);
        print_line({{"kind", "baseline"},
                    {"samples", samples},
                    {"ms", median(found.ms)},
                    {"rounds", study.rounds},
                    {"threads", std::thread::hardware_concurrency()},
                    {"errors",
                     {{"indirect", to_json(mean(found.indirect))}, {"total", to_json(mean(found.total))}}}});
    }
    return 0;
}

}  // namespace candela::study
