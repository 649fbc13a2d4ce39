#include "renderer/passes/vpls/vpl_maps.hpp"

#include <optional>
#include <string>
#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/layer_target.hpp"
#include "renderer/passes/inspect/depth_note.hpp"
#include "renderer/passes/scene/traced_content.hpp"

namespace candela {
namespace {

TextureDesc atlas_desc(const VplAtlas& atlas) {
    return {{atlas.side, atlas.side}, Format::depth32f, TextureShape::array, atlas.layers};
}

/// What the maps were made from.
struct MapKey {
    VplAtlas atlas;
    std::uint64_t set = 0;  // of surfels
    bool operator==(const MapKey&) const = default;
};

/// Resources of the node.
struct MapNode {
    Tracing tracing;
    ValueHandle<VplCounts> counts;
    std::optional<MappedSurfels> surfels;
    VplCommon common;
    TextureHandle depth;
    TracedContent<MapKey> drawn;
    const gl::Program* program;
};

/// Draws the texels whose rays pass through the boxes in `changed`; all texels without a value: see
/// changed_boxes.
void draw_maps(Gpu& gpu, Execution& run, const MapNode& node,
               const std::optional<std::vector<Box>>& changed) {
    LayerTarget target(gpu);
    target.set_layers(run.object(node.depth), run.value(node.common.atlas).side);
    if (!changed) target.clear();
    gpu.draw_points(*node.program, run.value(node.counts).mapped(),
                    changed_box_uniforms(changed, 4.0F * run.value(node.tracing.metrics).ray_offset()),
                    {.depth_test = gl::DepthTest::always});
}

void update_maps(Gpu& gpu, Execution& run, const MapNode& node) {
    const VplAtlas& atlas = run.value(node.common.atlas);
    run.reserve(node.depth, atlas_desc(atlas));
    if (!node.surfels) {
        node.drawn.forget(run);
        draw_maps(gpu, run, node, std::nullopt);
        return;
    }
    draw_maps(gpu, run, node,
              node.drawn.outdated(run, run.value(node.surfels->motion), {atlas, run.value(node.surfels->set)},
                                  {run.object(node.depth)}));
}

const gl::Program& map_program(Gpu& gpu, const std::vector<std::string>& defined) {
    return gpu.program({"vpls/vpl_maps.vert", "vpls/vpl_maps.geom", "vpls/vpl_maps.frag"}, defined);
}

/// Returns the names to define in shaders that include mapped_vpl.glsl.
std::vector<std::string> read_mapped(Pass& pass, const MappedVpls& vpls) {
    pass.read(vpls.counts);
    if (const auto* const traced = std::get_if<BufferHandle<gpu::TracedVpl>>(&vpls.records)) {
        pass.read(*traced, {Usage::storage, BINDING_TRACED_VPLS});
        return {};
    }
    const auto& mapped = std::get<MappedSurfels>(vpls.records);
    pass.read(mapped.surfels, {Usage::storage, BINDING_SURFELS});
    pass.read(mapped.set);
    pass.read(mapped.motion);
    return {"SURFELS"};
}

}  // namespace

TextureHandle add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const MappedVpls& vpls,
                           const VplCommon& common) {
    return graph.add("vpl-maps", [&](Pass& pass) {
        const std::vector<std::string> defined = read_mapped(pass, vpls);
        const auto* const surfels = std::get_if<MappedSurfels>(&vpls.records);
        pass.read(common.atlas);
        read_vpl_constants(pass, common);
        read_tracing(pass, tracing);
        const MapNode node{
            .tracing = tracing,
            .counts = vpls.counts,
            .surfels = surfels != nullptr ? std::optional(*surfels) : std::nullopt,
            .common = common,
            .depth = pass.update(graph.texture("vpl maps", atlas_desc({}), Lifetime::persistent),
                                 Usage::layer_target),
            .drawn = TracedContent<MapKey>(graph, pass, "drawn vpl maps"),
            .program = &map_program(gpu, defined)};
        graph.note(node.depth, depth_note(common.atlas, [](const VplAtlas& atlas, std::uint32_t) {
                       return perspective_terms(atlas.near);
                   }));
        pass.run([=, &gpu](Execution& run) { update_maps(gpu, run, node); });
        return node.depth;
    });
}

}  // namespace candela
