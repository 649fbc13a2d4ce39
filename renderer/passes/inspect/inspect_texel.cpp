#include "renderer/passes/inspect/inspect_texel.hpp"

#include "renderer/gpu/compute_steps.hpp"
#include "shaders/bindings.glsl"

namespace candela {

BufferHandle<glm::vec4> add_inspect_texel(FrameGraph& graph, Gpu& gpu, const Inspected& inspected,
                                          ValueHandle<Inspection> settings,
                                          ValueHandle<std::optional<glm::uvec2>> texel) {
    return graph.add("inspect-texel", [&](Pass& pass) {
        read_inspected(pass, inspected);
        pass.read(settings);
        pass.read(texel);
        const gl::Program& program = inspecting_program(gpu, "inspect/inspect_texel.comp", inspected);
        const auto values =
            pass.write(graph.buffer<glm::vec4>("inspected texel values", 2, Lifetime::persistent),
                       {Usage::storage, BINDING_INSPECTED_TEXEL});
        pass.run([=, &gpu, &program](Execution& run) {
            const std::optional<glm::uvec2>& wanted = run.value(texel);
            if (!wanted) return;
            const InspectedTexels texels(gpu, run, inspected, shown_of(run, inspected, run.value(settings)));
            ComputeSteps(gpu).run(program, {}, texels.uniforms() + gl::Uniforms{{"texel", *wanted}});
        });
        return values;
    });
}

}  // namespace candela
