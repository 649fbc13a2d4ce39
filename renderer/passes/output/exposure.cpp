#include "renderer/passes/output/exposure.hpp"

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/gpu/compute_steps.hpp"

namespace candela {

BufferHandle<glm::vec2> add_exposure(FrameGraph& graph, Gpu& gpu, TextureHandle radiance) {
    return graph.add("exposure", [&](Pass& pass) {
        pass.note(Workload::pixels);
        pass.read(radiance, {Usage::sampled, UNIT_RADIANCE});
        const gl::Program& program = gpu.program({exposure_stage});
        // Kept while the radiance does not change.
        const auto exposure =
            pass.write(graph.buffer<glm::vec2>("exposure", exposure_values, Lifetime::persistent),
                       {Usage::storage, BINDING_EXPOSURE});
        pass.run([&gpu, &program](Execution& /*run*/) { find_exposure(gpu, program); });
        return exposure;
    });
}

void find_exposure(Gpu& gpu, const gl::Program& program) {
    ComputeSteps steps(gpu);
    steps.run(program, {EXPOSURE_GROUPS}, {{"finish", false}});
    steps.run(program, {}, {{"finish", true}});
}

}  // namespace candela
