#include "renderer/passes/shading/deferred.hpp"

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

constexpr std::uint32_t surfaces_an_invocation = 4;  // at most: shaders/shading/pixel_block.glsl

}  // namespace

TextureHandle add_deferred(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces, const Lighting& lighting,
                           const ViewData& view) {
    return graph.add("deferred", [&](Pass& pass) {
        pass.note(Workload::pixels);
        read_geometry_and_material(pass, surfaces);
        read_lighting(pass, lighting);
        read_view(pass, view);
        const gl::Limits& limits = gpu.device().limits();
        const gl::Program& program = gpu.program(
            {"shading/deferred.comp"}, block_variant(limits, surfaces, lighting_variant(limits, lighting)));
        const auto radiance = pass.write(graph.texture("radiance", {view.size, Format::rgba32f}),
                                         {Usage::storage, IMAGE_RADIANCE});
        pass.run([=, &gpu, &program](Execution& run) {
            const Groups blocks{groups(view.size.x, PIXEL_BLOCK), groups(view.size.y, PIXEL_BLOCK)};
            bind_lighting(gpu, lighting);
            ComputeSteps steps(gpu);
            for (const gl::Uniforms& part :
                 lighting_parts(gpu.device().limits(), run, lighting, surfaces_an_invocation)) {
                steps.run_rows(run, program, blocks, part);
            }
        });
        return radiance;
    });
}

}  // namespace candela
