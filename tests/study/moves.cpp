#include <fmt/format.h>
#include <algorithm>
#include <string_view>

#include <candela/headless_context.hpp>
#include "sandbox/animation/animation_script.hpp"
#include "sandbox/scene/scene.hpp"
#include "tests/study/bench.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

/// Milliseconds, and the number of passes that took them.
struct Share {
    double ms = 0.0;
    int passes = 0;
};

/// The cost of the selected passes in the last frame.
template <class Wanted>
Share share_of(Renderer& renderer, Wanted wanted) {
    Share share;
    const FrameReport frame = renderer.take_frames(true).back();
    for (const PassReport& pass : frame.passes) {
        if (pass.ran && wanted(pass.name)) {
            share.ms += std::max(pass.cpu_ms, pass.gpu_ms);
            ++share.passes;
        }
    }
    return share;
}

bool is_of_vpls(std::string_view pass) {
    return pass.starts_with("vpl-") || pass.starts_with("surfel");
}

/// Whether the pass is not one of the frame's last passes, which every deferred frame must run.
bool is_before_shading(std::string_view pass) {
    return pass != "deferred" && pass != "transparent" && pass != "tone-map";
}

Configuration configuration_of(std::uint32_t vpls, VplPlacement placement) {
    Configuration configuration;
    configuration.path = ShadingPath::deferred;
    configuration.vpls.count = vpls;
    configuration.vpls.placement = placement;
    configuration.interleave = Interleave::one;
    configuration.visibility.method = VplVisibility::maps;
    configuration.refinement.enabled = false;
    return configuration;
}

struct Figures {
    std::vector<double> still;   ///< a still frame, relative to what a full frame spends before shading
    std::vector<double> camera;  ///< ms of the VPL passes after the camera moved
    int camera_passes = 0;       ///< the largest number of them that ran
    std::vector<double> light;   ///< VPL passes after the light moved, relative to all VPL passes
};

void play_round(Bench& bench, int round, Figures& figures) {
    bench.frame({});
    const Share moved = share_of(bench.renderer(), is_of_vpls);
    const double still_ms = bench.frame({});
    bench.frame({0.01F * static_cast<float>(round + 1), 0.0F});
    const Share camera = share_of(bench.renderer(), is_of_vpls);
    bench.renderer().invalidate();
    bench.frame({});
    const Share all = share_of(bench.renderer(), is_of_vpls);
    bench.renderer().invalidate();
    bench.frame({});
    const Share before_shading = share_of(bench.renderer(), is_before_shading);
    // The first round compiles shaders and uploads the scene, and does not count.
    if (round == 0) return;
    figures.still.push_back(still_ms / before_shading.ms);
    figures.camera.push_back(camera.ms);
    figures.camera_passes = std::max(figures.camera_passes, camera.passes);
    figures.light.push_back(moved.ms / all.ms);
}

Figures play(const gl::GetProc& get_proc, const sandbox::Script& script, const MovesStudy& study) {
    World world = sandbox::load_scene(sandbox::scene_of(script).value()).world;
    const sandbox::Animation animation(script, world);
    Bench bench(get_proc, world, study.size);
    bench.configure(configuration_of(study.vpls, VplPlacement::surfels));
    Figures figures;
    for (int round = 0; round <= study.rounds; ++round) {
        animation.apply(world, round);
        play_round(bench, round, figures);
    }
    return figures;
}

}  // namespace

int moves(const MovesStudy& study) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    fmt::print("Cornell box, {} VPLs with maps, {} x {}, deferred, medians of {} interleaved rounds\n",
               study.vpls, study.size.x, study.size.y, study.rounds);
    for (const char* name : {"flicker-walk", "orbit-light"}) {
        const Figures figures = play(context->get_proc(), sandbox::load_script(name), study);
        fmt::print("{}:\n", name);
        fmt::print("  still frame / a full one's time before shading: {:.3f}\n", median(figures.still));
        fmt::print("  camera moved: {} passes of VPLs ran, {:.2f} ms\n", figures.camera_passes,
                   median(figures.camera));
        fmt::print("  light moved, VPL passes / all computed again: {:.3f}\n", median(figures.light));
    }
    return 0;
}

}  // namespace candela::study
