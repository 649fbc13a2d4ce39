#include "renderer/passes/vpls/vpl_maps.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"

#include "renderer/passes/inspect/depth_note.hpp"
#include "renderer/passes/scene/changed_boxes.hpp"
#include "renderer/passes/scene/traced_content.hpp"

namespace candela {
namespace {

constexpr std::uint32_t most_spare_layers = 4;
constexpr std::uint32_t most_groups = 65'535;  // of a dispatch, along an axis: the least that OpenGL allows

TextureDesc atlas_desc(const VplAtlas& atlas, Format format, std::uint32_t layers) {
    return {{atlas.side, atlas.side}, format, TextureShape::array, layers};
}

/// How many layers the texture should have: as many as it has, if that is enough and not far too much, as
/// another texture would lose the maps of surfels that stay. Otherwise up to `spare` more than are needed:
/// while a camera moves, the number of surfels goes up and down.
std::uint32_t layers_of(std::uint32_t needed, std::uint32_t now, std::uint32_t spare) {
    const std::uint32_t roomy = needed + std::min((needed + 1) / 2, spare);
    return now >= needed && now <= 2 * roomy ? now : roomy;
}

/// What the maps were made from.
struct MapKey {
    std::uint32_t resolution = 0;
    std::uint32_t side = 0;
    float near = 0.0F;
    bool planned = false;  // MappedSurfels::tasks
    bool operator==(const MapKey&) const = default;
};

/// Resources of the node.
struct MapNode {
    Tracing tracing;
    ValueHandle<VplCounts> counts;
    std::optional<MappedSurfels> surfels;
    VplCommon common;
    VplMaps maps;
    TracedContent<MapKey> drawn;
    ChangedBoxes changed;
    ValueHandle<std::vector<std::uint64_t>> drawn_keys;  // SurfelMaps::keys
    BufferHandle<std::uint32_t> tasks;                   // SurfelTasks::of
    const gl::Program* program;
};

/// All that has changed: whole maps, where the slot has had another than that of the surfel.
std::vector<std::uint32_t> tasks_of(const SurfelMaps& maps, const std::vector<std::uint64_t>& drawn) {
    std::vector<std::uint32_t> tasks(maps.slots.size());
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const std::uint32_t slot = maps.slots[i];
        const bool is_new = slot >= drawn.size() || drawn[slot] != maps.keys[slot];
        tasks[i] = is_new ? SURFEL_WHOLE : SURFEL_CHANGED;
    }
    return tasks;
}

/// What is drawn in the slots of the maps.
struct MapDraw {
    std::uint32_t slots = 0;                             // from 0
    std::optional<std::vector<Box>> changed;             // see changed_boxes; none: all that is not there
    bool has_tasks = false;                              // MapNode::tasks tells which maps are drawn
    const std::vector<std::uint32_t>* filled = nullptr;  // SurfelTasks::of, if it has SURFEL_NO_MAP
};

/// Fills the maps that let no light through: what they see is near, and before every surface.
void fill_maps(const Gpu& gpu, const Execution& run, const MapNode& node, const MappedSurfels& surfels,
               const std::vector<std::uint32_t>& tasks) {
    constexpr float nearest = 1.0F;
    const VplAtlas& atlas = run.value(node.common.atlas);
    const std::vector<std::uint32_t>& slots = run.value(surfels.maps).slots;
    const auto size = static_cast<GLsizei>(atlas.resolution);
    for (std::size_t i = 0; i < slots.size(); ++i) {
        if ((tasks[i] & SURFEL_NO_MAP) == 0) continue;
        const std::uint32_t of_layer = slots[i] % (atlas.tiles * atlas.tiles);
        const auto x = static_cast<GLint>(of_layer % atlas.tiles * atlas.resolution);
        const auto y = static_cast<GLint>(of_layer / atlas.tiles * atlas.resolution);
        const auto layer = static_cast<GLint>(slots[i] / (atlas.tiles * atlas.tiles));
        gpu.gl().ClearTexSubImage(run.object(node.maps.depth), 0, x, y, layer, size, size, 1, GL_RED,
                                  GL_FLOAT, &nearest);
        gpu.gl().ClearTexSubImage(run.object(node.maps.slopes), 0, x, y, layer, size, size, 1, GL_RED_INTEGER,
                                  GL_UNSIGNED_INT, nullptr);
    }
}

void trace_maps(Gpu& gpu, Execution& run, const MapNode& node, const MapDraw& draw) {
    gpu.gl().MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);  // texels that were traced before are cleared
    if (!draw.changed) {
        gpu.gl().ClearTexImage(run.object(node.maps.depth), 0, GL_RED, GL_FLOAT, nullptr);
        gpu.gl().ClearTexImage(run.object(node.maps.slopes), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    }
    if (draw.filled != nullptr) fill_maps(gpu, run, node, *node.surfels, *draw.filled);
    gl::Uniforms uniforms =
        node.changed.upload(gpu, run, draw.changed, 4.0F * run.value(node.tracing.metrics).ray_offset());
    if (node.surfels) uniforms = uniforms + gl::Uniforms{{"has_tasks", draw.has_tasks}};
    const std::uint32_t blocks = groups(run.value(node.common.atlas).resolution, MAP_BLOCK);
    ComputeSteps steps(gpu);
    for (std::uint32_t first = 0; first < draw.slots; first += most_groups) {
        steps.run(*node.program, {blocks, blocks, std::min(draw.slots - first, most_groups)},
                  uniforms + gl::Uniforms{{"first_vpl", first}});
    }
}

void update_surfel_maps(Gpu& gpu, Execution& run, const MapNode& node, const MappedSurfels& surfels) {
    const VplAtlas& atlas = run.value(node.common.atlas);
    const auto* const last = run.previous(node.drawn_keys);
    const std::vector<std::uint64_t> drawn = last != nullptr ? *last : std::vector<std::uint64_t>{};
    const SurfelMaps& maps = run.value(surfels.maps);
    const MapKey key{atlas.resolution, atlas.side, atlas.near, surfels.tasks.has_value()};
    const std::vector<ObjectId> textures{run.object(node.maps.depth)};
    run.set(node.drawn_keys, maps.keys);
    MapDraw draw{.slots = static_cast<std::uint32_t>(std::max(maps.keys.size(), drawn.size())),
                 .changed = {}};
    if (surfels.tasks) {
        const SurfelTasks& tasks = run.value(*surfels.tasks);
        const TasksDone done = node.drawn.tasks_done(run, tasks.number, key, textures, textures);
        if (done == TasksDone::all) return;
        if (done == TasksDone::all_before) draw.changed = tasks.changed;
        upload<std::uint32_t>(gpu, run, node.tasks, tasks.of);
        draw.has_tasks = true;
        draw.filled = &tasks.of;
    } else {
        draw.changed = node.drawn.outdated(run, run.value(surfels.motion), key, textures);
        draw.has_tasks = draw.changed.has_value();
        if (draw.has_tasks) upload<std::uint32_t>(gpu, run, node.tasks, tasks_of(maps, drawn));
    }
    trace_maps(gpu, run, node, draw);
}

void update_maps(Gpu& gpu, Execution& run, const MapNode& node) {
    const VplAtlas& atlas = run.value(node.common.atlas);
    const std::uint32_t spare =
        node.surfels ? std::min(most_spare_layers, gpu.device().limits().texture_layers - atlas.layers) : 0;
    const std::uint32_t layers = layers_of(atlas.layers, run.desc(node.maps.depth).layers, spare);
    run.reserve(node.maps.depth, atlas_desc(atlas, Format::r32f, layers));
    run.reserve(node.maps.slopes, atlas_desc(atlas, Format::r32ui, layers));
    if (node.surfels) {
        update_surfel_maps(gpu, run, node, *node.surfels);
        return;
    }
    node.drawn.forget(run);
    run.set(node.drawn_keys, {});
    trace_maps(gpu, run, node, {.slots = run.value(node.counts).mapped(), .changed = {}});
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
    if (mapped.tasks) {
        pass.keeps_state();
        pass.read(*mapped.tasks);
    }
    return {"SURFELS"};
}

}  // namespace

