#include "renderer/passes/vpls/vpl_maps.hpp"

#include <optional>
#include <vector>

#include <candela/graph/execute.hpp>

namespace candela {
namespace {

TextureDesc atlas_desc(const VplAtlas& atlas) {
    return {{atlas.side, atlas.side}, Format::depth32f, TextureShape::array, atlas.layers};
}

/// Identifies the stored maps: the atlas and its GL texture, the set of surfels, and the step of scene motion
/// up to which the maps are current.
struct DrawnAtlas {
    VplAtlas atlas;
    ObjectId object = 0;
    std::uint64_t set = 0;
    std::uint64_t step = 0;
    bool operator==(const DrawnAtlas&) const = default;
};

/// Resources of the node.
struct MapNode {
    Tracing tracing;
    MappedVpls vpls;
    VplCommon common;
    TextureHandle depth;
    ValueHandle<DrawnAtlas> drawn;
    const gl::Program* program;
};

/// Draws the texels whose rays pass through the boxes in `changed`; all texels without a value: see
/// changed_boxes.
void draw_maps(Gpu& gpu, Execution& run, const MapNode& node, const DrawnAtlas& target,
               const std::optional<std::vector<Box>>& changed) {
    const gl::Functions& gl = gpu.gl();
    gl::Framebuffer& layers = gpu.layer_target();
    layers.attach_depth(target.object);
    layers.bind();
    const auto side = static_cast<GLsizei>(target.atlas.side);
    gl.Viewport(0, 0, side, side);
    if (!changed) {
        const float nothing = 0.0F;
        gl.ClearBufferfv(GL_DEPTH, 0, &nothing);
    }
    set_changed_boxes(*node.program, changed, 4.0F * run.value(node.tracing.metrics).ray_offset());
    gl.Enable(GL_DEPTH_TEST);  // without the depth test, depth is not written
    gl.DepthFunc(GL_ALWAYS);
    node.program->use();
    gpu.no_vertices().bind();
    gl.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(run.value(node.vpls.plan).vpl_count));
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    layers.attach_depth(0);
}

void update_maps(Gpu& gpu, Execution& run, const MapNode& node) {
    const VplAtlas& atlas = run.value(node.common.atlas);
    run.reserve(node.depth, atlas_desc(atlas));
    DrawnAtlas target{.atlas = atlas, .object = run.object(node.depth)};
    const DrawnAtlas* const before = run.previous(node.drawn);
    std::optional<std::vector<Box>> changed;
    if (node.vpls.motion) {
        const SceneMotion& motion = run.value(*node.vpls.motion);
        target.set = run.value(*node.vpls.set);
        target.step = motion.step;
        if (before != nullptr && before->atlas == atlas && before->object == target.object &&
            before->set == target.set) {
            changed = changed_boxes(motion, before->step);
        }
    }
    draw_maps(gpu, run, node, target, changed);
    run.set(node.drawn, target);
}

}  // namespace

TextureHandle add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const MappedVpls& vpls,
                           const VplCommon& common) {
    return graph.add("vpl-maps", [&](Pass& pass) {
        pass.read(vpls.plan);
        pass.read(vpls.vpls, {Usage::storage, BINDING_VPLS});
        if (vpls.motion) {
            pass.read(*vpls.motion);
            pass.read(*vpls.set);
        }
        pass.read(common.atlas);
        read_vpl_constants(pass, common);
        read_tracing(pass, tracing);
        const MapNode node{
            .tracing = tracing,
            .vpls = vpls,
            .common = common,
            .depth = pass.update(graph.texture("vpl maps", atlas_desc({}), Lifetime::persistent),
                                 Usage::layer_target),
            .drawn = pass.update(graph.value<DrawnAtlas>("drawn vpl atlas")),
            .program = &gpu.program({"vpls/vpl_maps.vert", "vpls/vpl_maps.geom", "vpls/vpl_maps.frag"})};
        pass.run([=, &gpu](Execution& run) { update_maps(gpu, run, node); });
        return node.depth;
    });
}

}  // namespace candela
