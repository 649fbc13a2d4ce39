#include "renderer/passes/output/tone_map.hpp"

#include <cmath>

#include <candela/graph/execute.hpp>
#include "shaders/bindings.glsl"

namespace candela {

void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, TextureHandle target, glm::uvec2 size,
                  const ToneMapSettings& settings) {
    graph.add("tone-map", [&](Pass& pass) {
        pass.read(radiance, {Usage::sampled, UNIT_RADIANCE});
        pass.parameter(settings);
        const gl::Program& program = tone_map_program(gpu);
        const TextureHandle written = pass.write(target, Usage::layer_target);
        pass.run([=, &gpu, &program](Execution& run) {
            draw_tone_mapped(gpu, program, run.object(written), size, settings);
        });
    });
}

void draw_tone_mapped(const Gpu& gpu, const gl::Program& program, GLuint framebuffer, glm::uvec2 size,
                      const ToneMapSettings& settings) {
    gpu.gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    gpu.gl().Viewport(0, 0, static_cast<GLsizei>(size.x), static_cast<GLsizei>(size.y));
    program.set("target_size", glm::vec2(size));
    program.set("exposure", std::exp2(settings.exposure_ev));
    program.set("curve", settings.enabled);
    gpu.draw_fullscreen(program);
}

const gl::Program& tone_map_program(Gpu& gpu) {
    return gpu.program({"output/fullscreen.vert", "output/tone_map.frag"});
}

}  // namespace candela
