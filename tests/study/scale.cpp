#include <sys/resource.h>
#include <chrono>

#include <candela/headless_context.hpp>
#include <candela/scene/gltf.hpp>
#include "tests/study/bench.hpp"
#include "tests/study/json_line.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The largest resident memory of this process so far, in bytes.
std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

int scale(const ScaleStudy& study) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    World world;
    const auto start = std::chrono::steady_clock::now();
    const ImportReport report = import_gltf(study.scene, world);
    const double load_s = seconds_since(start);
    Bench bench(context->get_proc(), world, study.size);
    Configuration configuration;
    configuration.path = ShadingPath::clustered_deferred;  // for any number of lights
    bench.configure(configuration);
    const double frame_ms = bench.frame({});
    print_line({{"scene", study.scene.filename().string()},
                {"entities", report.entities.size()},
                {"triangles", report.triangles},
                {"load_s", load_s},
                {"frame_s", frame_ms / 1000.0},
                {"peak_bytes", peak_memory()}});
    return 0;
}

}  // namespace candela::study
