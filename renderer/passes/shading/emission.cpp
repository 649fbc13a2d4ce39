#include "renderer/passes/shading/emission.hpp"

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {

TextureHandle add_emission(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const ViewData& view,
                           const Surfaces& surfaces, TextureHandle radiance) {
    return graph.add("emission", [&](Pass& pass) {
        pass.note(Workload::pixels);
        read_meshes(pass, scene);
        read_view(pass, view);
        test_depth(pass, surfaces);
        const SurfacePrograms programs = surface_programs(gpu, scene, "shading/emission.frag", {"EMISSION"});
        const TextureHandle out = pass.write(radiance, Usage::colour_target);
        pass.run([=, &gpu](Execution& run) {
            draw_surfaces(gpu, run, scene, programs, visible_surfaces_again, {},
                          [](const auto& group) { return group.material->emits; });
        });
        return out;
    });
}

}  // namespace candela
