#include <fmt/format.h>
#include <cstdio>
#include <exception>
#include <string_view>

#include "tests/study/study.hpp"

namespace {

constexpr const char* usage =
    "usage: candela-study graph [BENCHMARK FLAGS]   cost of declaring, compiling and running frame graphs\n"
    "       candela-study shading SCENE.gltf        forward against deferred shading, and a still frame\n"
    "       candela-study bound SCENE.gltf          error and bias for bounds of the geometry term\n";

int run(int count, char** arguments) {
    const std::string_view part = count > 1 ? arguments[1] : "";
    if (part == "graph") {
        return candela::study::graph(count - 1, arguments + 1);
    }
    if (part == "shading" && count == 3) {
        return candela::study::shading(arguments[2]);
    }
    if (part == "bound" && count == 3) {
        return candela::study::bound(arguments[2]);
    }
    fmt::print(stderr, "{}", usage);
    return 2;
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
