#include "renderer/passes/deferred.hpp"

#include "engine/graph/execute.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

// Pixels along an edge of the block that a work group shades: PIXEL_BLOCK in shaders/bindings.glsl.
constexpr std::uint32_t tile_size = 16;

}  // namespace

TextureHandle add_deferred(FrameGraph& graph, Gpu& gpu, const Gbuffer& gbuffer, const Lighting& lighting,
                           const FrameView& view, glm::uvec2 size) {
    return graph.add("deferred", [&](Pass& pass) {
        pass.read(gbuffer.albedo, Usage::sampled);
        pass.read(gbuffer.normal, Usage::sampled);
        pass.read(gbuffer.depth, Usage::sampled);
        read_lighting(pass, lighting);
        read_view(pass, view);
        const gl::Program& program = gpu.program({"deferred.comp"}, lighting_variant(lighting));
        const auto radiance = pass.write(graph.texture("radiance", {size, Format::rgba32f}), Usage::storage);
        pass.run([=, &gpu, &program](Execution& run) {
            const gl::Functions& gl = gpu.gl();
            gl.BindTextureUnit(UNIT_ALBEDO, run.object(gbuffer.albedo));
            gl.BindTextureUnit(UNIT_NORMAL, run.object(gbuffer.normal));
            gl.BindTextureUnit(UNIT_DEPTH, run.object(gbuffer.depth));
            gl.BindImageTexture(IMAGE_RADIANCE, run.object(radiance), 0, GL_FALSE, 0, GL_READ_WRITE,
                                GL_RGBA32F);
            bind_view(gpu, run, view);
            bind_lighting(gpu, run, program, lighting);
            program.use();
            for (std::uint32_t part = 0; part < lighting_parts(run, lighting); ++part) {
                if (part > 0) {
                    gl.MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
                    begin_lighting_part(program, part);
                }
                gl.DispatchCompute((size.x + tile_size - 1) / tile_size, (size.y + tile_size - 1) / tile_size,
                                   1);
            }
        });
        return radiance;
    });
}

}  // namespace candela
