#include "renderer/passes/forward.hpp"

#include "engine/graph/execute.hpp"
#include "renderer/passes/draw_scene.hpp"

namespace candela {

TextureHandle add_forward(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const Lighting& lighting,
                          ValueHandle<CameraView> view, glm::uvec2 size) {
    return graph.add("forward", [&](Pass& pass) {
        read_meshes(pass, scene);
        read_materials(pass, scene);
        read_lighting(pass, lighting);
        pass.read(view);
        const gl::Program& program = gpu.program({"mesh_surface.vert", "forward.frag"});
        const auto radiance =
            pass.write(graph.texture("radiance", {size, Format::rgba32f}), Usage::colour_target);
        const auto depth = pass.write(graph.texture("depth", {size, Format::depth32f}), Usage::depth_target);
        static_cast<void>(depth);  // nobody reads it
        pass.run([=, &gpu, &program](Execution& run) {
            begin_surfaces(gpu);
            bind_view(program, run.value(view), size);
            bind_lighting(gpu, run, program, lighting);
            draw_surfaces(gpu, run, scene, program);
        });
        return radiance;
    });
}

}  // namespace candela
