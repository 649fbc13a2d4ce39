#include "renderer/passes/output/accumulate.hpp"

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "shaders/bindings.glsl"

namespace candela {
namespace {

/// The texture that has the mean.
struct KeptMean {
    ObjectId texture = 0;
    glm::uvec2 size{0};
    bool operator==(const KeptMean&) const = default;
};

}  // namespace

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
        const auto known = pass.update(graph.value<KeptMean>("kept mean"));
        pass.run([=, &gpu, &program](Execution& run) {
            // The texture stays when another graph takes it over, of which this pass has no result yet.
            const KeptMean now{run.object(mean), size};
            const KeptMean* const last = run.previous(known);
            const std::uint32_t before = last != nullptr && *last == now ? run.value(averaged) : 0;
            run.set(known, now);
            gpu.draw_fullscreen(program, {{"count", before + 1}},
                                {.blending = before > 0 ? gl::Blending::cover : gl::Blending::off});
        });
        return mean;
    });
}

}  // namespace candela
