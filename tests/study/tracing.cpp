#include "tests/study/tracing.hpp"

#include "tests/study/bench.hpp"

namespace candela::study {
namespace {

/// Direct light is exact, whatever the number of samples for indirect light.
sandbox::Picture trace_fine_direct(const reference::Scene& scene, Entity camera, glm::uvec2 size) {
    const reference::Settings settings{
        .size = size * static_cast<unsigned>(fine_side), .samples = 2, .bounces = 0};
    return scaled_down(reference::trace(scene, camera, settings).direct, fine_side);
}

}  // namespace

std::string_view tracer_name() {
    return CANDELA_TRACER;
}

Reference trace_request(const World& world, const Request& request) {
    const reference::Scene scene(world);
    const Entity camera = first_camera(world);
    const reference::Settings settings{
        .size = request.size, .samples = request.samples, .bounces = request.bounces, .seed = request.seed};
    return {request, reference::trace(scene, camera, settings),
            trace_fine_direct(scene, camera, request.size)};
}

}  // namespace candela::study
