#include "renderer/passes/output/enlarge.hpp"

#include <candela/graph/execute.hpp>
#include "shaders/bindings.glsl"

namespace candela {
namespace {

TextureHandle add_weights(FrameGraph& graph, Gpu& gpu, const SmallPicture& picture) {
    return graph.add("enlarge-weights", [&](Pass& pass) {
        pass.read(picture.depth, {Usage::sampled, UNIT_PICTURE_DEPTH});
        read_geometry(pass, picture.in_target);
        read_view(pass, picture.target_view);
        const gl::Program& program = gpu.program({"output/fullscreen.vert", "output/enlarge_weights.frag"});
        const TextureDesc desc{picture.target_view.size, Format::rgba8};
        const TextureHandle weights =
            pass.write(graph.texture("enlarge weights", desc), Usage::colour_target);
        pass.run([&gpu, &program](Execution&) { gpu.draw_fullscreen(program, {}); });
        return weights;
    });
}

}  // namespace

void add_enlarge(FrameGraph& graph, Gpu& gpu, const SmallPicture& picture, ValueHandle<Target> target,
                 TextureHandle out) {
    const TextureHandle weights = add_weights(graph, gpu, picture);
    graph.add("enlarge", [&](Pass& pass) {
        pass.read(picture.colours, {Usage::sampled, UNIT_RADIANCE});
        pass.read(weights, {Usage::sampled, UNIT_PICTURE_WEIGHTS});
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
