#include "renderer/passes/output/enlarge.hpp"

#include <candela/graph/execute.hpp>
#include "shaders/bindings.glsl"

namespace candela {

void add_enlarge(FrameGraph& graph, Gpu& gpu, const SmallPicture& picture, ValueHandle<Target> target,
                 TextureHandle out) {
    graph.add("enlarge", [&](Pass& pass) {
        pass.read(picture.colours, {Usage::sampled, UNIT_RADIANCE});
        pass.read(picture.depth, {Usage::sampled, UNIT_PICTURE_DEPTH});
        read_geometry(pass, picture.in_target);
        read_view(pass, picture.target_view);
        pass.read(target);
        const gl::Program& program = gpu.program({"output/fullscreen.vert", "output/enlarge.frag"});
        (void)pass.write(out, Usage::layer_target);
        pass.run([=, &gpu, &program](Execution& run) {
            const Target& to = run.value(target);
            gpu.set_target(to);
            gpu.draw_fullscreen(program, {{"target_origin", glm::vec2(to.origin)}});
        });
    });
}

}  // namespace candela
