#include <fmt/format.h>
#include <algorithm>
#include <array>

#include <candela/headless_context.hpp>
#include <candela/scene/gltf.hpp>
#include "renderer/facade/device_of.hpp"
#include "tests/study/bench.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

constexpr glm::uvec2 size(640, 480);
constexpr int rounds = 15;

struct TimedShading {
    ShadingPath path;
    Bench bench;
    std::vector<double> full;   // ms, everything that depends on the view
    std::vector<double> still;  // ms, nothing changed
};

void print_passes(std::string_view title, const Renderer& renderer) {
    fmt::print("{}:", title);
    for (const PassRecord& pass : renderer.last_passes()) {
        if (pass.ran) fmt::print(" {}", pass.name);
    }
    fmt::print("\n");
}

}  // namespace

int shading(const std::filesystem::path& scene) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    World world;
    import_gltf(scene, world);
    std::array<TimedShading, 2> candidates{
        TimedShading{ShadingPath::forward, Bench(context->get_proc(), world, size), {}, {}},
        TimedShading{ShadingPath::deferred, Bench(context->get_proc(), world, size), {}, {}}};
    for (TimedShading& candidate : candidates) {
        Configuration configuration;
        configuration.path = candidate.path;
        configuration.interleave = Interleave::one;
        candidate.bench.configure(configuration);
        candidate.bench.frame({});
    }
    fmt::print("{}, {}\n", scene.filename().string(), device_of(candidates[0].bench.renderer()).renderer());
    print_passes("first frame", candidates[1].bench.renderer());

    std::vector<double> ratios;
    for (int round = 0; round < rounds; ++round) {
        const glm::vec2 jitter(static_cast<float>(round + 1) / static_cast<float>(2 * rounds), 0.0F);
        for (TimedShading& candidate : candidates) {
            candidate.full.push_back(candidate.bench.frame(jitter));
            candidate.still.push_back(candidate.bench.frame(jitter));
        }
        ratios.push_back(candidates[1].full.back() / candidates[0].full.back());
    }
    print_passes("still frame", candidates[1].bench.renderer());

    const std::size_t pixels = candidates[0].bench.covered_pixels();
    const VplReport vpls = candidates[0].bench.renderer().report().vpls.value();
    const double evaluations = static_cast<double>(pixels) * vpls.alive;
    fmt::print("{} x {}, {} of {} VPLs alive, {} pixels covered, medians of {} interleaved rounds\n", size.x,
               size.y, vpls.alive, vpls.requested, pixels, rounds);
    fmt::print("{:<10} {:>12} {:>18} {:>16}\n", "path", "frame ms", "ns / VPL·pixel", "still / frame");
    for (const TimedShading& candidate : candidates) {
        const double full = median(candidate.full);
        fmt::print("{:<10} {:>12.2f} {:>17.3f} {:>16.4f}\n", to_string(candidate.path), full,
                   full * 1e6 / evaluations, median(candidate.still) / full);
    }
    fmt::print("deferred / forward: {:.3f}\n", median(ratios));
    return 0;
}

}  // namespace candela::study
