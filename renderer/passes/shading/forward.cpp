#include "renderer/passes/shading/forward.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {

ShadedSurfaces add_forward(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const Lighting& lighting,
                           const ViewData& view, std::optional<TextureHandle> prepass_depth) {
    return graph.add("forward", [&](Pass& pass) {
        read_surfaces(pass, scene);
        read_lighting(pass, lighting);
        read_view(pass, view);
        const SurfacePrograms programs =
            surface_programs(gpu, "shading/forward.frag", lighting_variant(lighting));
        ShadedSurfaces out;
        out.radiance =
            pass.write(graph.texture("radiance", {view.size, Format::rgba32f}), Usage::colour_target);
        if (prepass_depth) {
            pass.read(*prepass_depth, Usage::depth_target);
            out.depth = *prepass_depth;
        } else {
            out.depth =
                pass.write(graph.texture("depth", {view.size, Format::depth32f}), Usage::depth_target);
        }
        pass.run([=, &gpu, after_prepass = prepass_depth.has_value()](Execution& run) {
            if (after_prepass) {
                begin_visible_surfaces(gpu);
            } else {
                begin_surfaces(gpu);
            }
            const LightingParts parts = lighting_parts(run, lighting);
            for (std::uint32_t part = 0; part < parts.count; ++part) {
                if (part == 1) {
                    begin_adding(gpu);
                }
                programs.each([&](const gl::Program& program) { begin_lighting_part(program, parts, part); });
                draw_surfaces(gpu, run, scene, programs);
            }
        });
        return out;
    });
}

}  // namespace candela
