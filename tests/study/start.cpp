#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <candela/headless_context.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/gltf.hpp>
#include "renderer/facade/device_of.hpp"
#include "tests/compilations.hpp"
#include "tests/study/bench.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

namespace fs = std::filesystem;

/// How a renderer starts.
enum class StartKind : std::uint8_t { plain, cached, prepared };
struct NamedStart {
    StartKind kind;
    std::string_view name;
};
constexpr std::array<NamedStart, 3> starts{{{StartKind::plain, "without cache"},
                                            {StartKind::cached, "program cache"},
                                            {StartKind::prepared, "prepared"}}};

/// A world that a renderer starts with.
struct StartedWorld {
    std::string_view name;
    World world;
    Entity camera;
};

/// Milliseconds.
struct StartTimes {
    double constructor = 0.0;
    double prepare = 0.0;
    double frame = 0.0;
    ProgramCounts programs;
};

class Stopwatch {
 public:
    /// Milliseconds since the last call, or since the construction.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count();
    }

 private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// A renderer in a context of its own, until the GPU has drawn its first picture.
StartTimes start_once(const StartedWorld& started, glm::uvec2 pixels, StartKind kind, const fs::path& cache) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    static_cast<void>(Compilations::take());
    StartTimes times;
    Stopwatch watch;
    Renderer renderer(Compilations::counting(context->get_proc()),
                      {.program_cache = kind == StartKind::cached ? cache.string() : std::string()});
    times.constructor = watch.lap();
    const gl::Texture target(device_of(renderer), "target", {.size = pixels});
    gl::Framebuffer framebuffer(device_of(renderer), "target");
    framebuffer.attach_colour(0, target.name());
    framebuffer.draw_buffers(1);
    const RenderView view{.camera = started.camera, .target = {framebuffer.name(), pixels}};
    static_cast<void>(watch.lap());
    if (kind == StartKind::prepared) {
        const auto errors = renderer.prepare(renderer.configuration(), started.world, {&view, 1});
        if (!errors.empty()) throw std::runtime_error(errors.front());
        times.prepare = watch.lap();
    }
    renderer.render(started.world, {&view, 1});
    device_of(renderer).finish();
    times.frame = watch.lap();
    times.programs = Compilations::take();
    return times;
}

/// A process of its own for each start: Mesa opens its cache of shaders once per process.
StartTimes in_another_process(const std::function<StartTimes()>& measure_start) {
    std::array<int, 2> pipe_ends{};
    if (::pipe(pipe_ends.data()) != 0) throw std::runtime_error("there is no pipe to another process");
    const pid_t child = ::fork();
    if (child == 0) {
        bool written = false;
        try {
            const StartTimes times = measure_start();
            written = ::write(pipe_ends[1], &times, sizeof(times)) == sizeof(times);
        } catch (const std::exception& error) {
            fmt::print(stderr, "{}\n", error.what());
        }
        std::_Exit(written ? 0 : 1);
    }
    ::close(pipe_ends[1]);
    StartTimes times;
    const bool complete = child > 0 && ::read(pipe_ends[0], &times, sizeof(times)) == sizeof(times);
    ::close(pipe_ends[0]);
    if (child > 0) ::waitpid(child, nullptr, 0);
    if (!complete) throw std::runtime_error("a renderer did not start");
    return times;
}

double median_of(const std::vector<StartTimes>& measured, double StartTimes::*time) {
    std::vector<double> values;
    for (const StartTimes& each : measured) values.push_back(each.*time);
    return median(std::move(values));
}

void print_start(std::string_view world, std::string_view how, const std::vector<StartTimes>& measured) {
    const double constructor = median_of(measured, &StartTimes::constructor);
    const double prepare = median_of(measured, &StartTimes::prepare);
    const double frame = median_of(measured, &StartTimes::frame);
    fmt::print("{:<8} {:<14} {:>11.0f} {:>8.0f} {:>12.0f} {:>6.0f} {:>9} {:>7}\n", world, how, constructor,
               prepare, frame, constructor + prepare + frame, measured.back().programs.linked,
               measured.back().programs.loaded);
}

StartedWorld empty_world() {
    StartedWorld empty{.name = "empty", .world = {}, .camera = {}};
    empty.camera = empty.world.create();
    empty.world.set(empty.camera, Transform{});
    empty.world.set(empty.camera, Camera{});
    return empty;
}

StartedWorld world_of(const fs::path& scene) {
    StartedWorld read{.name = "scene", .world = {}, .camera = {}};
    static_cast<void>(import_gltf(scene, read.world));
    read.camera = first_camera(read.world);
    return read;
}

/// A folder for caches, removed at the end.
class CacheFolder {
 public:
    CacheFolder() : path_(fs::temp_directory_path() / fmt::format("candela-start-{}", ::getpid())) {
        fs::create_directories(path_);
    }
    CacheFolder(const CacheFolder&) = delete;
    CacheFolder& operator=(const CacheFolder&) = delete;
    ~CacheFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }

    /// Starts with an empty cache of Mesa's, which is not switched off, because Mesa would then give no
    /// programs away.
    StartTimes start(const StartedWorld& started, glm::uvec2 pixels, StartKind kind) {
        const fs::path of_mesa = path_ / fmt::format("mesa-{}", starts_++);
        ::setenv("MESA_SHADER_CACHE_DIR", of_mesa.c_str(), 1);
        const StartTimes times =
            in_another_process([&] { return start_once(started, pixels, kind, path_ / "programs"); });
        fs::remove_all(of_mesa);
        return times;
    }

 private:
    fs::path path_;
    int starts_ = 0;
};

}  // namespace

int start(const StartStudy& study) {
    std::vector<StartedWorld> worlds;
    worlds.push_back(empty_world());
    worlds.push_back(world_of(study.scene));
    CacheFolder caches;
    for (const StartedWorld& each : worlds) caches.start(each, study.size, StartKind::cached);

    std::array<std::array<std::vector<StartTimes>, starts.size()>, 2> times;
    for (int round = 0; round < study.rounds; ++round) {
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            for (std::size_t j = 0; j < starts.size(); ++j) {
                times.at(i).at(j).push_back(caches.start(worlds[i], study.size, starts.at(j).kind));
            }
        }
    }
    fmt::print("start of a renderer, milliseconds, medians of {} rounds\n", study.rounds);
    fmt::print("{:<8} {:<14} {:>11} {:>8} {:>12} {:>6} {:>9} {:>7}\n", "world", "start", "constructor",
               "prepare", "first frame", "sum", "compiled", "loaded");
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        for (std::size_t j = 0; j < starts.size(); ++j) {
            print_start(worlds[i].name, starts.at(j).name, times.at(i).at(j));
        }
    }
    return 0;
}

}  // namespace candela::study
