#include <fmt/format.h>
#include <algorithm>
#include <deque>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <candela/headless_context.hpp>
#include <candela/tools/capture.hpp>
#include <candela/tools/flip.hpp>
#include "renderer/frame/build_frame.hpp"
#include "renderer/passes/view/view.hpp"
#include "sandbox/scene/scene.hpp"
#include "tests/study/heat.hpp"
#include "tests/study/reference_files.hpp"
#include "tests/study/rendering.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

using tools::Picture;

/// The relative error at the brightest colour of all heat maps, so that they can be compared.
constexpr double heat_scale = 0.5;

/// Writes pictures as the app shows them by default, whatever is measured.
class Darkroom {
 public:
    Darkroom(const gl::GetProc& get_proc, glm::uvec2 size, std::filesystem::path folder)
        : renderer_(get_proc), capture_(renderer_, get_proc, glm::ivec2(size)), folder_(std::move(folder)) {
        std::filesystem::create_directories(folder_);
    }
    /// Returns the file's name within the folder.
    std::string develop(const std::string& name, const Picture& picture) {
        capture_.write(folder_ / (name + ".png"), picture);
        return name + ".png";
    }
    std::string heat(const std::string& name, const Picture& picture, const Picture& reference,
                     const Mask& hit) {
        const HeatMap map = heat_map(picture, reference, hit, heat_scale);
        tools::write_png(folder_ / (name + "-heat.png"), map.size, map.rgb);
        return name + "-heat.png";
    }

 private:
    Renderer renderer_;
    tools::Capture capture_;
    std::filesystem::path folder_;
};

/// The reference, and what is derived from it.
struct Truth {
    Picture direct;
    Picture direct_fine;
    Halves indirect;
    Halves total;
    Picture shown;  ///< the mean of `total`
    Mask hit;
    Mask off_edges;  ///< the pixels of `hit` away from the edges of shadows and silhouettes
    /// Surfaces emit light, or there is a sky: VPLs carry a part of the direct light.
    bool emission = false;
};

Truth truth_of(Reference reference) {
    reference::Estimate& estimate = reference.estimate;
    Halves total = halves_of_total(estimate);
    Picture shown = reference::total(estimate);
    Truth truth{.direct = std::move(estimate.direct),
                .direct_fine = std::move(reference.direct_fine),
                .indirect = std::move(estimate.halves),
                .total = std::move(total),
                .shown = std::move(shown),
                .hit = std::move(estimate.hit),
                .off_edges = {},
                .emission = false};
    truth.off_edges = truth.hit;
    for (std::size_t i = 0; i < truth.off_edges.size(); ++i) {
        truth.off_edges[i] = estimate.edge[i] != 0 ? 0 : truth.off_edges[i];
    }
    return truth;
}

/// Renders one frame with this part of the light.
Picture render(Bench& bench, Configuration configuration, Show show) {
    configuration.show = show;
    bench.configure(configuration);
    bench.frame({});
    return finite_picture(bench);
}

/// Only direct light; settings that it does not depend on have their defaults.
Configuration direct_part(Configuration configuration, bool emission) {
    configuration.show = Show::direct;
    configuration.indirect = false;
    configuration.vpls = {.count = emission ? configuration.vpls.count : VplSettings{}.count};
    configuration.visibility = {};
    configuration.refinement = {};
    return configuration;
}

struct DirectLight {
    Picture centre;
    Picture fine;
};

