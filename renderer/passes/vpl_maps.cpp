#include "renderer/passes/vpl_maps.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <numeric>
#include <vector>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

// Layers hold some hundred small tiles or some few large ones: little is left over in the last, and the
// layers are few enough for any driver.
constexpr std::uint32_t least_side = 512;
constexpr std::uint32_t least_tiles = 4;

TextureDesc atlas_desc(const VplAtlas& atlas) {
    return {{atlas.side, atlas.side}, Format::depth32f, TextureShape::array, atlas.layers};
}

void set_atlas(const gl::Program& program, const VplAtlas& atlas, const SceneMetrics& metrics) {
    program.set("vpl_map_resolution", atlas.resolution);
    program.set("vpl_tiles", atlas.tiles);
    program.set("vpl_map_inverse_reach", 1.0F / atlas.reach);
    program.set("vpl_ray_offset", metrics.ray_offset());
}

/// Of all VPLs: the ones that there are in the end, the shader picks out.
std::vector<std::uint32_t> all_places(const VplPaths& paths) {
    std::vector<std::uint32_t> places(paths.vpl_count);
    std::iota(places.begin(), places.end(), 0U);
    return places;
}

/// What the node is made of.
struct MapNode {
    Tracing tracing;
    Vpls vpls;
    VplMaps out;
    BufferHandle<std::uint32_t> due;
    const gl::Program* program;
};

void draw_maps(Gpu& gpu, Execution& run, const MapNode& node, const VplAtlas& atlas, bool all) {
    const gl::Functions& gl = gpu.gl();
    const std::vector<std::uint32_t> places =
        all ? all_places(run.value(node.vpls.paths)) : run.value(node.vpls.paths).maps_due;
    upload<std::uint32_t>(gpu, run, node.due, places);

    gl::Framebuffer& target = gpu.layer_target();
    target.attach_depth(atlas.object);
    target.bind();
    const auto side = static_cast<GLsizei>(atlas.side);
    gl.Viewport(0, 0, side, side);
    if (all) {
        const float nothing = 0.0F;
        gl.ClearBufferfv(GL_DEPTH, 0, &nothing);
    }
    const SceneMetrics& metrics = run.value(node.tracing.metrics);
    bind_tracing(gpu, run, *node.program, node.tracing);
    set_atlas(*node.program, atlas, metrics);
    node.program->set("atlas_side", static_cast<float>(atlas.side));
    gpu.bind_storage(BINDING_VPLS, run.object(node.vpls.vpls));
    gpu.bind_storage(BINDING_MAPS_DUE, run.object(node.due));
    gl.Enable(GL_DEPTH_TEST);  // depth is written only with it
    gl.DepthFunc(GL_ALWAYS);
    node.program->use();
    gpu.no_vertices().bind();
    gl.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(places.size()));
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    target.attach_depth(0);
}

void update_maps(Gpu& gpu, Execution& run, const MapNode& node, const VplVisibilitySettings& settings) {
    const VplPaths& paths = run.value(node.vpls.paths);
    VplAtlas atlas =
        plan_vpl_atlas(settings.map_resolution, std::max(paths.map_count, 1U), gpu.device().limits());
    run.reserve(node.out.depth, atlas_desc(atlas));
    atlas.object = run.object(node.out.depth);
    const float scale = run.value(node.tracing.metrics).scale();
    atlas.reach = scale > 0.0F ? 4.0F * scale : 1.0F;
    const VplAtlas* const before = run.find(node.out.atlas);
    draw_maps(gpu, run, node, atlas, before == nullptr || *before != atlas);
    run.set(node.out.atlas, atlas);
}

}  // namespace

VplAtlas plan_vpl_atlas(std::uint32_t resolution, std::uint32_t maps, const gl::Limits& limits) {
    VplAtlas atlas{.resolution = resolution};
    atlas.side = std::min(std::bit_ceil(std::max(least_side, least_tiles * resolution)), limits.texture_size);
    atlas.tiles = atlas.side / resolution;
    if (atlas.tiles == 0) {
        throw gl::GlError(fmt::format("depth maps of VPLs of {} texels a side: the driver allows {}",
                                      resolution, limits.texture_size));
    }
    const std::uint32_t of_layer = atlas.tiles * atlas.tiles;
    atlas.layers = (maps + of_layer - 1) / of_layer;
    if (atlas.layers > limits.texture_layers) {
        throw gl::GlError(
            fmt::format("depth maps of {} VPLs, {} texels a side, fill {} layers; the driver allows {}", maps,
                        resolution, atlas.layers, limits.texture_layers));
    }
    return atlas;
}

VplMaps add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const Vpls& vpls,
                     const VplVisibilitySettings& settings) {
    return graph.add("vpl-maps", [&](Pass& pass) {
        pass.read(vpls.paths);
        pass.read(vpls.vpls, Usage::storage);
        read_tracing(pass, tracing);
        pass.parameter(settings);
        pass.remembers();
        const MapNode node{
            .tracing = tracing,
            .vpls = vpls,
            .out = {.atlas = pass.write(graph.value<VplAtlas>("vpl atlas")),
                    .depth = pass.write(graph.texture("vpl maps", atlas_desc({}), Lifetime::persistent),
                                        Usage::layer_target)},
            .due = pass.write(graph.buffer<std::uint32_t>("maps due", 1, Lifetime::persistent), Usage::copy),
            .program = &gpu.program({"vpl_maps.vert", "vpl_maps.geom", "vpl_maps.frag"})};
        pass.run([=, &gpu](Execution& run) { update_maps(gpu, run, node, settings); });
        return node.out;
    });
}

void read_vpl_maps(Pass& pass, const VplMaps& maps) {
    pass.read(maps.atlas);
    pass.read(maps.depth, Usage::sampled);
}

void bind_vpl_maps(const Gpu& gpu, Execution& run, const gl::Program& program, const VplMaps& maps,
                   const SceneMetrics& metrics) {
    gpu.gl().BindTextureUnit(UNIT_VPL_MAPS, run.object(maps.depth));
    gpu.shadow_sampler().bind(UNIT_VPL_MAPS);
    set_atlas(program, run.value(maps.atlas), metrics);
}

}  // namespace candela
