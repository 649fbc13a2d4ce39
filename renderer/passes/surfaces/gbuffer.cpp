#include "renderer/passes/surfaces/gbuffer.hpp"

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {

Surfaces add_gbuffer(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const ViewData& view,
                     MaterialParts parts) {
    return graph.add("gbuffer", [&](Pass& pass) {
        pass.note(Workload::pixels);
        read_meshes(pass, scene);
        read_view(pass, view);
        const SurfacePrograms programs =
            surface_programs(gpu, scene, "surfaces/gbuffer.frag", material_variant(parts));
        const Surfaces out = write_geometry_and_material(graph, pass, view, parts);
        pass.run([=, &gpu](Execution& run) {
            gpu.clear_colour_and_depth();
            draw_surfaces(gpu, run, scene, programs, nearest_surfaces);
        });
        return out;
    });
}

}  // namespace candela
