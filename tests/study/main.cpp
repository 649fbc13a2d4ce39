#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string_view>

#include "tests/study/study.hpp"

namespace {

using namespace candela;
using namespace candela::study;

struct Choice {
    std::filesystem::path scene;
    PathStudy path_study;
    std::vector<std::string> path_names;
};

void add_scene(CLI::App& part, std::filesystem::path& scene) {
    part.add_option("SCENE", scene, "a .gltf or .glb file with a camera")
        ->required()
        ->check(CLI::ExistingFile);
}

ShadingPath path_named(const std::string& name) {
    for (const ShadingPath path : all_shading_paths) {
        if (to_string(path) == name) {
            return path;
        }
    }
    throw std::invalid_argument(fmt::format("--paths: '{}' is no shading path", name));
}

void add_path_flags(CLI::App& part, Choice& choice) {
    part.add_option("--width", choice.path_study.size.x, "pixels")->check(CLI::Range(1, 16384));
    part.add_option("--height", choice.path_study.size.y, "pixels")->check(CLI::Range(1, 16384));
    part.add_option("--rounds", choice.path_study.rounds, "after a first one that does not count")
        ->check(CLI::Range(1, 1000));
    part.add_option("--vpls", choice.path_study.vpls, "0: direct light only");
    part.add_option("--paths", choice.path_names, "in this order; default: all")->delimiter(',');
    part.add_option("--csv", choice.path_study.csv, "append the figures to this file");
}

int run_paths(Choice& choice) {
    choice.path_study.scene = choice.scene;
    if (!choice.path_names.empty()) {
        choice.path_study.paths.clear();
        for (const std::string& name : choice.path_names) {
            choice.path_study.paths.push_back(path_named(name));
        }
    }
    return paths(choice.path_study);
}

int run(int count, char** arguments) {
    CLI::App app("What Candela costs, and how far its light is from right", "candela-study");
    app.require_subcommand(1);
    Choice choice;
    CLI::App* const graph_part =
        app.add_subcommand("graph",
                           "declaring, compiling and running frame graphs (Google Benchmark's flags)")
            ->prefix_command();
    CLI::App* const shading_part =
        app.add_subcommand("shading", "forward against deferred, and a still frame");
    CLI::App* const bound_part =
        app.add_subcommand("bound", "error and bias for bounds of the geometry term");
    CLI::App* const paths_part = app.add_subcommand("paths", "all shading paths, and what their lists cost");
    add_scene(*shading_part, choice.scene);
    add_scene(*bound_part, choice.scene);
    add_scene(*paths_part, choice.scene);
    add_path_flags(*paths_part, choice);
    CLI11_PARSE(app, count, arguments);
    if (graph_part->parsed()) {
        return graph(count - 1, arguments + 1);
    }
    if (shading_part->parsed()) {
        return shading(choice.scene);
    }
    if (bound_part->parsed()) {
        return bound(choice.scene);
    }
    return run_paths(choice);
}

}  // namespace

int main(int count, char** arguments) {
    try {
        return run(count, arguments);
    } catch (const std::exception& error) {
        fmt::print(stderr, "candela-study: {}\n", error.what());
        return 1;
    }
}
