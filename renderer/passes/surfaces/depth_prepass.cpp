#include "renderer/passes/surfaces/depth_prepass.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {

Surfaces add_depth_prepass(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const ViewData& view) {
    return graph.add("depth-prepass", [&](Pass& pass) {
        pass.note(view.workload);
        read_meshes(pass, scene);
        read_view(pass, view);
        const SurfacePrograms programs =
            surface_programs(gpu, scene, "surfaces/depth_prepass.frag", {"WITH_NORMALS"});
        const Surfaces out = write_geometry(graph, pass, view);
        pass.run([=, &gpu](Execution& run) {
            gpu.clear_colour_and_depth();
            draw_surfaces(gpu, run, scene, programs, nearest_surfaces);
        });
        return out;
    });
}

}  // namespace candela
