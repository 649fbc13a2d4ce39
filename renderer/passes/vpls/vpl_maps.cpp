#include "renderer/passes/vpls/vpl_maps.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/layer_target.hpp"
#include "renderer/passes/inspect/depth_note.hpp"
#include "renderer/passes/scene/traced_content.hpp"

namespace candela {
namespace {

TextureDesc atlas_desc(const VplAtlas& atlas, std::uint32_t layers) {
    return {{atlas.side, atlas.side}, Format::depth32f, TextureShape::array, layers};
}

/// How many layers the texture should have: as many as it has, if that is enough and not far too much, as
/// another texture would lose the maps of surfels that stay.
std::uint32_t layers_of(const VplAtlas& atlas, const TextureDesc& now) {
    const bool enough = now.layers >= atlas.layers && now.layers <= 2 * atlas.layers;
    return enough ? now.layers : atlas.layers;
}

/// What the maps were made from.
struct MapKey {
    std::uint32_t resolution = 0;
    std::uint32_t side = 0;
    float near = 0.0F;
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
    ValueHandle<std::vector<std::uint64_t>> drawn_keys;  // SurfelMaps::keys
    BufferHandle<std::uint32_t> new_maps;                // by surfel: not 0 if its whole map must be drawn
    const gl::Program* program;
};

/// By surfel: 1 if its slot has had another map than its own, else 0.
std::vector<std::uint32_t> new_maps(const SurfelMaps& maps, const std::vector<std::uint64_t>& drawn) {
    std::vector<std::uint32_t> is_new(maps.slots.size());
    for (std::size_t i = 0; i < is_new.size(); ++i) {
        const std::uint32_t slot = maps.slots[i];
        is_new[i] = slot >= drawn.size() || drawn[slot] != maps.keys[slot] ? 1 : 0;
    }
    return is_new;
}

/// Draws the slots from 0 to `slots`: of maps that are not new, the texels whose rays pass through the boxes
/// in `changed`; all texels without a value: see changed_boxes.
void draw_maps(Gpu& gpu, Execution& run, const MapNode& node, std::uint32_t slots,
               const std::optional<std::vector<Box>>& changed) {
    LayerTarget target(gpu);
    target.set_layers(run.object(node.depth), run.value(node.common.atlas).side);
    if (!changed) target.clear();
    gpu.draw_points(*node.program, slots,
                    changed_box_uniforms(changed, 4.0F * run.value(node.tracing.metrics).ray_offset()),
                    {.depth_test = gl::DepthTest::always});
}

void update_surfel_maps(Gpu& gpu, Execution& run, const MapNode& node, const MappedSurfels& surfels) {
    const VplAtlas& atlas = run.value(node.common.atlas);
    const auto* const last = run.previous(node.drawn_keys);
    const std::vector<std::uint64_t> drawn = last != nullptr ? *last : std::vector<std::uint64_t>{};
    const SurfelMaps& maps = run.value(surfels.maps);
    const auto changed = node.drawn.outdated(
        run, run.value(surfels.motion), {atlas.resolution, atlas.side, atlas.near}, {run.object(node.depth)});
    if (changed) upload<std::uint32_t>(gpu, run, node.new_maps, new_maps(maps, drawn));
    draw_maps(gpu, run, node, static_cast<std::uint32_t>(std::max(maps.keys.size(), drawn.size())), changed);
    run.set(node.drawn_keys, maps.keys);
}

void update_maps(Gpu& gpu, Execution& run, const MapNode& node) {
    const VplAtlas& atlas = run.value(node.common.atlas);
    run.reserve(node.depth, atlas_desc(atlas, layers_of(atlas, run.desc(node.depth))));
    if (node.surfels) {
        update_surfel_maps(gpu, run, node, *node.surfels);
        return;
    }
    node.drawn.forget(run);
    run.set(node.drawn_keys, {});
    draw_maps(gpu, run, node, run.value(node.counts).mapped(), std::nullopt);
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
    pass.read(mapped.maps);
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
            .depth = pass.update(graph.texture("vpl maps", atlas_desc({}, 1), Lifetime::persistent),
                                 Usage::layer_target),
            .drawn = TracedContent<MapKey>(graph, pass, "drawn vpl maps"),
            .drawn_keys = pass.update(graph.value<std::vector<std::uint64_t>>("keys of vpl maps")),
            .new_maps = pass.write(growing_buffer<std::uint32_t>(graph, "new vpl maps"),
                                   {Usage::copy, BINDING_NEW_MAPS}),
            .program = &map_program(gpu, defined)};
        graph.note(node.depth, depth_note(common.atlas, [](const VplAtlas& atlas, std::uint32_t) {
                       return perspective_terms(atlas.near);
                   }));
        pass.run([=, &gpu](Execution& run) { update_maps(gpu, run, node); });
        return node.depth;
    });
}

}  // namespace candela
