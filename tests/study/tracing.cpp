#include "tests/study/tracing.hpp"

#include <algorithm>

#include "tests/study/bench.hpp"

namespace candela::study {
namespace {

/// Direct light of points and directions is exact; that of surfaces is sampled, with as many samples per
/// pixel as at its centre.
tools::Picture trace_fine_direct(const reference::Scene& scene, Entity camera, const Request& request) {
    constexpr unsigned points = fine_side * fine_side;
    const unsigned samples = std::max(request.samples / points / 2 * 2, 2U);  // even
    const reference::Settings settings{
        .size = request.size * static_cast<unsigned>(fine_side), .samples = samples, .bounces = 0};
    return scaled_down(reference::trace(scene, camera, settings).direct, fine_side);
}

}  // namespace

std::string_view tracer_name() {
    return CANDELA_TRACER;
}

Reference trace_request(const World& world, const Request& request) {
    const reference::Scene scene(world);
    const Entity camera = first_camera(world);
    const reference::Settings settings{.size = request.size,
                                       .samples = request.samples,
                                       .bounces = request.bounces,
                                       .seed = request.seed,
                                       .caustics = request.caustics};
    return {request, reference::trace(scene, camera, settings), trace_fine_direct(scene, camera, request)};
}

}  // namespace candela::study
