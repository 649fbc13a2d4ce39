#include "renderer/passes/vpl_maps.hpp"

#include <numeric>
#include <vector>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

TextureDesc atlas_desc(const VplAtlas& atlas) {
    return {{atlas.side, atlas.side}, Format::depth32f, TextureShape::array, atlas.layers};
}

/// Of all VPLs: the ones that there are in the end, the shader picks out.
std::vector<std::uint32_t> all_places(const VplPaths& paths) {
    std::vector<std::uint32_t> places(paths.vpl_count);
    std::iota(places.begin(), places.end(), 0U);
    return places;
}

/// Where maps have been drawn.
struct DrawnAtlas {
    VplAtlas atlas;
    ObjectId object = 0;
    bool operator==(const DrawnAtlas&) const = default;
};

/// What the node is made of.
struct MapNode {
    Tracing tracing;
    MappedVpls vpls;
    VplCommon common;
    TextureHandle depth;
    ValueHandle<DrawnAtlas> drawn;
    BufferHandle<std::uint32_t> due;
    const gl::Program* program;
};

void draw_maps(Gpu& gpu, Execution& run, const MapNode& node, const DrawnAtlas& target, bool all) {
    const gl::Functions& gl = gpu.gl();
    const std::vector<std::uint32_t> places =
        all ? all_places(run.value(node.vpls.paths)) : run.value(node.vpls.paths).maps_due;
    upload<std::uint32_t>(gpu, run, node.due, places);

    gl::Framebuffer& layers = gpu.layer_target();
    layers.attach_depth(target.object);
    layers.bind();
    const auto side = static_cast<GLsizei>(target.atlas.side);
    gl.Viewport(0, 0, side, side);
    if (all) {
        const float nothing = 0.0F;
        gl.ClearBufferfv(GL_DEPTH, 0, &nothing);
    }
    bind_tracing(gpu, run, *node.program, node.tracing);
    bind_vpl_constants(gpu, run, node.common);
    gpu.bind_storage(BINDING_VPLS, run.object(node.vpls.vpls));
    gpu.bind_storage(BINDING_MAPS_DUE, run.object(node.due));
    gl.Enable(GL_DEPTH_TEST);  // depth is written only with it
    gl.DepthFunc(GL_ALWAYS);
    node.program->use();
    gpu.no_vertices().bind();
    gl.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(places.size()));
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    layers.attach_depth(0);
}

void update_maps(Gpu& gpu, Execution& run, const MapNode& node) {
    const VplAtlas& atlas = run.value(node.common.atlas);
    run.reserve(node.depth, atlas_desc(atlas));
    const DrawnAtlas target{atlas, run.object(node.depth)};
    const DrawnAtlas* const before = run.find(node.drawn);
    draw_maps(gpu, run, node, target, before == nullptr || *before != target);
    run.set(node.drawn, target);
}

}  // namespace

TextureHandle add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const MappedVpls& vpls,
                           const VplCommon& common) {
    return graph.add("vpl-maps", [&](Pass& pass) {
        pass.read(vpls.paths);
        pass.read(vpls.vpls, Usage::storage);
        pass.read(common.atlas);
        read_vpl_constants(pass, common);
        read_tracing(pass, tracing);
        pass.remembers();
        const MapNode node{
            .tracing = tracing,
            .vpls = vpls,
            .common = common,
            .depth = pass.write(graph.texture("vpl maps", atlas_desc({}), Lifetime::persistent),
                                Usage::layer_target),
            .drawn = pass.write(graph.value<DrawnAtlas>("drawn vpl atlas")),
            .due = pass.write(graph.buffer<std::uint32_t>("maps due", 1, Lifetime::persistent), Usage::copy),
            .program = &gpu.program({"vpl_maps.vert", "vpl_maps.geom", "vpl_maps.frag"})};
        pass.run([=, &gpu](Execution& run) { update_maps(gpu, run, node); });
        return node.depth;
    });
}

}  // namespace candela