/// Direct light at pixel centres, and its mean over fine_side² points per pixel. With one point per pixel, a
/// pixel at a shadow edge is completely right or completely wrong, so that in a small dark picture a few
/// pixels dominate the error. The points are the same as those of the reference.
DirectLight render_direct(Bench& bench, const Configuration& direct_only) {
    bench.configure(direct_only);
    bench.frame({});
    DirectLight light{finite_picture(bench), {}};
    Picture fine = Picture{light.centre.size, std::vector<glm::vec3>(light.centre.pixels.size())};
    const auto offset = [](int i) { return (static_cast<float>(i) + 0.5F) / fine_side - 0.5F; };
    for (int i = 0; i < fine_side * fine_side; ++i) {
        bench.frame({offset(i % fine_side), offset(i / fine_side)});
        fine = sum(std::move(fine), finite_picture(bench));
    }
    for (glm::vec3& pixel : fine.pixels) {
        pixel /= static_cast<float>(fine_side * fine_side);
    }
    light.fine = std::move(fine);
    return light;
}

/// Renders direct light once per path and kind of shadows, as it does not depend on VPLs; with emission also
/// once per number of VPLs.
class DirectLights {
 public:
    explicit DirectLights(bool emission) : emission_(emission) {}

    const DirectLight& of(const Configuration& configuration, const std::function<Bench()>& make_bench) {
        const Configuration key = direct_part(configuration, emission_);
        const auto known =
            std::find_if(known_.begin(), known_.end(), [&](const auto& each) { return each.first == key; });
        if (known != known_.end()) return known->second;
        Bench bench = make_bench();
        return known_.emplace_back(key, render_direct(bench, key)).second;
    }

 private:
    bool emission_;
    std::deque<std::pair<Configuration, DirectLight>> known_;
};

/// The results that depend on the seed of the VPLs.
struct Seeds {
    std::vector<Errors> indirect;
    std::vector<Errors> total;
    std::vector<double> flip;
    Picture first;  ///< all light with the first seed
};

/// Direct light does not depend on the seed, and the total is the sum, so one frame per seed is enough. With
/// emission it takes two: without indirect light there are fewer VPLs, and other pixels evaluate them.
Seeds measure_seeds(Bench& bench, Configuration configuration, const std::vector<std::uint32_t>& seeds,
                    const Picture& direct, const Truth& truth) {
    Seeds result;
    for (const std::uint32_t seed : seeds) {
        configuration.vpls.seed = seed;
        const Picture indirect = render(bench, configuration, Show::indirect);
        Picture total = truth.emission ? render(bench, configuration, Show::total) : sum(direct, indirect);
        result.indirect.push_back(measure(indirect, truth.indirect, truth.hit));
        result.total.push_back(measure(total, truth.total, truth.hit));
        result.flip.push_back(tools::flip_of_light(total, truth.shown, truth.hit).mean);
        if (result.first.pixels.empty()) result.first = std::move(total);
    }
    return result;
}

/// The allowed relMSE between a picture and the sum of its parts: float rounding. Because of rounding, a
/// shadow ray may also pass an edge on the other side, which turns one VPL on or off in one pixel.
double tolerance_of(const Configuration& configuration) {
    return configuration.visibility.method == VplVisibility::rays ? 1e-8 : 1e-10;
}

/// Renders the frame that a user would get, whose state is then reported. Its picture must be the sum of its
/// parts, which `measure_seeds` relies on.
void render_whole(Bench& bench, const Configuration& configuration, const Picture& parts) {
    const Picture whole = render(bench, configuration, Show::total);
    const double difference = measure(whole, parts).rel_mse;
    if (difference > tolerance_of(configuration)) {
        throw std::runtime_error(
            fmt::format("direct and indirect light do not add up to the total: relMSE {:.1e}", difference));
    }
}

/// Null if edges are everywhere, as when pixels are larger than the objects of the scene.
Json off_edges_json(const Picture& direct, const Truth& truth) {
    const bool none =
        std::all_of(truth.off_edges.begin(), truth.off_edges.end(), [](auto away) { return away == 0; });
    return none ? Json(nullptr) : to_json(measure(direct, truth.direct, truth.off_edges));
}

Json errors_json(const DirectLight& direct, const Seeds& seeds, const Truth& truth) {
    return {{"direct", to_json(measure(direct.fine, truth.direct_fine, truth.hit))},
            {"direct_off_edges", off_edges_json(direct.centre, truth)},
            {"indirect", to_json(mean(seeds.indirect))},
            {"total", to_json(mean(seeds.total))}};
}

