#include "renderer/passes/inspect/inspect_range.hpp"

#include "shaders/bindings.glsl"

namespace candela {

BufferHandle<glm::vec2> add_inspect_range(FrameGraph& graph, Gpu& gpu, const Inspected& inspected,
                                          ValueHandle<Inspection> settings) {
    return graph.add("inspect-range", [&](Pass& pass) {
        read_inspected(pass, inspected);
        pass.read(settings);
        const gl::Program& program = inspecting_program(gpu, "inspect/inspect_range.comp", inspected);
        const auto ranges = pass.write(graph.buffer<glm::vec2>("inspected ranges", 1, Lifetime::persistent),
                                       {Usage::storage, BINDING_INSPECTED_RANGES});
        pass.run([=, &gpu, &program](Execution& run) {
            const Shown shown = shown_of(run, inspected, run.value(settings));
            if (shown.range) {
                return;
            }
            run.reserve(ranges, shown.texels.y + 1);
            const InspectedTexels texels(gpu, run, program, inspected, shown);
            program.set("from_zero", shown.mapping == Mapping::colour);
            program.set("finish", false);
            gpu.gl().DispatchCompute(shown.texels.y, 1, 1);
            gpu.gl().MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
            program.set("finish", true);
            gpu.gl().DispatchCompute(1, 1, 1);
        });
        return ranges;
    });
}

}  // namespace candela
