#include <fmt/format.h>
#include <algorithm>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <candela/headless_context.hpp>
#include <candela/scene/gltf.hpp>
#include "renderer/facade/device_of.hpp"
#include "tests/study/bench.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

/// Whether a pass builds light lists.
bool builds_lists(std::string_view pass) {
    return pass == "tile-depths" || pass.find("light-tiles") != pass.npos ||
           pass.find("light-clusters") != pass.npos;
}

struct TimedFrame {
    double frame = 0.0;  // ms
    double lists = 0.0;  // ms of it for building lists
};

/// Renders one frame whose view differs from that of the last one.
TimedFrame sample(Bench& bench, int round) {
    TimedFrame sample;
    sample.frame = bench.frame({0.01F * static_cast<float>(round + 1), 0.0F});
    for (const FrameReport& frame : bench.renderer().take_frames(true)) {
        sample.lists = 0.0;
        for (const PassReport& pass : frame.passes) {
            if (builds_lists(pass.name)) sample.lists += std::max(pass.cpu_ms, pass.gpu_ms);
        }
    }
    return sample;
}

Configuration configuration_of(ShadingPath path, std::uint32_t vpls) {
    Configuration configuration;
    configuration.path = path;
    configuration.indirect = vpls > 0;
    configuration.vpls.count = vpls;
    configuration.shadows.enabled = false;  // the same in every path, and not measured here
    return configuration;
}

struct TimedPath {
    ShadingPath path;
    std::unique_ptr<Bench> bench;
    std::vector<double> frame;  // ms
    std::vector<double> ratio;  // relative to the first path in the same round
    std::vector<double> lists;  // share of the frame
};

void print(const PathStudy& study, std::vector<TimedPath>& candidates) {
    Renderer& first = candidates.front().bench->renderer();
    fmt::print("{}, {} lights, {} VPLs, {} x {}, medians of {} interleaved rounds, {}\n",
               study.scene.filename().string(), first.report().lights.count, study.vpls, study.size.x,
               study.size.y, study.rounds, device_of(first).renderer());
    fmt::print("{:<20} {:>10} {:>8} {:>12} {:>10} {:>10}\n", "path", "frame ms", "ratio", "lists/frame",
               "list mean", "list max");
    for (TimedPath& candidate : candidates) {
        const LightReport lights = candidate.bench->renderer().report().lights;
        fmt::print("{:<20} {:>10.2f} {:>8.3f} {:>12.3f} {:>10.1f} {:>10}\n", to_string(candidate.path),
                   median(candidate.frame), median(candidate.ratio), median(candidate.lists),
                   lights.tile_mean, lights.tile_max);
    }
}

/// Appends a line for each path; a new file starts with the names of the columns.
void append_csv(const PathStudy& study, std::vector<TimedPath>& candidates) {
    const bool is_new = !std::filesystem::exists(study.csv);
    std::ofstream file(study.csv, std::ios::app);
    if (is_new) file << "scene,lights,path,frame_ms,ratio,lists_share,list_mean\n";
    for (TimedPath& candidate : candidates) {
        const LightReport lights = candidate.bench->renderer().report().lights;
        file << fmt::format("{},{},{},{:.3f},{:.4f},{:.4f},{:.2f}\n", study.scene.stem().string(),
                            lights.count, to_string(candidate.path), median(candidate.frame),
                            median(candidate.ratio), median(candidate.lists), lights.tile_mean);
    }
    if (!file) throw std::runtime_error(fmt::format("{}: cannot be written", study.csv.string()));
}

}  // namespace

int paths(const PathStudy& study) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    World world;
    import_gltf(study.scene, world);
    std::vector<TimedPath> candidates;
    for (const ShadingPath path : study.paths) {
        candidates.push_back(
            {path, std::make_unique<Bench>(context->get_proc(), world, study.size), {}, {}, {}});
        candidates.back().bench->configure(configuration_of(path, study.vpls));
    }
    // The first round compiles shaders and uploads the scene, and does not count.
    for (int round = 0; round <= study.rounds; ++round) {
        double first = 0.0;
        for (TimedPath& candidate : candidates) {
            const TimedFrame now = sample(*candidate.bench, round);
            first = first > 0.0 ? first : now.frame;
            if (round == 0) continue;
            candidate.frame.push_back(now.frame);
            candidate.ratio.push_back(now.frame / first);
            candidate.lists.push_back(now.lists / now.frame);
        }
    }
    print(study, candidates);
    if (!study.csv.empty()) append_csv(study, candidates);
    return 0;
}

}  // namespace candela::study
