#include "renderer/passes/output/tone_map.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/passes/output/exposure.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

std::uint32_t number_of(std::optional<ToneCurve> curve) {
    constexpr std::array numbers{TONE_CURVE_FILMIC, TONE_CURVE_NEUTRAL, TONE_CURVE_ACES};  // as in ToneCurve
    return curve ? numbers.at(static_cast<std::size_t>(*curve)) : TONE_CURVE_NONE;
}

/// The step between two colours that the bound framebuffer's first draw buffer tells apart; 0 if it has more
/// than 10 bits, as all floats have. Windows have 8 bits.
float colour_step(const gl::Functions& gl) {
    constexpr GLint most_bits = 10;
    GLint bits = 8;
    const GLenum buffer = gl::get_unsigned(gl, GL_DRAW_BUFFER0);
    // The buffers of a window have lower numbers.
    if (buffer >= GL_COLOR_ATTACHMENT0) {
        gl.GetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, buffer,
                                               GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE, &bits);
    }
    return bits > most_bits ? 0.0F : 1.0F / (std::exp2(static_cast<float>(bits)) - 1.0F);
}

/// To the bound framebuffer. With the texture at UNIT_RADIANCE and, if the exposure is automatic, what
/// find_exposure has written.
void draw(Gpu& gpu, const gl::Program& program, const Target& target, const Display& display) {
    gpu.draw_fullscreen(program, {{"target_origin", glm::vec2(target.origin)},
                                  {"target_size", glm::vec2(target.size)},
                                  {"exposure", display.exposure},
                                  {"curve", number_of(display.curve)},
                                  {"encoded", display.encoded},
                                  {"opaque", display.opaque},
                                  {"colour_step", display.encoded ? colour_step(gpu.gl()) : 0.0F}});
}

std::vector<std::string> stages_of_tone_map() {
    return {"output/fullscreen.vert", "output/tone_map.frag"};
}

std::vector<std::string> variant_of(const Display& display) {
    std::vector<std::string> defined;
    if (display.automatic) defined.emplace_back("AUTOMATIC");
    return defined;
}

using Exposure = std::optional<BufferHandle<glm::vec2>>;

Exposure add_exposure_of(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, const Display& display) {
    return display.automatic ? Exposure(add_exposure(graph, gpu, radiance)) : std::nullopt;
}

/// Declares what the pass reads. Returns its program.
const gl::Program& read_inputs(Pass& pass, Gpu& gpu, TextureHandle radiance, const Exposure& exposure,
                               const Display& display) {
    pass.read(radiance, {Usage::sampled, UNIT_RADIANCE});
    if (exposure) pass.read(*exposure, {Usage::storage, BINDING_EXPOSURE});
    pass.parameter(display);
    return gpu.program(stages_of_tone_map(), variant_of(display));
}

}  // namespace

Display display_of(const Configuration& configuration) {
    const ToneMapSettings& settings = configuration.tone_map;
    const bool light = shows_light(configuration.show);
    const bool mapped = settings.enabled && light;
    return {.exposure = light ? std::exp2(settings.exposure_ev) : 1.0F,
            .automatic = mapped && settings.automatic_exposure,
            .curve = mapped ? std::optional(settings.curve) : std::nullopt,
            .encoded = settings.enabled && (light || configuration.show == Show::albedo),
            .opaque = settings.enabled};
}

void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, ValueHandle<Target> target,
                  TextureHandle picture, const Display& display) {
    const Exposure exposure = add_exposure_of(graph, gpu, radiance, display);
    graph.add("tone-map", [&](Pass& pass) {
        const gl::Program& program = read_inputs(pass, gpu, radiance, exposure, display);
        pass.read(target);
        (void)pass.write(picture, Usage::layer_target);
        pass.run([=, &gpu, &program](Execution& run) {
            gpu.set_target(run.value(target));
            draw(gpu, program, run.value(target), display);
        });
    });
}

TextureHandle add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, glm::uvec2 size,
                           const Display& display) {
    const Exposure exposure = add_exposure_of(graph, gpu, radiance, display);
    return graph.add("tone-map", [&](Pass& pass) {
        pass.note(Workload::pixels);
        const gl::Program& program = read_inputs(pass, gpu, radiance, exposure, display);
        const Format format = display.encoded ? Format::rgba8 : Format::rgba32f;
        const TextureHandle picture =
            pass.write(graph.texture("picture", {size, format}), Usage::colour_target);
        pass.run([=, &gpu, &program](Execution&) { draw(gpu, program, {.size = size}, display); });
        return picture;
    });
}

void tone_map(Gpu& gpu, const Target& target, const Display& display) {
    gl::Buffer exposure;
    if (display.automatic) {
        exposure = gl::Buffer(gpu.device(), "exposure", exposure_values * sizeof(glm::vec2));
        exposure.bind_base(GL_SHADER_STORAGE_BUFFER, BINDING_EXPOSURE);
        find_exposure(gpu, gpu.programs().compiled({exposure_stage}, {}));
        gpu.gl().MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    gpu.set_target(target);
    draw(gpu, gpu.programs().compiled(stages_of_tone_map(), variant_of(display)), target, display);
}

}  // namespace candela