VplMaps add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const MappedVpls& vpls,
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
            .maps = {.depth = pass.update(
                         graph.texture("vpl maps", atlas_desc({}, Format::r32f, 1), Lifetime::persistent),
                         {Usage::storage, IMAGE_VPL_MAPS}),
                     .slopes =
                         pass.update(graph.texture("slopes in vpl maps", atlas_desc({}, Format::r32ui, 1),
                                                   Lifetime::persistent),
                                     {Usage::storage, IMAGE_VPL_SLOPES})},
            .drawn = TracedContent<MapKey>(graph, pass, "drawn vpl maps"),
            .changed = ChangedBoxes(graph, pass, "changed boxes of vpl maps"),
            .drawn_keys = pass.update(graph.value<std::vector<std::uint64_t>>("keys of vpl maps")),
            .tasks = pass.write(growing_buffer<std::uint32_t>(graph, "tasks of vpl maps"),
                                {Usage::copy, BINDING_MAP_TASKS}),
            .program = &gpu.program({"vpls/vpl_maps.comp"}, defined)};
        graph.note(node.maps.depth, depth_note(common.atlas, [](const VplAtlas& atlas, std::uint32_t) {
                       return perspective_terms(atlas.near);
                   }));
        pass.run([=, &gpu](Execution& run) { update_maps(gpu, run, node); });
        return node.maps;
    });
}

}  // namespace candela
