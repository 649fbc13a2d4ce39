#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <candela/headless_context.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/lights.hpp>
#include "renderer/facade/device_of.hpp"
#include "sandbox/scene/scene.hpp"
#include "tests/study/bench.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

/// A way in which a frame differs from the one before it.
struct Change {
    std::string_view name;
    std::function<void()> apply;
    std::vector<double> wall{};  ///< ms from the call until the GPU has finished, of each round
    std::vector<double> host{};  ///< ms of them that the host's thread took to record the frame
    std::map<std::string, std::vector<double>, std::less<>> passes{};  ///< ms on the GPU, of those that ran
};

std::optional<Entity> first_light(const World& world) {
    std::optional<Entity> first;
    visit_lights(world, [&](Entity entity, const auto& /*light*/) {
        if (!first) first = entity;
    });
    return first;
}

void shift(World& world, Entity entity, float metres) {
    Transform transform = world.get<Transform>(entity);
    transform.translation.x += metres;
    world.set(entity, transform);
}

void play(Bench& bench, Change& change) {
    change.apply();
    (void)bench.renderer().take_frames(true);
    change.wall.push_back(bench.frame({}));
    const FrameReport frame = bench.renderer().take_frames(true).back();
    change.host.push_back(frame.cpu_ms);
    for (const PassReport& pass : frame.passes) {
        if (pass.ran) change.passes[pass.name].push_back(pass.gpu_ms);
    }
}

void print_row(std::uint32_t vpls, const Change& change) {
    std::vector<std::pair<double, std::string_view>> passes;
    double gpu = 0.0;
    for (const auto& [name, times] : change.passes) {
        passes.emplace_back(median(times), name);
        gpu += passes.back().first;
    }
    std::sort(passes.rbegin(), passes.rend());
    fmt::print("{:>6} {:<12} {:>9.2f} {:>9.2f} {:>9.2f} {:>7} ", vpls, change.name, median(change.wall), gpu,
               median(change.host), passes.size());
    // What takes less than a fiftieth tells nothing of where the time goes.
    for (const auto& [ms, name] : passes) {
        if (ms > gpu / 50.0) fmt::print(" {} {:.2f}", name, ms);
    }
    fmt::print("\n");
}

void measure_count(Bench& bench, const FramesStudy& study, std::uint32_t vpls, std::vector<Change> changes) {
    Configuration configuration;
    configuration.vpls.count = vpls;
    configuration.refinement.enabled = false;
    bench.configure(configuration);
    bench.frame({});
    for (int round = 0; round < study.rounds; ++round) {
        for (Change& change : changes) play(bench, change);
    }
    for (const Change& change : changes) print_row(vpls, change);
}

}  // namespace

int frames(const FramesStudy& study) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    World world = sandbox::load_scene(study.scene).world;
    const Entity camera = first_camera(world);
    const std::optional<Entity> light = first_light(world);
    Bench bench(context->get_proc(), world, study.size);
    std::vector<Change> changes{{"still", [] {}}, {"camera moved", [&] { shift(world, camera, 0.001F); }}};
    if (light) changes.push_back({"light moved", [&] { shift(world, *light, 0.001F); }});
    changes.push_back({"all anew", [&] { bench.renderer().invalidate(); }});
    fmt::print("{}, {} x {}, {}, medians of {} interleaved rounds\n", study.scene.filename().string(),
               study.size.x, study.size.y, device_of(bench.renderer()).renderer(), study.rounds);
    fmt::print("{:>6} {:<12} {:>9} {:>9} {:>9} {:>7}  ms on the GPU by pass\n", "VPLs", "frame", "ms",
               "GPU ms", "host ms", "passes");
    for (const std::uint32_t vpls : study.vpls) measure_count(bench, study, vpls, changes);
    return 0;
}

}  // namespace candela::study
