#include "renderer/passes/surfels/surfels.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/scene/traced_content.hpp"
#include "renderer/passes/surfels/cell_division.hpp"
#include "renderer/passes/surfels/surfel_ids.hpp"

namespace candela {
namespace {

VplCounts counts_of(const SurfelSet& set) {
    return {.surfels = static_cast<std::uint32_t>(set.surfels.size()) - set.emitting_count,
            .emitters = set.emitting_count};
}

/// What rays have found about the cells of a set: see TracedContent.
struct DivisionKey {
    float ray_offset = 0.0F;  // metres
    bool divides_emitters = false;
    bool operator==(const DivisionKey&) const = default;
};

/// The last division of the cells.
struct DividedCells {
    std::vector<std::uint64_t> ids;  // SurfelSet::ids
    std::vector<CellDivision> cells;
    ScenePlacement placement;
    bool operator==(const DividedCells&) const = default;
};

bool has_moved(const ScenePlacement& before, const ScenePlacement& now, std::uint32_t item) {
    const auto shape_in = [&](const ScenePlacement& placement) {
        const Deformation* const deformed = find_deformation(placement.deformed, item);
        return deformed == nullptr ? nullptr : deformed->vertices.get();
    };
    return before.world[item] != now.world[item] || shape_in(before) != shape_in(now);
}

/// Divides new cells, and those again that have moved, or where something in a changed box is or was; those
/// of `last` stay elsewhere. All, if `changed` is none. `order`: as for divide_cell.
DividedCells divide_cells(const SurfelSet& set, const TracedScene& scene,
                          std::span<const std::uint32_t> order, float ray_offset, const DividedCells* last,
                          const std::optional<std::vector<Box>>& changed) {
    std::unordered_map<std::uint64_t, const CellDivision*> known;
    for (std::size_t i = 0; last != nullptr && changed && i < last->ids.size(); ++i) {
        known.emplace(last->ids[i], &last->cells[i]);
    }
    const auto stays = [&](std::size_t i) {
        if (has_moved(last->placement, scene.placement, set.item_of[i])) return false;
        const Box box = box_of_division(set, i, ray_offset);
        return std::ranges::none_of(*changed, [&](const Box& other) { return meet(box, other, ray_offset); });
    };
    DividedCells now{.ids = set.ids, .cells = {}, .placement = scene.placement};
    now.cells.reserve(set.surfels.size());
    for (std::size_t i = 0; i < set.surfels.size(); ++i) {
        const auto found = known.find(set.ids[i]);
        const bool is_known = found != known.end() && stays(i);
        now.cells.push_back(is_known ? *found->second : divide_cell(set, i, scene, order, ray_offset));
    }
    return now;
}

std::vector<SurfelPlace> places_of(const SurfelSet& set) {
    std::vector<SurfelPlace> places;
    places.reserve(set.surfels.size());
    for (const gpu::Surfel& surfel : set.surfels) {
        places.push_back({surfel.position, surfel.normal, surfel.area, surfel.map});
    }
    return places;
}

std::vector<CellPlace> cell_places_of(const SurfelSet& set) {
    std::vector<CellPlace> places;
    places.reserve(set.points.size());
    for (std::size_t i = 0; i < set.points.size(); ++i) {
        places.push_back({set.point_places[i], set.points[i].area, set.points[i].surfel});
    }
    return places;
}

/// Resources of the node.
struct SurfelNode {
    SceneData scene;
    Tracing tracing;
    ValueHandle<SceneMotion> motion;
    ValueHandle<SpreadSurfels> spread;
    ValueHandle<Focus> focus_of_maps;
    std::optional<ValueHandle<UpdateClock>> clock;
    std::uint32_t wanted = 0;
    ValueHandle<DividedCells> divided;
    TracedContent<DivisionKey> known;
    Surfels out;
};

/// Of surfels that stay, in a frame: a quarter of those that may be traced.
std::uint32_t most_new_maps(const Execution& run, const SurfelNode& node) {
    const std::uint32_t limit = node.clock ? run.value(*node.clock).limit : node.wanted;
    return limit < node.wanted ? (limit + 3) / 4 : std::numeric_limits<std::uint32_t>::max();
}

void place_surfels(const Gpu& gpu, Execution& run, const SurfelNode& node) {
    const Surfels& out = node.out;
    const TracedScene traced{*run.value(node.tracing.hierarchy), run.value(node.scene.layout),
                             run.value(node.scene.placement)};
    const float ray_offset = run.value(node.tracing.metrics).ray_offset();
    const SurfelSet whole = placed_in_world(run.value(node.spread), traced.placement);
    const DivisionKey key{ray_offset, divides_emitters(whole)};
    const auto changed = node.known.outdated(run, run.value(node.motion), key, {});
    DividedCells cells = divide_cells(whole, traced, order_of_solids(traced.layout), ray_offset,
                                      run.previous(node.divided), changed);
    SurfelSet set = divided(whole, cells.cells);
    run.set(node.divided, std::move(cells));
    const VplCounts counts = counts_of(set);
    std::vector<std::uint64_t> cell_ids = set.patches;
    make_unique(cell_ids);
    set.ids = content_hashes(set);
    make_unique(set.ids);
    run.set(out.maps,
            place_maps(std::span(set.surfels).first(counts.surfels), cell_ids, set.ids,
                       run.value(node.focus_of_maps), run.previous(out.maps), most_new_maps(run, node)));
    upload<gpu::Surfel>(gpu, run, out.surfels, set.surfels);
    upload<gpu::CellPoint>(gpu, run, out.points, set.points);
    run.set(out.counts, counts);
    run.set(out.point_count, static_cast<std::uint32_t>(set.points.size()));
    run.set(out.places, places_of(set));
    run.set(out.cell_places, cell_places_of(set));
    run.set(out.ids, std::move(set.ids));
    run.set(out.cells, std::move(cell_ids));
}

}  // namespace

Surfels add_surfels(FrameGraph& graph, const Gpu& gpu, const SceneData& scene, const Tracing& tracing,
                    ValueHandle<SceneMotion> motion, ValueHandle<SpreadSurfels> spread,
                    ValueHandle<Focus> focus_of_maps, std::uint32_t wanted,
                    std::optional<ValueHandle<UpdateClock>> clock) {
    return graph.add("surfels", [&](Pass& pass) {
        pass.read(spread);
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(tracing.hierarchy);
        pass.read(tracing.metrics);
        pass.read(motion);
        pass.read(focus_of_maps);
        if (clock) pass.read(*clock);
        pass.keeps_state();
        const Surfels out{
            .counts = pass.write(graph.value<VplCounts>("surfel counts")),
            .point_count = pass.write(graph.value<std::uint32_t>("cell point count")),
            .ids = pass.write(graph.value<std::vector<std::uint64_t>>("surfel ids")),
            .cells = pass.write(graph.value<std::vector<std::uint64_t>>("surfel cells")),
            .places = pass.write(graph.value<std::vector<SurfelPlace>>("surfel places")),
            .cell_places = pass.write(graph.value<std::vector<CellPlace>>("places of cell points")),
            .maps = pass.update(graph.value<SurfelMaps>("surfel maps")),
            .surfels = pass.write(growing_buffer<gpu::Surfel>(graph, "surfels"), Usage::copy),
            .points = pass.write(growing_buffer<gpu::CellPoint>(graph, "cell points"), Usage::copy)};
        const SurfelNode node{.scene = scene,
                              .tracing = tracing,
                              .motion = motion,
                              .spread = spread,
                              .focus_of_maps = focus_of_maps,
                              .clock = clock,
                              .wanted = wanted,
                              .divided = pass.update(graph.value<DividedCells>("divided cells")),
                              .known = TracedContent<DivisionKey>(graph, pass, "known division"),
                              .out = out};
        pass.run([=, &gpu](Execution& run) { place_surfels(gpu, run, node); });
        return out;
    });
}

}  // namespace candela
