#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <candela/headless_context.hpp>
#include <candela/scene/gltf.hpp>
#include "renderer/facade/device_of.hpp"
#include "tests/study/bench.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

struct TimedGather {
    Interleave interleave;
    Bench bench;
    std::vector<double> frames;    // ms, everything that depends on the view
    std::vector<double> indirect;  // ms of them for the light of VPLs, or for all shading if n is 1
};

double indirect_ms(const FrameReport& frame, Interleave interleave) {
    double sum = 0.0;
    for (const PassReport& pass : frame.passes) {
        const std::string_view name = pass.name;
        const bool gathers = name == "vpl-gather" || name.starts_with("vpl-reconstruct") ||
                             name == "vpl-fill-list" || name == "vpl-fill";
        const bool counts = interleave == Interleave::one ? name == "deferred" : gathers;
        sum += pass.ran && counts ? pass.gpu_ms : 0.0;
    }
    return sum;
}

void add_round(TimedGather& candidate, glm::vec2 jitter) {
    (void)candidate.bench.renderer().take_frames(true);
    candidate.frames.push_back(candidate.bench.frame(jitter));
    candidate.indirect.push_back(
        indirect_ms(candidate.bench.renderer().take_frames(true).back(), candidate.interleave));
}

void print_row(std::uint32_t vpls, TimedGather& candidate, const TimedGather& all, std::size_t pixels) {
    const VplReport report = candidate.bench.renderer().report().vpls.value();
    const Errors errors = measure(candidate.bench.picture(), all.bench.picture());
    fmt::print("{:>6} {:>3} {:>12.1f} {:>12.1f} {:>10.3f} {:>9.2f} % {:>12.2e}\n", vpls,
               to_string(candidate.interleave), median(candidate.frames), median(candidate.indirect),
               median(candidate.indirect) / median(all.indirect),
               100.0 * report.filled_pixels / static_cast<double>(pixels), errors.rel_mse);
}

}  // namespace

int gather(const GatherStudy& study) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    World world;
    import_gltf(study.scene, world);
    const auto bench = [&] { return Bench(context->get_proc(), world, study.size); };
    std::array<TimedGather, 4> candidates{
        TimedGather{Interleave::one, bench(), {}, {}}, TimedGather{Interleave::two, bench(), {}, {}},
        TimedGather{Interleave::four, bench(), {}, {}}, TimedGather{Interleave::eight, bench(), {}, {}}};
    fmt::print("{}, indirect light with depth maps, {} x {}, medians of {} interleaved rounds, {}\n",
               study.scene.filename().string(), study.size.x, study.size.y, study.rounds,
               device_of(candidates[0].bench.renderer()).renderer());
    fmt::print("{:>6} {:>3} {:>12} {:>12} {:>10} {:>11} {:>12}\n", "VPLs", "n", "frame ms", "gather ms",
               "of n = 1", "asked more", "relMSE to 1");
    for (const std::uint32_t vpls : study.vpls) {
        for (TimedGather& candidate : candidates) {
            Configuration configuration;
            configuration.show = Show::indirect;
            configuration.vpls.count = vpls;
            configuration.interleave = candidate.interleave;
            candidate.bench.configure(configuration);
            candidate.frames.clear();
            candidate.indirect.clear();
            candidate.bench.frame({});
        }
        for (int round = 0; round < study.rounds; ++round) {
            const float shift = static_cast<float>(round + 1) / static_cast<float>(2 * study.rounds);
            for (TimedGather& candidate : candidates) add_round(candidate, {shift, 0.0F});
        }
        const std::size_t pixels = candidates[0].bench.covered_pixels();
        for (TimedGather& candidate : candidates) print_row(vpls, candidate, candidates[0], pixels);
    }
    return 0;
}

}  // namespace candela::study
