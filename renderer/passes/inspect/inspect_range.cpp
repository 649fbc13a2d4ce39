#include "renderer/passes/inspect/inspect_range.hpp"

#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "shaders/bindings.glsl"

namespace candela {

BufferHandle<glm::vec4> add_inspect_range(FrameGraph& graph, Gpu& gpu, const Inspected& inspected,
                                          ValueHandle<Inspection> settings) {
    return graph.add("inspect-range", [&](Pass& pass) {
        read_inspected(pass, inspected);
        pass.read(settings);
        const gl::Program& program = inspecting_program(gpu, "inspect/inspect_range.comp", inspected);
        const auto ranges = pass.write(growing_buffer<glm::vec4>(graph, "inspected ranges"),
                                       {Usage::storage, BINDING_INSPECTED_RANGES});
        pass.run([=, &gpu, &program](Execution& run) {
            const Shown shown = shown_of(run, inspected, run.value(settings));
            run.reserve(ranges, shown.texels.y + 2);
            const InspectedTexels texels(gpu, run, inspected, shown);
            const gl::Uniforms common =
                texels.uniforms() + gl::Uniforms{{"from_zero", shown.mapping == Mapping::colour}};
            ComputeSteps steps(gpu);
            steps.run(program, {shown.texels.y}, common + gl::Uniforms{{"finish", false}});
            steps.run(program, {}, common + gl::Uniforms{{"finish", true}});
        });
        return ranges;
    });
}

}  // namespace candela
