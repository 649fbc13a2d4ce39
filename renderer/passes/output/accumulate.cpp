#include "renderer/passes/output/accumulate.hpp"

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "shaders/bindings.glsl"

namespace candela {

TextureHandle add_accumulate(FrameGraph& graph, Gpu& gpu, TextureHandle radiance,
                             ValueHandle<std::uint32_t> averaged, glm::uvec2 size) {
    const TextureHandle blank = graph.texture("mean radiance", {size, Format::rgba32f}, Lifetime::persistent);
    return graph.add("accumulate", [&](Pass& pass) {
        pass.note(Workload::pixels);
        pass.read(radiance, {Usage::sampled, UNIT_RADIANCE});
        pass.read(averaged);
        const gl::Program& program = gpu.program({"output/fullscreen.vert", "output/accumulate.frag"});
        pass.keeps_state();
        const TextureHandle mean = pass.update(blank, Usage::colour_target);
        pass.run([=, &gpu, &program](Execution& run) {
            const std::uint32_t before = run.has_result() ? run.value(averaged) : 0;
            gpu.draw_fullscreen(program, {{"count", before + 1}},
                                {.blending = before > 0 ? gl::Blending::mean : gl::Blending::off});
        });
        return mean;
    });
}

}  // namespace candela
