#include "renderer/passes/output/tone_map.hpp"

#include <cmath>

#include <candela/graph/execute.hpp>
#include "shaders/bindings.glsl"

namespace candela {

Display display_of(const Configuration& configuration) {
    const ToneMapSettings& settings = configuration.tone_map;
    const bool light = shows_light(configuration.show);
    return {.exposure = light ? std::exp2(settings.exposure_ev) : 1.0F,
            .curve = settings.enabled && light,
            .encoded = settings.enabled && (light || configuration.show == Show::albedo),
            .opaque = settings.enabled};
}

void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, ValueHandle<Target> target,
                  TextureHandle picture, const Display& display) {
    graph.add("tone-map", [&](Pass& pass) {
        pass.read(radiance, {Usage::sampled, UNIT_RADIANCE});
        pass.read(target);
        pass.parameter(display);
        const gl::Program& program = tone_map_program(gpu);
        (void)pass.write(picture, Usage::layer_target);
        pass.run([=, &gpu, &program](Execution& run) {
            draw_tone_mapped(gpu, program, run.value(target), display);
        });
    });
}

void draw_tone_mapped(Gpu& gpu, const gl::Program& program, const Target& target, const Display& display) {
    gpu.set_target(target);
    gpu.draw_fullscreen(program, {{"target_origin", glm::vec2(target.origin)},
                                  {"target_size", glm::vec2(target.size)},
                                  {"exposure", display.exposure},
                                  {"curve", display.curve},
                                  {"encoded", display.encoded},
                                  {"opaque", display.opaque}});
}

const gl::Program& tone_map_program(Gpu& gpu) {
    return gpu.program({"output/fullscreen.vert", "output/tone_map.frag"});
}

}  // namespace candela
