#include "renderer/passes/output/tone_map.hpp"

#include <cmath>

#include <candela/graph/execute.hpp>
#include "shaders/bindings.glsl"

namespace candela {

void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, ValueHandle<Target> target,
                  TextureHandle picture, const ToneMapSettings& settings) {
    graph.add("tone-map", [&](Pass& pass) {
        pass.read(radiance, {Usage::sampled, UNIT_RADIANCE});
        pass.read(target);
        pass.parameter(settings);
        const gl::Program& program = tone_map_program(gpu);
        (void)pass.write(picture, Usage::layer_target);
        pass.run([=, &gpu, &program](Execution& run) {
            draw_tone_mapped(gpu, program, run.value(target), settings);
        });
    });
}

void draw_tone_mapped(const Gpu& gpu, const gl::Program& program, const Target& target,
                      const ToneMapSettings& settings) {
    const glm::ivec2 origin(target.origin);
    const glm::ivec2 size(target.size);
    gpu.gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
    gpu.gl().Viewport(origin.x, origin.y, size.x, size.y);
    program.set("target_origin", glm::vec2(origin));
    program.set("target_size", glm::vec2(size));
    program.set("exposure", std::exp2(settings.exposure_ev));
    program.set("curve", settings.enabled);
    gpu.draw_fullscreen(program);
}

const gl::Program& tone_map_program(Gpu& gpu) {
    return gpu.program({"output/fullscreen.vert", "output/tone_map.frag"});
}

}  // namespace candela