/// The relMSE of the indirect light of surfels: as the renderer estimates it, and as it is. Null without
/// surfels, or if edges are nearly everywhere.
Json estimate_json(Bench& bench, const Configuration& configuration, const Truth& truth) {
    if (configuration.vpls.placement != VplPlacement::surfels) return nullptr;
    const Picture indirect = render(bench, configuration, Show::indirect);
    const std::optional<double> error = rel_mse_of_blocks(indirect, truth.indirect, truth.off_edges);
    if (!error) return nullptr;
    return {{"estimated", bench.estimate_error().value()}, {"measured", *error}};
}

Json per_seed_json(const Point& point, const Seeds& seeds) {
    Json list = Json::array();
    for (std::size_t i = 0; i < point.seeds.size(); ++i) {
        list.push_back({{"seed", point.seeds[i]},
                        {"indirect", to_json(seeds.indirect[i])},
                        {"total", to_json(seeds.total[i])},
                        {"flip", seeds.flip[i]}});
    }
    return list;
}

Json to_json(const glm::dvec3& rgb) {
    return {rgb.r, rgb.g, rgb.b};
}

Json to_json(const EnergyAccount& flux) {
    return {{"emitted", to_json(flux.emitted)},   {"absorbed", to_json(flux.absorbed)},
            {"escaped", to_json(flux.escaped)},   {"truncated", to_json(flux.truncated)},
            {"roulette", to_json(flux.roulette)}, {"roulette_error", to_json(flux.roulette_error)}};
}

Json to_json(const std::optional<VplReport>& vpls) {
    if (!vpls) return nullptr;
    return {{"requested", vpls->requested},
            {"alive", vpls->alive},
            {"paths", vpls->paths},
            {"flux", to_json(vpls->flux)}};
}

/// Counts that do not depend on the machine. `rays` are those of the VPLs' paths; `lists` is the number of
/// lights that a tile or cluster visits.
Json work_json(const Report& report, std::size_t pixels) {
    const VplReport vpls = report.vpls.value_or(VplReport{});
    Json work = {{"pixels", pixels},
                 {"vpl_pixels", static_cast<std::uint64_t>(pixels) * vpls.alive},
                 {"rays", vpls.rays},
                 {"triangles", report.triangles},
                 {"lights", report.lights.count},
                 {"shadows", report.lights.with_map},
                 {"lists", nullptr}};
    if (report.lights.tile_max > 0) {
        work["lists"] = {{"global", report.lights.global},
                         {"longest", report.lights.tile_max},
                         {"mean", report.lights.tile_mean}};
    }
    return work;
}

