#include "renderer/passes/inspect/inspect_histogram.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/gpu/compute_steps.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

/// Texels from one that counts to the next, so that about so many do: more would hold up software drivers.
std::uint32_t between(glm::uvec2 texels) {
    constexpr double most = 1 << 20;
    const double all = static_cast<double>(texels.x) * static_cast<double>(texels.y);
    return static_cast<std::uint32_t>(std::max(std::ceil(std::sqrt(all / most)), 1.0));
}

}  // namespace

BufferHandle<std::uint32_t> add_inspect_histogram(FrameGraph& graph, Gpu& gpu, const Inspected& inspected,
                                                  ValueHandle<Inspection> settings,
                                                  BufferHandle<glm::vec4> ranges) {
    return graph.add("inspect-histogram", [&](Pass& pass) {
        read_inspected(pass, inspected);
        pass.read(settings);
        pass.read(ranges, {Usage::storage, BINDING_INSPECTED_RANGES});
        const gl::Program& program = inspecting_program(gpu, "inspect/inspect_histogram.comp", inspected);
        const auto counts = pass.write(
            graph.buffer<std::uint32_t>("inspected histogram", 3 * INSPECT_BINS, Lifetime::persistent),
            {Usage::storage, BINDING_INSPECTED_HISTOGRAM});
        pass.run([=, &gpu, &program](Execution& run) {
            const Shown shown = shown_of(run, inspected, run.value(settings));
            const InspectedTexels texels(gpu, run, inspected, shown);
            const ValueRange range = shown.range.value_or(ValueRange{});
            const std::uint32_t step = between(shown.texels);
            const gl::Uniforms common =
                texels.uniforms() + gl::Uniforms{{"between", step},
                                                 {"automatic_range", !shown.range},
                                                 {"chosen_range", glm::vec2(range.low, range.high)}};
            ComputeSteps steps(gpu);
            steps.run(program, {}, common + gl::Uniforms{{"clear", true}});
            steps.run(program, {groups(shown.texels.y, step)}, common + gl::Uniforms{{"clear", false}});
        });
        return counts;
    });
}

}  // namespace candela
