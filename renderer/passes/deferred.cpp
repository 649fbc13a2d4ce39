#include "renderer/passes/deferred.hpp"

#include "engine/graph/execute.hpp"

namespace candela {

TextureHandle add_deferred(FrameGraph& graph, Gpu& gpu, const Gbuffer& gbuffer, const Lighting& lighting,
                           ValueHandle<CameraView> view, glm::uvec2 size) {
    return graph.add("deferred", [&](Pass& pass) {
        pass.read(gbuffer.albedo, Usage::sampled);
        pass.read(gbuffer.normal, Usage::sampled);
        pass.read(gbuffer.depth, Usage::sampled);
        read_lighting(pass, lighting);
        pass.read(view);
        const gl::Program& program = gpu.program({"fullscreen.vert", "deferred.frag"});
        const auto radiance = pass.write(graph.texture("radiance", {size, Format::rgba32f}), Usage::colour_target);
        pass.run([=, &gpu, &program](Execution& run) {
            gpu.gl().BindTextureUnit(UNIT_ALBEDO, run.object(gbuffer.albedo));
            gpu.gl().BindTextureUnit(UNIT_NORMAL, run.object(gbuffer.normal));
            gpu.gl().BindTextureUnit(UNIT_DEPTH, run.object(gbuffer.depth));
            gpu.gl().ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
            gpu.gl().Clear(GL_COLOR_BUFFER_BIT);
            bind_view(program, run.value(view), size);
            bind_lighting(gpu, run, program, lighting);
            gpu.draw_fullscreen(program);
        });
        return radiance;
    });
}

}  // namespace candela
