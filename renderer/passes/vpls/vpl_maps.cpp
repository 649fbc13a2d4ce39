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
    BufferHandle<glm::uvec2> tasks;                      // see listed_tasks
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

/// What is to be drawn of each surfel.
struct MapTasks {
    std::vector<std::uint32_t> of;            // SurfelTasks::of
    std::optional<std::vector<Box>> changed;  // see changed_boxes; none: all that is not there
};

/// Each with the index of its surfel; behind them the slots up to `slots` that surfels had and have no more.
/// `changed`: none: all maps are cleared.
std::vector<glm::uvec2> listed_tasks(const std::vector<std::uint32_t>& tasks, std::size_t slots,
                                     const std::optional<std::vector<Box>>& changed) {
    std::vector<glm::uvec2> listed;
    for (std::uint32_t i = 0; i < slots; ++i) {
        const std::uint32_t task = i < tasks.size() && changed ? tasks[i] : std::uint32_t{SURFEL_WHOLE};
        const bool is_left_out = i < tasks.size() && (tasks[i] & SURFEL_NO_MAP) != 0;
        const bool sees_change = (task & SURFEL_CHANGED) != 0 && !changed->empty();
        if (is_left_out) continue;
        if ((task & SURFEL_WHOLE) != 0) {
            listed.emplace_back(i, SURFEL_WHOLE);
        } else if (sees_change) {
            listed.emplace_back(i, SURFEL_CHANGED);
        }
    }
    return listed;
}

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

void clear_maps(const Gpu& gpu, const Execution& run, const MapNode& node) {
    gpu.gl().ClearTexImage(run.object(node.maps.depth), 0, GL_RED, GL_FLOAT, nullptr);
    gpu.gl().ClearTexImage(run.object(node.maps.slopes), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

/// `count`: of tasks, or of VPLs where all maps are drawn. `order`: which of both.
void trace_maps(Gpu& gpu, Execution& run, const MapNode& node, const std::optional<std::vector<Box>>& changed,
                std::uint32_t count, const gl::Uniforms& order) {
    const gl::Uniforms uniforms =
        order + node.changed.upload(gpu, run, changed, 4.0F * run.value(node.tracing.metrics).ray_offset());
    const std::uint32_t blocks = groups(run.value(node.common.atlas).resolution, MAP_BLOCK);
    ComputeSteps steps(gpu);
    for (std::uint32_t first = 0; first < count; first += most_groups) {
        steps.run(*node.program, {blocks, blocks, std::min(count - first, most_groups)},
                  uniforms + gl::Uniforms{{"first_task", first}});
    }
}

/// None: all has been drawn. `drawn`: the keys of the maps that are there.
std::optional<MapTasks> map_tasks(Execution& run, const MapNode& node, const MappedSurfels& surfels,
                                  const std::vector<std::uint64_t>& drawn) {
    const VplAtlas& atlas = run.value(node.common.atlas);
    const MapKey key{atlas.resolution, atlas.side, atlas.near, surfels.tasks.has_value()};
    const std::vector<ObjectId> textures{run.object(node.maps.depth)};
    if (!surfels.tasks) {
        auto changed = node.drawn.outdated(run, run.value(surfels.motion), key, textures);
        return MapTasks{tasks_of(run.value(surfels.maps), drawn), std::move(changed)};
    }
    const SurfelTasks& tasks = run.value(*surfels.tasks);
    switch (node.drawn.tasks_done(run, tasks.number, key, textures, textures)) {
        case TasksDone::all:
            return std::nullopt;
        case TasksDone::all_before:
            return MapTasks{tasks.of, tasks.changed};
        case TasksDone::none:
            break;
    }
    return MapTasks{tasks.of, std::nullopt};
}

void update_surfel_maps(Gpu& gpu, Execution& run, const MapNode& node, const MappedSurfels& surfels) {
    const auto* const last = run.previous(node.drawn_keys);
    const std::vector<std::uint64_t> drawn = last != nullptr ? *last : std::vector<std::uint64_t>{};
    const std::vector<std::uint64_t>& keys = run.value(surfels.maps).keys;
    run.set(node.drawn_keys, keys);
    const std::optional<MapTasks> tasks = map_tasks(run, node, surfels, drawn);
    if (!tasks) return;
    gpu.gl().MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);  // texels that were traced before are cleared
    if (!tasks->changed) clear_maps(gpu, run, node);
    fill_maps(gpu, run, node, surfels, tasks->of);
    // All, without a list: that would depend on what was drawn before, and results must not.
    if (!surfels.tasks && !tasks->changed) {
        trace_maps(gpu, run, node, {}, static_cast<std::uint32_t>(keys.size()),
                   gl::Uniforms{{"has_tasks", false}});
        return;
    }
    const std::vector<glm::uvec2> listed =
        listed_tasks(tasks->of, std::max(keys.size(), drawn.size()), tasks->changed);
    upload<glm::uvec2>(gpu, run, node.tasks, listed);
    trace_maps(gpu, run, node, tasks->changed, static_cast<std::uint32_t>(listed.size()),
               gl::Uniforms{{"has_tasks", true}});
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
    gpu.gl().MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    clear_maps(gpu, run, node);
    trace_maps(gpu, run, node, std::nullopt, run.value(node.counts).mapped(), {});
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

std::optional<ValueHandle<SurfelMaps>> surfel_maps(const MappedVpls& vpls) {
    const auto* const surfels = std::get_if<MappedSurfels>(&vpls.records);
    return surfels != nullptr ? std::optional(surfels->maps) : std::nullopt;
}

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
            .tasks = pass.write(growing_buffer<glm::uvec2>(graph, "tasks of vpl maps"),
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