/// `bytes` excludes what is only kept for returning to the previous configuration.
Json memory_json(const MemoryUse& memory) {
    return {{"bytes", memory.texture_bytes + memory.buffer_bytes - memory.free_pool_bytes},
            {"texture_bytes", memory.texture_bytes},
            {"buffer_bytes", memory.buffer_bytes},
            {"free_pool_bytes", memory.free_pool_bytes},
            {"shared_by_aliasing_bytes", memory.shared_by_aliasing_bytes}};
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Json measure_point(Bench bench, Darkroom& darkroom, const Truth& truth, const DirectLight& direct,
                   const Point& point) {
    const Configuration configuration = configuration_of(point);
    const Seeds seeds = measure_seeds(bench, configuration, point.seeds, direct.centre, truth);
    render_whole(bench, configuration, seeds.first);
    const Report report = bench.renderer().report();
    return {{"id", point.id},
            {"kind", "errors"},
            {"config", Json::parse(write_configuration(configuration))},
            {"gl_renderer", report.gl_renderer},
            {"seeds", point.seeds},
            {"errors", errors_json(direct, seeds, truth)},
            {"estimate", estimate_json(bench, configuration, truth)},
            {"flip", mean(seeds.flip)},
            {"per_seed", per_seed_json(point, seeds)},
            {"vpls", to_json(report.vpls)},
            {"work", work_json(report, bench.covered_pixels())},
            {"memory", memory_json(report.memory)},
            {"picture", darkroom.develop(point.id, seeds.first)},
            {"heat", darkroom.heat(point.id, seeds.first, truth.shown, truth.hit)},
            {"heat_scale", heat_scale}};
}

/// Of a frame that keeps its VPLs.
double gather_ms(const FrameReport& frame) {
    return std::accumulate(frame.passes.begin(), frame.passes.end(), 0.0, [](double sum, const auto& pass) {
        return sum + (pass.ran && pass.name.starts_with("vpl-") ? pass.gpu_ms : 0.0);
    });
}

/// The first frame includes the cost of switching the configuration and of touching new memory pages, and is
/// not timed. Then times one frame in which only the view changes, and one that runs everything.
Json times_of(Bench& bench, const Point& point, std::uint32_t round) {
    bench.configure(configuration_of(point));
    bench.frame({});
    static_cast<void>(bench.renderer().take_frames(true));
    const double frame_ms = bench.frame(pixel_sample(2 * round - 1));
    const FrameReport frame = bench.renderer().take_frames(true).back();
    bench.renderer().invalidate();
    const double full_ms = bench.frame(pixel_sample(2 * round));
    return {{"frame_ms", frame_ms},
            {"cpu_ms", frame.cpu_ms},
            {"gpu_ms", frame.gpu_ms},
            {"gather_ms", gather_ms(frame)},
            {"full_ms", full_ms}};
}

/// Measures the time of the points in rounds, each with the same point in the scene `beside` right after it.
void measure_times(const gl::GetProc& get_proc, const World& world, glm::uvec2 size,
                   std::vector<Point> points, const MeasureStudy& study) {
    // A single renderer for all times, so that not all points are in memory at once.
    Bench bench(get_proc, world, size);
    std::optional<sandbox::Scene> other;
    std::optional<Bench> beside;
    if (study.beside) {
        other = sandbox::load_scene(*study.beside);
        beside.emplace(get_proc, other->world, size);
    }
    for (std::uint32_t round = 1; round <= study.rounds; ++round) {
        std::erase_if(points, [&](const Point& point) {
            return !attempt(point, [&] {
                Json line = times_of(bench, point, round);
                line.update({{"id", point.id}, {"kind", "time"}, {"round", round}});
                if (beside) line["beside"] = times_of(*beside, point, round);
                return line;
            });
        });
    }
}

}  // namespace

int measure(const MeasureStudy& study) {
    std::vector<Point> points = read_points(read_json(study.points), study.points.string());
    const Reference reference = read_reference_of(study.scene, study.reference);
    const sandbox::Scene scene = sandbox::load_scene(study.scene);
    Truth truth = truth_of(reference);
    Log log({});
    SceneCheck check(log, false);
    const FrameContents contents = contents_of(scene.world, check, 0).of_frame;
    truth.emission = contents.emitters || contents.sky;
    const auto context = HeadlessContext::create(study.context);
    context->make_current();
    Darkroom darkroom(context->get_proc(), reference.request.size, study.pictures);
    darkroom.develop("reference", truth.shown);
    const auto fresh_bench = [&] { return Bench(context->get_proc(), scene.world, reference.request.size); };

    DirectLights direct_lights(truth.emission);
    // Each point has its own renderer, so that its memory does not include leftovers of another point.
    std::erase_if(points, [&](const Point& point) {
        return !attempt(point, [&] {
            const DirectLight& direct = direct_lights.of(configuration_of(point), fresh_bench);
            return measure_point(fresh_bench(), darkroom, truth, direct, point);
        });
    });
    measure_times(context->get_proc(), scene.world, reference.request.size, std::move(points), study);
    return 0;
}

}  // namespace candela::study
