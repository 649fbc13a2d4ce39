#include "renderer/passes/shading/emission.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {

TextureHandle add_emission(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const ViewData& view,
                           const ShadedSurfaces& surfaces) {
    return graph.add("emission", [&](Pass& pass) {
        read_surfaces(pass, scene);
        read_view(pass, view);
        pass.read(surfaces.depth, Usage::depth_target);
        const SurfacePrograms programs = surface_programs(gpu, "shading/emission.frag", {"EMISSION"});
        const TextureHandle radiance = pass.write(surfaces.radiance, Usage::colour_target);
        pass.run([=, &gpu](Execution& run) {
            gpu.gl().Enable(GL_DEPTH_TEST);
            begin_adding(gpu);
            draw_surfaces(gpu, run, scene, programs, [](const auto& group) { return group.emits; });
        });
        return radiance;
    });
}

}  // namespace candela
