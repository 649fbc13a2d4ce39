#include "renderer/passes/lights/light_lists.hpp"

#include <fmt/format.h>
#include <algorithm>

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/loop_parts.hpp"

namespace candela {
namespace {

gpu::CellConstants cell_constants(const CellGrid& grid) {
    return {.tiles = grid.tiles,
            .target_size = grid.size,
            .slices = grid.slices,
            .tile_size = grid.tile_size,
            .first_depth = grid.first_depth,
            .depth_ratio = grid.depth_ratio};
}

/// `declare(Pass&)` declares the inputs of `make_grid(Execution&)`.
template <class Declare, class MakeGrid>
LightGrid add_light_grid(FrameGraph& graph, const Gpu& gpu, Declare declare, MakeGrid make_grid) {
    return graph.add("light-grid", [&](Pass& pass) {
        declare(pass);
        const LightGrid out{.cells = pass.write(graph.value<CellGrid>("light grid")),
                            .constants = pass.write(
                                growing_buffer<gpu::CellConstants>(graph, "cell constants"), Usage::copy)};
        pass.run([=, &gpu](Execution& run) {
            const CellGrid grid = make_grid(run);
            upload_one(gpu, run, out.constants, cell_constants(grid));
            run.set(out.cells, grid);
        });
        return out;
    });
}

void read_light_grid(Pass& pass, const LightGrid& grid) {
    pass.read(grid.constants, {Usage::uniform, UNIFORMS_CELLS});
}

/// Adds node `NAME-bins` (CPU): sorts the lights into cells and uploads them. `declare(Pass&)` declares the
/// inputs of `is_wanted(Execution&)`; if that returns false, the lists stay empty.
template <class Declare, class IsWanted>
BinBuffers add_light_bins(FrameGraph& graph, const Gpu& gpu, std::string_view name, const ListInputs& inputs,
                          Declare declare, IsWanted is_wanted) {
    return graph.add(fmt::format("{}-bins", name), [&](Pass& pass) {
        pass.read(inputs.lights.table);
        pass.read(inputs.view.camera);
        pass.read(inputs.grid.cells);
        declare(pass);
        const auto buffer = [&](std::string_view what) {
            return pass.write(growing_buffer<std::uint32_t>(graph, fmt::format("{} {}", name, what)),
                              Usage::copy);
        };
        const BinBuffers out{.bins = pass.write(graph.value<LightBins>(fmt::format("{} bins", name))),
                             .first = buffer("first"),
                             .entries = buffer("entries")};
        pass.run([=, &gpu](Execution& run) {
            const LightTable nothing;
            const LightTable& table = is_wanted(run) ? run.value(inputs.lights.table) : nothing;
            LightBins bins = bin_lights(table, run.value(inputs.view.camera), run.value(inputs.grid.cells));
            upload<std::uint32_t>(gpu, run, out.first, bins.first);
            upload<std::uint32_t>(gpu, run, out.entries, bins.entries);
            run.set(out.bins, std::move(bins));
        });
        return out;
    });
}

BinBuffers add_light_bins(FrameGraph& graph, const Gpu& gpu, std::string_view name,
                          const ListInputs& inputs) {
    return add_light_bins(
        graph, gpu, name, inputs, [](Pass&) {}, [](Execution&) { return true; });
}

/// What culls the lists of one kind.
struct Culling {
    const gl::Program& program;
    bool by_groups;  // a work group each list; else an invocation
};

/// Lists of clusters are short, and there are many of them.
Culling culling_of(Gpu& gpu, LightList kind) {
    if (kind == LightList::cluster) return {gpu.program({"lights/light_clusters.comp"}), false};
    if (gpu.device().limits().software) return {gpu.program({"lights/light_tiles.comp"}), false};
    return {gpu.program({"lights/light_tiles.comp"}, {"GROUP_A_CELL"}), true};
}

/// Culls in the dispatches of loop_parts, or where there is a work group a list, in one.
void cull(const Gpu& gpu, const Culling& culling, const LightBins& bins, const gl::Uniforms& uniforms) {
    const CellGrid& grid = bins.grid;
    const Groups all =
        culling.by_groups ? Groups{grid.tiles.x, grid.tiles.y} : Groups{groups(grid.cells(), CULL_GROUP)};
    ComputeSteps steps(gpu);
    const gl::Limits limits = culling.by_groups ? gl::Limits{} : gpu.device().limits();
    for (const gl::Uniforms& part : loop_parts(limits, bins.longest(), 2)) {
        steps.run(culling.program, all, uniforms + part);
    }
}

/// What is culled: bins, and for tiles perhaps the depths that bound them.
struct Candidates {
    BinBuffers bins;
    std::optional<BufferHandle<gpu::TileDepth>> depths{};
};

/// Adds node `NAME` (compute): culls the bins in place. Each cell keeps, in order, the lights that reach it.
LightLists add_culling(FrameGraph& graph, Gpu& gpu, std::string_view name, LightList kind,
                       const ListInputs& inputs, const Candidates& candidates) {
    return graph.add(name, [&](Pass& pass) {
        pass.note(Workload::pixels);
        const auto& [bins, depths] = candidates;
        pass.read(bins.bins);
        read_view(pass, inputs.view);
        read_light_grid(pass, inputs.grid);
        pass.read(inputs.lights.buffer, {Usage::storage, BINDING_LIGHTS});
        pass.read(bins.first, {Usage::storage, BINDING_LIST_FIRST});
        if (depths) pass.read(*depths, {Usage::storage, BINDING_TILE_DEPTHS});
        const Culling culling = culling_of(gpu, kind);
        const LightLists out{
            .kind = kind,
            .inputs = inputs,
            .bins = bins.bins,
            .first = bins.first,
            .count = pass.write(growing_buffer<std::uint32_t>(graph, fmt::format("{} count", name)),
                                {Usage::storage, BINDING_LIST_COUNT}),
            .entries = pass.write(bins.entries, {Usage::storage, BINDING_LIST_ENTRIES})};
        graph.note(out.count, ListLengths{inputs.grid.cells});
        pass.run([=, &gpu, bounded = depths.has_value()](Execution& run) {
            const LightBins& binned = run.value(out.bins);
            run.reserve(out.count, binned.grid.cells());
            const bool is_tile = kind == LightList::tile;
            cull(gpu, culling, binned, is_tile ? gl::Uniforms{{"has_depth", bounded}} : gl::Uniforms{});
        });
        return out;
    });
}

BufferHandle<gpu::TileDepth> add_tile_depths(FrameGraph& graph, Gpu& gpu, TextureHandle depth,
                                             const ViewData& view, const LightGrid& grid) {
    return graph.add("tile-depths", [&](Pass& pass) {
        pass.note(Workload::pixels);
        pass.read(depth, {Usage::sampled, UNIT_DEPTH});
        pass.read(grid.cells);
        read_view(pass, view);
        read_light_grid(pass, grid);
        const gl::Program& program = gpu.program({"lights/tile_depths.comp"});
        const auto depths = pass.write(growing_buffer<gpu::TileDepth>(graph, "tile depths"),
                                       {Usage::storage, BINDING_TILE_DEPTHS});
        pass.run([=, &gpu, &program](Execution& run) {
            const CellGrid& cells = run.value(grid.cells);
            run.reserve(depths, cells.cells());
            ComputeSteps(gpu).run(program, {cells.tiles.x, cells.tiles.y});
        });
        return depths;
    });
}

}  // namespace

LightGrid add_tile_grid(FrameGraph& graph, const Gpu& gpu, glm::uvec2 size, const ListSettings& settings) {
    return add_light_grid(
        graph, gpu,
        [&](Pass& pass) {
            pass.parameter(size);
            pass.parameter(settings);
        },
        [=](Execution&) { return tile_grid(size, settings); });
}

LightGrid add_cluster_grid(FrameGraph& graph, const Gpu& gpu, ValueHandle<CameraView> camera,
                           ValueHandle<SceneMetrics> metrics, glm::uvec2 size, const ListSettings& settings) {
    const auto make_grid = [=](Execution& run) {
        const SceneMetrics& scene = run.value(metrics);
        const float distance = glm::length(scene.centre() - run.value(camera).eye);
        const float farthest = std::max(distance + scene.radius(), 1e-6F);
        // One slice is enough for depths below a thousandth of the farthest.
        const float nearest = std::max(distance - scene.radius(), 1e-3F * farthest);
        return cluster_grid(size, settings, nearest, farthest);
    };
    return add_light_grid(
        graph, gpu,
        [&](Pass& pass) {
            pass.read(camera);
            pass.read(metrics);
            pass.parameter(size);
            pass.parameter(settings);
        },
        make_grid);
}

LightLists add_light_tiles(FrameGraph& graph, Gpu& gpu, const ListInputs& inputs,
                           std::optional<TextureHandle> depth) {
    Candidates candidates{add_light_bins(graph, gpu, "light-tiles", inputs)};
    if (depth) candidates.depths = add_tile_depths(graph, gpu, *depth, inputs.view, inputs.grid);
    return add_culling(graph, gpu, "light-tiles", LightList::tile, inputs, candidates);
}

LightLists add_blended_light_tiles(FrameGraph& graph, Gpu& gpu, const ListInputs& inputs,
                                   ValueHandle<SceneLayout> layout) {
    const BinBuffers bins = add_light_bins(
        graph, gpu, "blended-light-tiles", inputs, [&](Pass& pass) { pass.read(layout); },
        [=](Execution& run) { return !run.value(layout).groups_of(AlphaMode::blend).empty(); });
    return add_culling(graph, gpu, "blended-light-tiles", LightList::tile, inputs, {bins});
}

LightLists add_light_clusters(FrameGraph& graph, Gpu& gpu, const ListInputs& inputs) {
    const BinBuffers bins = add_light_bins(graph, gpu, "light-clusters", inputs);
    return add_culling(graph, gpu, "light-clusters", LightList::cluster, inputs, {bins});
}

void read_light_lists(Pass& pass, const LightLists& lists) {
    read_light_grid(pass, lists.inputs.grid);
    pass.read(lists.bins);
    pass.read(lists.first, {Usage::storage, BINDING_LIST_FIRST});
    pass.read(lists.count, {Usage::storage, BINDING_LIST_COUNT});
    pass.read(lists.entries, {Usage::storage, BINDING_LIST_ENTRIES});
}

}  // namespace candela
