#include "renderer/passes/surfaces/gbuffer.hpp"

#include <candela/graph/execute.hpp>
#include "renderer/passes/surfaces/draw_scene.hpp"

namespace candela {

Gbuffer write_gbuffer(FrameGraph& graph, Pass& pass, glm::uvec2 size) {
    return {.albedo = pass.write(graph.texture("albedo", {size, Format::rgba16f}), Usage::colour_target),
            .normal = pass.write(graph.texture("normal", {size, Format::rg32f}), Usage::colour_target),
            .depth = pass.write(graph.texture("depth", {size, Format::depth32f}), Usage::depth_target)};
}

Gbuffer add_gbuffer(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const ViewData& view) {
    return graph.add("gbuffer", [&](Pass& pass) {
        read_surfaces(pass, scene);
        read_view(pass, view);
        const SurfacePrograms programs = surface_programs(gpu, "surfaces/gbuffer.frag");
        const Gbuffer out = write_gbuffer(graph, pass, view.size);
        pass.run([=, &gpu](Execution& run) {
            begin_surfaces(gpu);
            draw_surfaces(gpu, run, scene, programs);
        });
        return out;
    });
}

}  // namespace candela
