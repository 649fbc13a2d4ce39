#include <fmt/format.h>
#include <map>
#include <stdexcept>
#include <utility>

#include <candela/headless_context.hpp>
#include "sandbox/animation/animation_script.hpp"
#include "sandbox/scene/scene.hpp"
#include "tests/study/frame_hash.hpp"
#include "tests/study/rendering.hpp"
#include "tests/study/scene_hash.hpp"
#include "tests/study/study.hpp"
#include "tests/study/tracing.hpp"

namespace candela::study {
namespace {

using tools::Picture;

/// A script, and the scene that it animates.
struct Play {
    sandbox::Script script;
    std::filesystem::path scene;
    World world;
    sandbox::Animation animation;
    int frames = 0;
};

Play load_play(const AnimateStudy& study) {
    sandbox::Script script = sandbox::load_script(study.script);
    const auto file = sandbox::scene_of(script);
    if (!file) throw std::invalid_argument(fmt::format("{}: names no scene", script.path.string()));
    World world = sandbox::load_scene(*file).world;
    sandbox::Animation animation(script, world);
    const int frames = study.frames > 0 ? study.frames : script.frames;
    return {std::move(script), *file, std::move(world), std::move(animation), frames};
}

/// The references of all frames, as separate lists for `flicker`.
struct TrueFrames {
    std::vector<Halves> indirect;
    std::vector<Halves> total;
    std::vector<Mask> hits;
};

/// Reads the reference from its folder, or traces it and writes it there. All frames have the same seed, so
/// their noise is almost the same, and differences between frames are due to what moves.
Reference reference_of(const Play& play, const std::string& hash, const AnimateStudy& study) {
    const Request request{.scene_hash = hash,
                          .tracer = std::string(tracer_name()),
                          .size = study.size,
                          .samples = study.samples,
                          .bounces = study.bounces,
                          .seed = study.seed};
    const std::filesystem::path folder = study.references / hash;
    if (holds(folder, request)) return read_reference(folder);
    Reference traced = trace_request(play.world, request);
    write_reference(folder, play.scene.filename().string(), traced);
    return traced;
}

void add(TrueFrames& truth, const reference::Estimate& estimate) {
    truth.indirect.push_back(estimate.halves);
    truth.total.push_back(halves_of_total(estimate));
    truth.hits.push_back(estimate.hit);
}

TrueFrames trace_frames(Play& play, const AnimateStudy& study) {
    const std::string hash_of_scene = scene_hash(play.scene);
    std::map<std::string, Reference> known;
    TrueFrames truth;
    for (int frame = 0; frame < play.frames; ++frame) {
        const std::string hash = frame_hash(hash_of_scene, play.script, frame);
        if (!known.contains(hash)) {
            play.animation.apply(play.world, frame);
            known.emplace(hash, reference_of(play, hash, study));
            print_line({{"kind", "reference"}, {"frame", frame}, {"frames", play.frames}});
        }
        add(truth, known.at(hash).estimate);
    }
    return truth;
}

/// The pictures of a script, rendered with a point's configuration.
struct Take {
    std::vector<Picture> indirect;
    std::vector<Picture> total;
};

/// `all` shows all light; its time is that of a user's frame. `direct` shows only direct light, and indirect
/// light is the difference of both.
struct Stage {
    Bench all;
    Bench direct;
};

Configuration without_indirect(Configuration configuration) {
    configuration.indirect = false;
    return configuration;
}

/// Renders a frame; returns the milliseconds of the frame with all light.
double play_frame(Stage& stage, Take& take) {
    const double ms = stage.all.frame({});
    stage.direct.frame({});
    take.total.push_back(finite_picture(stage.all));
    take.indirect.push_back(difference(take.total.back(), finite_picture(stage.direct)));
    return ms;
}

Json frame_line(const Point& point, int frame, double ms, const Report& report, const Take& take,
                const TrueFrames& truth) {
    const auto at = static_cast<std::size_t>(frame);
    const Mask& hit = truth.hits[at];
    return {{"id", point.id},
            {"kind", "frame"},
            {"frame", frame},
            {"errors",
             {{"indirect", to_json(measure(take.indirect[at], truth.indirect[at], hit))},
              {"total", to_json(measure(take.total[at], truth.total[at], hit))}}},
            {"full_ms", ms},
            {"refined", report.refined}};
}

Json flicker_line(const Point& point, const Take& take, const TrueFrames& truth) {
    return {{"id", point.id},
            {"kind", "flicker"},
            {"indirect", flicker(take.indirect, truth.indirect, truth.hits)},
            {"total", flicker(take.total, truth.total, truth.hits)},
            {"indirect_pairs", flicker_of_pairs(take.indirect, truth.indirect, truth.hits)}};
}

Json play_point(const gl::GetProc& get_proc, Play& play, const TrueFrames& truth, const AnimateStudy& study,
                const Point& point) {
    Configuration configuration = configuration_of(point);
    Stage stage{Bench(get_proc, play.world, study.size), Bench(get_proc, play.world, study.size)};
    stage.all.configure(configuration);
    stage.direct.configure(without_indirect(configuration));
    Take take;
    for (int frame = 0; frame < play.frames; ++frame) {
        play.animation.apply(play.world, frame);
        if (point.fresh_seeds) {
            // A larger step than refinement or any list of seeds needs.
            configuration.vpls.seed = point.seeds.front() + 4096U * static_cast<std::uint32_t>(frame);
            stage.all.configure(configuration);
        }
        const double ms = play_frame(stage, take);
        print_line(frame_line(point, frame, ms, stage.all.renderer().report(), take, truth));
    }
    return flicker_line(point, take, truth);
}

}  // namespace

int animate(const AnimateStudy& study) {
    const std::vector<Point> points = read_points(read_json(study.points), study.points.string());
    Play play = load_play(study);
    const TrueFrames truth = trace_frames(play, study);
    const auto context = HeadlessContext::create(study.context);
    context->make_current();
    for (const Point& point : points) {
        static_cast<void>(
            attempt(point, [&] { return play_point(context->get_proc(), play, truth, study, point); }));
    }
    return 0;
}

}  // namespace candela::study
