#include "renderer/passes/inspect/inspect.hpp"

#include "renderer/gpu/compute_steps.hpp"
#include "shaders/bindings.glsl"

namespace candela {

TextureHandle add_inspect(FrameGraph& graph, Gpu& gpu, const Inspected& inspected,
                          ValueHandle<Inspection> settings, BufferHandle<glm::vec4> ranges) {
    constexpr std::uint32_t side = 8;  // of a work group, as in the shader
    return graph.add("inspect", [&](Pass& pass) {
        read_inspected(pass, inspected);
        pass.read(settings);
        pass.read(ranges, {Usage::storage, BINDING_INSPECTED_RANGES});
        const gl::Program& program = inspecting_program(gpu, "inspect/inspect.comp", inspected);
        const auto picture =
            pass.write(graph.texture("inspected picture", {{1, 1}, Format::rgba8}, Lifetime::persistent),
                       {Usage::storage, IMAGE_INSPECTED});
        pass.run([=, &gpu, &program](Execution& run) {
            const Shown shown = shown_of(run, inspected, run.value(settings));
            run.reserve(picture, {shown.picture, Format::rgba8});
            const InspectedTexels texels(gpu, run, inspected, shown);
            const ValueRange range = shown.range.value_or(ValueRange{});
            const gl::Uniforms mapped{{"extent", shown.extent},
                                      {"texel_size", shown.texel_size},
                                      {"mapping", static_cast<std::uint32_t>(shown.mapping)},
                                      {"automatic_range", !shown.range},
                                      {"chosen_range", glm::vec2(range.low, range.high)}};
            ComputeSteps(gpu).run(program, {groups(shown.picture.x, side), groups(shown.picture.y, side)},
                                  texels.uniforms() + mapped);
        });
        return picture;
    });
}

}  // namespace candela
