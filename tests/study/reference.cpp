#include <fmt/format.h>

#include "sandbox/scene/scene.hpp"
#include "tests/study/reference_files.hpp"
#include "tests/study/scene_hash.hpp"
#include "tests/study/study.hpp"
#include "tests/study/tracing.hpp"

namespace candela::study {

int reference(const ReferenceStudy& study) {
    const Request request{.scene_hash = scene_hash(study.scene),
                          .tracer = std::string(tracer_name()),
                          .size = study.size,
                          .samples = study.samples,
                          .bounces = study.bounces,
                          .seed = study.seed,
                          .caustics = !study.no_caustics};
    if (holds(study.out, request)) {
        fmt::print("{}: holds this reference already\n", study.out.string());
        return 0;
    }
    const Reference traced = trace_request(sandbox::load_scene(study.scene).world, request);
    write_reference(study.out, study.scene.filename().string(), traced);
    const Noise of_halves = noise(traced.estimate);
    fmt::print("{}: {} samples a pixel in {:.1f} s; relMSE of its noise {:.1e} (indirect), {:.1e} (total)\n",
               study.out.string(), study.samples, traced.estimate.seconds, of_halves.indirect,
               of_halves.total);
    return 0;
}

}  // namespace candela::study
