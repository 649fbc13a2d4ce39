#include "renderer/passes/shading/forward.hpp"

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {

ForwardResults add_forward(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const Lighting& lighting,
                           const ViewData& view, const Surfaces& surfaces) {
    return graph.add("forward", [&](Pass& pass) {
        pass.note(Workload::pixels);
        read_meshes(pass, scene);
        read_lighting(pass, lighting);
        read_view(pass, view);
        const SurfacePrograms programs = surface_programs(gpu, scene, "shading/forward.frag",
                                                          lighting_variant(gpu.device().limits(), lighting));
        ForwardResults out{.surfaces = surfaces,
                           .radiance = pass.write(graph.texture("radiance", {view.size, Format::rgba32f}),
                                                  Usage::colour_target)};
        if (surfaces.depth) {
            test_depth(pass, surfaces);
        } else {
            out.surfaces.depth = write_depth(graph, pass, view);
        }
        pass.run([=, &gpu, after_prepass = surfaces.depth.has_value()](Execution& run) {
            if (after_prepass) {
                gpu.clear_colour();
            } else {
                gpu.clear_colour_and_depth();
            }
            bind_lighting(gpu, lighting);
            gl::RasterState state = after_prepass ? visible_surfaces : nearest_surfaces;
            for (const gl::Uniforms& part : lighting_parts(gpu.device().limits(), run, lighting, 1)) {
                draw_surfaces(gpu, run, scene, programs, state, part);
                state = visible_surfaces_again;
            }
        });
        return out;
    });
}

}  // namespace candela
