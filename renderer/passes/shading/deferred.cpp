#include "renderer/passes/shading/deferred.hpp"

#include <candela/graph/execute.hpp>
#include "shaders/bindings.glsl"

namespace candela {

TextureHandle add_deferred(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces, const Lighting& lighting,
                           const ViewData& view) {
    return graph.add("deferred", [&](Pass& pass) {
        read_geometry_and_material(pass, surfaces);
        read_lighting(pass, lighting);
        read_view(pass, view);
        const gl::Program& program = gpu.program({"shading/deferred.comp"}, lighting_variant(lighting));
        const auto radiance = pass.write(graph.texture("radiance", {view.size, Format::rgba32f}),
                                         {Usage::storage, IMAGE_RADIANCE});
        pass.run([=, &gpu, &program](Execution& run) {
            const gl::Functions& gl = gpu.gl();
            program.use();
            const LightingParts parts = lighting_parts(run, lighting);
            for (std::uint32_t part = 0; part < parts.count; ++part) {
                if (part > 0) {
                    gl.MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
                }
                begin_lighting_part(program, parts, part);
                gl.DispatchCompute(groups(view.size.x, PIXEL_BLOCK), groups(view.size.y, PIXEL_BLOCK), 1);
            }
        });
        return radiance;
    });
}

}  // namespace candela
