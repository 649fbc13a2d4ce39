#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

#include "tests/study/compare.hpp"
#include "tests/study/study.hpp"

namespace {

using namespace candela;
using namespace candela::study;

void add_scene(CLI::App& part, std::filesystem::path& scene) {
    part.add_option("SCENE", scene, "a .gltf or .glb file with a camera")
        ->required()
        ->check(CLI::ExistingFile);
}

ShadingPath path_named(const std::string& name) {
    for (const ShadingPath path : all_shading_paths) {
        if (to_string(path) == name) return path;
    }
    throw std::invalid_argument(fmt::format("--paths: '{}' is no shading path", name));
}

std::vector<ShadingPath> paths_named(const std::vector<std::string>& names) {
    std::vector<ShadingPath> named;
    named.reserve(names.size());
    std::transform(names.begin(), names.end(), std::back_inserter(named), path_named);
    return named;
}

/// Parses a size like "640x480".
glm::uvec2 size_named(const std::string& text) {
    glm::uvec2 size(0);
    int length = 0;
    const int read = std::sscanf(text.c_str(), "%5ux%5u%n", &size.x, &size.y, &length);
    const bool fits = size.x > 0 && size.y > 0 && size.x <= 16384 && size.y <= 16384;
    if (read != 2 || static_cast<std::size_t>(length) != text.size() || !fits) {
        throw std::invalid_argument(fmt::format("--size: '{}' is no size from 1x1 to 16384x16384", text));
    }
    return size;
}

// Each of these adds a subcommand, which stores its exit status in `status` if the command line selects it.

void add_graph(CLI::App& app, int& status, int count, char** arguments) {
    app.add_subcommand("graph", "declaring, compiling and running frame graphs (Google Benchmark's flags)")
        ->prefix_command()
        ->callback([=, &status] { status = graph(count - 1, arguments + 1); });
}

void add_world(CLI::App& app, int& status, int count, char** arguments) {
    app.add_subcommand("world", "creating, changing and reading entities (Google Benchmark's flags)")
        ->prefix_command()
        ->callback([=, &status] { status = world(count - 1, arguments + 1); });
}

void add_shading(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("shading", "forward against deferred, and a still frame");
    const auto scene = std::make_shared<std::filesystem::path>();
    add_scene(part, *scene);
    part.callback([=, &status] { status = shading(*scene); });
}

void add_frames(CLI::App& app, int& status) {
    CLI::App& part =
        *app.add_subcommand("frames", "time of a frame after nothing, the camera or a light moved, and anew");
    const auto study = std::make_shared<FramesStudy>();
    const auto size = std::make_shared<std::string>("1920x1080");
    add_scene(part, study->scene);
    part.add_option("--size", *size, "WxH, pixels");
    part.add_option("--vpls", study->vpls, "these many, one after the other")->delimiter(',');
    part.add_option("--rounds", study->rounds, "after a first one that does not count")
        ->check(CLI::Range(1, 1000));
    part.callback([=, &status] {
        study->size = size_named(*size);
        status = frames(*study);
    });
}

void add_gather(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("gather", "interleaved gathering against asking all VPLs");
    const auto study = std::make_shared<GatherStudy>();
    const auto size = std::make_shared<std::string>("512x512");
    add_scene(part, study->scene);
    part.add_option("--size", *size, "WxH, pixels");
    part.add_option("--vpls", study->vpls, "these many, one after the other")->delimiter(',');
    part.add_option("--rounds", study->rounds, "after a first one that does not count")
        ->check(CLI::Range(1, 1000));
    part.callback([=, &status] {
        study->size = size_named(*size);
        status = gather(*study);
    });
}

void add_paths(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("paths", "all shading paths, and what their lists cost");
    const auto study = std::make_shared<PathStudy>();
    const auto names = std::make_shared<std::vector<std::string>>();
    add_scene(part, study->scene);
    part.add_option("--width", study->size.x, "pixels")->check(CLI::Range(1, 16384));
    part.add_option("--height", study->size.y, "pixels")->check(CLI::Range(1, 16384));
    part.add_option("--rounds", study->rounds, "after a first one that does not count")
        ->check(CLI::Range(1, 1000));
    part.add_option("--vpls", study->vpls, "0: direct light only");
    part.add_option("--paths", *names, "in this order; default: all")->delimiter(',');
    part.add_option("--csv", study->csv, "append the figures to this file");
    part.callback([=, &status] {
        if (!names->empty()) study->paths = paths_named(*names);
        status = paths(*study);
    });
}

void add_reference(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("reference", "trace what pictures are measured against");
    const auto study = std::make_shared<ReferenceStudy>();
    const auto size = std::make_shared<std::string>();
    add_scene(part, study->scene);
    part.add_option("--size", *size, "WxH, pixels")->required();
    part.add_option("--samples", study->samples, "paths a pixel, even")->required();
    part.add_option("--bounces", study->bounces, "of indirect light; default: any");
    part.add_option("--seed", study->seed);
    part.add_flag("--no-caustics", study->no_caustics,
                  "diffuse and rough surfaces see glossy ones as Lambertian, as in the renderer");
    part.add_option("--out", study->out, "the folder; left alone if it holds the same already")->required();
    part.callback([=, &status] {
        study->size = size_named(*size);
        status = reference(*study);
    });
}

void add_baseline(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("baseline", "error and time of the path tracer itself");
    const auto study = std::make_shared<BaselineStudy>();
    add_scene(part, study->scene);
    part.add_option("--reference", study->reference, "a folder that `reference` made")->required();
    part.add_option("--samples", study->samples, "paths a pixel: 1,4,16")->required()->delimiter(',');
    part.add_option("--rounds", study->rounds, "each with a seed of its own")->check(CLI::Range(1, 1000));
    part.callback([=, &status] { status = baseline(*study); });
}

void add_measure(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("measure", "error, work, memory and time of configurations");
    const auto study = std::make_shared<MeasureStudy>();
    add_scene(part, study->scene);
    part.add_option("--reference", study->reference, "a folder that `reference` made")->required();
    part.add_option("--points", study->points, R"(a file: [{"id": "...", "config": {...}, "seeds": [0]}])")
        ->required();
    part.add_option("--pictures", study->pictures, "the folder that pictures and heat maps go to")
        ->required();
    part.add_option("--rounds", study->rounds, "of times; 0: errors only")->check(CLI::Range(0, 1000));
    part.add_option("--beside", study->beside, "a scene that is timed in turns with this one");
    const auto context = std::make_shared<std::string>("egl");
    part.add_option("--context", *context, "default: egl")->check(CLI::IsMember({"egl", "osmesa"}));
    part.callback([=, &status] {
        study->context = *context == "egl" ? ContextKind::egl : ContextKind::osmesa;
        status = measure(*study);
    });
}

void add_animate(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("animate", "error and flicker over the frames of a script");
    const auto study = std::make_shared<AnimateStudy>();
    const auto size = std::make_shared<std::string>();
    const auto context = std::make_shared<std::string>("egl");
    part.add_option("SCRIPT", study->script, "a .json file, or the name of a shipped script")->required();
    part.add_option("--reference-dir", study->references, "the folder that keeps the frames' references")
        ->required();
    part.add_option("--points", study->points,
                    R"(as for `measure`; "fresh_seeds": true: another in each frame)")
        ->required();
    part.add_option("--size", *size, "WxH, pixels")->required();
    part.add_option("--samples", study->samples, "paths a pixel of the references, even")->required();
    part.add_option("--bounces", study->bounces, "of the references' indirect light; default: any");
    part.add_option("--seed", study->seed, "of the references");
    part.add_option("--frames", study->frames, "default: the script's")->check(CLI::Range(2, 100000));
    part.add_option("--context", *context, "default: egl")->check(CLI::IsMember({"egl", "osmesa"}));
    part.callback([=, &status] {
        study->size = size_named(*size);
        study->context = *context == "egl" ? ContextKind::egl : ContextKind::osmesa;
        status = animate(*study);
    });
}

void add_moves(CLI::App& app, int& status) {
    CLI::App& part =
        *app.add_subcommand("moves", "what a frame costs after nothing, the camera or a light moved");
    const auto study = std::make_shared<MovesStudy>();
    part.add_option("--vpls", study->vpls)->check(CLI::Range(1, 65536));
    part.add_option("--rounds", study->rounds, "after a first one that does not count")
        ->check(CLI::Range(1, 1000));
    part.callback([=, &status] { status = moves(*study); });
}

void add_edits(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("edits", "what a frame costs after meshes came, went or moved");
    const auto study = std::make_shared<EditsStudy>();
    part.add_option("--rounds", study->rounds, "of two edits each")->check(CLI::Range(1, 1000));
    part.add_option("--things", study->things, "in wide worlds of so many things each")
        ->check(CLI::Range(1, 10'000'000));
    part.callback([=, &status] { status = edits(*study); });
}

void add_start(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("start", "time from a renderer's constructor to its first picture");
    const auto study = std::make_shared<StartStudy>();
    const auto size = std::make_shared<std::string>("200x150");
    add_scene(part, study->scene);
    part.add_option("--size", *size, "WxH, pixels");
    part.add_option("--rounds", study->rounds)->check(CLI::Range(1, 1000));
    part.callback([=, &status] {
        study->size = size_named(*size);
        status = start(*study);
    });
}

void add_scale(CLI::App& app, int& status) {
    CLI::App& part =
        *app.add_subcommand("scale", "time and memory to load a scene and render its first frame");
    const auto study = std::make_shared<ScaleStudy>();
    const auto size = std::make_shared<std::string>("512x512");
    add_scene(part, study->scene);
    part.add_option("--size", *size, "WxH, pixels");
    part.callback([=, &status] {
        study->size = size_named(*size);
        status = scale(*study);
    });
}

void add_figures(CLI::App& app, int& status) {
    CLI::App& part = *app.add_subcommand("figures", "CPU time a frame of animated figures with skeletons");
    const auto study = std::make_shared<FigureStudy>();
    part.add_option("--figures", study->figures)->check(CLI::Range(1, 100000));
    part.add_flag("--own-clips", study->own_clips, "a clip for each figure");
    part.add_option("--rounds", study->rounds, "after a first one that does not count")
        ->check(CLI::Range(1, 100000));
    part.callback([=, &status] { status = figures(*study); });
}

void add_compare(CLI::App& app) {
    CLI::App& part =
        *app.add_subcommand("compare", "error of a picture against its reference, by every measure");
    const auto comparison = std::make_shared<Comparison>();
    part.add_option("PICTURE", comparison->picture, "linear radiance, .pfm or .exr")->required();
    part.add_option("REFERENCE", comparison->reference,
                    "the same view, as it should be: .pfm, .exr or a folder of `reference`, whose noise does "
                    "not count")
        ->required();
    part.add_option("--show", comparison->light, "the light of that folder: total, direct or indirect")
        ->check(CLI::IsMember({"total", "direct", "indirect"}));
    part.add_option("--mask", comparison->mask, ".pfm or .exr: pixels count where it is not 0");
    CLI::Option* const heat =
        part.add_option("--heat", comparison->heat, "write the pixels' relative errors as a .png");
    part.add_option("--scale", comparison->scale,
                    "the relative error that is brightest in the heat map; default: the largest")
        ->needs(heat);
    part.callback([=] { fmt::print("{}", compare(*comparison)); });
}

int run(int count, char** arguments) {
    CLI::App app("What Candela costs, and how far its light is from right", "candela-study");
    app.require_subcommand(1);
    int status = 0;
    add_graph(app, status, count, arguments);
    add_world(app, status, count, arguments);
    add_shading(app, status);
    add_frames(app, status);
    add_gather(app, status);
    add_paths(app, status);
    add_reference(app, status);
    add_baseline(app, status);
    add_measure(app, status);
    add_animate(app, status);
    add_moves(app, status);
    add_edits(app, status);
    add_start(app, status);
    add_scale(app, status);
    add_figures(app, status);
    add_compare(app);
    try {
        app.parse(count, arguments);
    } catch (const CLI::Success& text) {
        return app.exit(text);
    }
    return status;
}

}  // namespace

/// Exit status 2: invalid input or a runtime error; 3: no driver.
int main(int count, char** arguments) {
    try {
        return run(count, arguments);
    } catch (const ContextError& error) {
        fmt::print(stderr, "candela-study: {}\n", error.what());
        return 3;
    } catch (const std::exception& error) {
        fmt::print(stderr, "candela-study: {}\n", error.what());
        return 2;
    }
}
