#include "renderer/passes/vpl_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "renderer/passes/emission_cells.hpp"

namespace candela {
namespace {

constexpr std::uint32_t no_tile = 0xffffffffU;
// A path of a moving light is worth moving where the empty circle that it would fill is this many times as
// large as the cell that it leaves. Each move shows as a change of light, so that it must be worth it.
constexpr double worthwhile_gain = 16.0;

using LightKey = std::tuple<Entity, gpu::LightKind>;

/// The paths of one light; plans have them in a row.
struct PathRange {
    std::uint32_t first;
    std::uint32_t last;  ///< one behind
};

std::vector<PathRange> ranges_of(const std::vector<gpu::Path>& paths) {
    std::vector<PathRange> ranges;
    for (std::uint32_t i = 0; i < paths.size(); ++i) {
        if (i == 0 || paths[i].light != paths[i - 1].light) {
            ranges.push_back({i, i});
        }
        ranges.back().last = i + 1;
    }
    return ranges;
}

/// Mean of the channels.
double mean_of(glm::vec3 colour) {
    return (static_cast<double>(colour.r) + static_cast<double>(colour.g) + static_cast<double>(colour.b)) /
           3.0;
}

/// Whether two plans have the same paths of the same points; `known` tells which of the first are which of
/// the second.
bool same_sequences(const VplPaths& a, const VplPaths& b, const std::vector<std::uint32_t>& known) {
    bool same = a.seed == b.seed && a.paths.size() == b.paths.size();
    for (std::uint32_t i = 0; same && i < known.size(); ++i) {
        same = known[i] == i && a.paths[i].vpl_count == b.paths[i].vpl_count;
    }
    return same;
}

/// Whether something of the box lies in front of the VPL's surface.
bool may_see(const RecordedVpl& vpl, const Box& box) {
    const glm::vec3 farthest = glm::mix(box.lower, box.upper, glm::greaterThan(vpl.normal, glm::vec3(0.0F)));
    return glm::dot(farthest - vpl.position, vpl.normal) > 0.0F;
}

/// A schedule in the making. The steps are called in the order in which they stand here.
class Draft {
 public:
    Draft(const VplPaths& plan, const LightTable& lights, const VplMemory& memory, const VplChecks& checks,
          const ScheduleSettings& settings)
        : plan_(plan),
          lights_(lights),
          settings_(settings),
          left_(settings.budget),
          moved_(moved_lights(lights, memory)),
          next_{.paths = plan,
                .memories = std::vector<PathMemory>(plan.paths.size()),
                .maps = memory.maps,
                .lights = lights.entries,
                .plan_areas = {}} {
        next_.maps.resize(settings.tiles);
        next_.paths.map_count = plan.paths.empty() ? 0 : settings.tiles;
        next_.paths.maps_due.clear();
        for (gpu::VplPlace& place : next_.paths.places) {
            place.tile = no_tile;
        }
        const std::vector<std::uint32_t> known = match_paths(plan, lights, memory);
        for (std::uint32_t i = 0; i < known.size(); ++i) {
            adopt(i, known[i], memory, checks);
        }
        next_.plan_areas.resize(plan.places.size());
        if (same_sequences(plan, memory.paths, known)) {
            next_.plan_areas = memory.plan_areas;
        }
    }

    /// Paths and bounces that there should be.
    void trace_missing() {
        std::vector<std::uint32_t> missing = paths_where(
            [&](const gpu::Path& path, const PathMemory&) { return path.length < path.vpl_count; });
        std::ranges::stable_sort(
            missing, {}, [&](std::uint32_t i) { return std::tuple(path(i).length > 0, path(i).index); });
        for (const std::uint32_t i : missing) {
            if (!afford(path(i).vpl_count - path(i).length)) {
                continue;
            }
            if (path(i).length == 0) {
                begin(i, moved_[path(i).light] != 0 ? thinnest_place(i) : std::nullopt);
            }
            path(i).length = path(i).vpl_count;
        }
    }

    /// Maps whose content has moved. `checks` tells what has moved since the last schedule.
    void redraw_maps(const VplChecks& checks) {
        if (!settings_.maps) {
            return;
        }
        std::vector<std::uint32_t> stale;
        for_kept_places([&](std::uint32_t place) {
            if (note_age(next_.paths.places[place].tile, checks) > 0) {
                stale.push_back(place);
            }
        });
        const std::vector<double> flux = plan_flux();
        std::ranges::stable_sort(stale, std::greater<>{}, [&](std::uint32_t place) {
            const StaleMap& map = next_.maps[next_.paths.places[place].tile];
            return flux[place] * static_cast<double>(map.throughput) * map.age;
        });
        const std::size_t affordable = std::min<std::size_t>(left_, stale.size());
        next_.paths.maps_due.assign(stale.begin(), stale.begin() + static_cast<std::ptrdiff_t>(affordable));
        left_ -= static_cast<std::uint32_t>(affordable);
        for (const std::uint32_t place : next_.paths.maps_due) {
            next_.maps[next_.paths.places[place].tile] = {};
        }
    }

    /// Paths of lights that stand still, for what full regeneration would have in their place.
    void settle() {
        std::vector<std::uint32_t> unsettled = paths_where([&](const gpu::Path& p, const PathMemory& memory) {
            return !memory.canonical && p.kept == p.vpl_count && moved_[p.light] == 0;
        });
        std::ranges::stable_sort(unsettled, {}, [&](std::uint32_t i) { return path(i).index; });
        for (const std::uint32_t i : unsettled) {
            if (afford(path(i).vpl_count)) {
                begin(i, std::nullopt);
            }
        }
    }

    /// Paths of moving lights, from where they are dense to where they are sparse.
    void spread() {
        for (const PathRange range : ranges_of(next_.paths.paths)) {
            const bool moves = moved_[path(range.first).light] != 0;
            for (std::uint32_t bounces = longest(range); moves && bounces > 0; --bounces) {
                spread(range, bounces);
            }
        }
    }

    void weigh() {
        for (const PathRange range : ranges_of(next_.paths.paths)) {
            const auto settled = [&](std::uint32_t i) {
                return memory(i).canonical && path(i).length == path(i).vpl_count;
            };
            const auto all = indices(range, [](std::uint32_t) { return true; });
            if (std::ranges::all_of(all, settled)) {
                continue;
            }
            for (std::uint32_t bounce = 0; bounce < longest(range); ++bounce) {
                weigh(range, bounce);
            }
        }
    }

    VplMemory finish() {
        give_tiles();
        for (const gpu::Path& path : next_.paths.paths) {
            next_.paths.debt += path.vpl_count - path.length;
        }
        for (std::uint32_t i = 0; i < next_.memories.size(); ++i) {
            next_.paths.stale += memory(i).canonical ? 0 : path(i).length;
        }
        next_.paths.debt += static_cast<std::uint32_t>(
            std::ranges::count_if(next_.maps, [](const StaleMap& map) { return map.age > 0; }));
        return std::move(next_);
    }

 private:
    gpu::Path& path(std::uint32_t i) { return next_.paths.paths[i]; }
    PathMemory& memory(std::uint32_t i) { return next_.memories[i]; }

    /// Takes over what still holds of a path in the memory; `known` may be `no_path`.
    void adopt(std::uint32_t i, std::uint32_t known, const VplMemory& old, const VplChecks& checks) {
        const LightTable::Entry& light = lights_.entries[path(i).light];
        memory(i) = {.light = light.entity, .index = path(i).index};
        path(i).length = path(i).kept = 0;
        if (known != no_path) {
            const gpu::Path& before = old.paths.paths[known];
            path(i).length = std::min(before.length, path(i).vpl_count);
            memory(i) = old.memories[known];
        }
        if (!checks.paths.empty()) {
            const CheckedLength& check = checks.paths[i];
            path(i).length = std::min(path(i).length, check.length);
            memory(i).start = check.start;
            memory(i).canonical_start = check.canonical_start;
            memory(i).located = true;
        }
        path(i).kept = path(i).length;
        // What is kept goes on by the sequence that it was begun by.
        path(i).seed = path(i).length > 0 ? old.paths.paths[known].seed : path(i).seed;
        const bool in_plan = path(i).seed == plan_.paths[i].seed && moved_[path(i).light] == 0;
        memory(i).canonical = memory(i).canonical && in_plan && path(i).length > 0;
        for (std::uint32_t bounce = 0; bounce < path(i).length; ++bounce) {
            const std::uint32_t place = old.paths.paths[known].first_vpl + bounce;
            next_.paths.places[path(i).first_vpl + bounce].tile = old.paths.places[place].tile;
        }
    }

    /// Whether so many bounces fit into the budget; then they are taken off it.
    bool afford(std::uint32_t bounces) {
        const bool fits = bounces <= left_ || left_ == settings_.budget;
        left_ -= fits ? std::min(bounces, left_) : 0;
        return fits;
    }

    /// The path is traced from a place on its light on, or from its point of the sequence.
    void begin(std::uint32_t i, std::optional<glm::vec2> start) {
        path(i).kept = 0;
        path(i).seed = plan_.paths[i].seed;
        path(i).start = start.value_or(glm::vec2(-1.0F));
        memory(i).canonical = !start;
        memory(i).start = start.value_or(memory(i).canonical_start);
    }

    template <class Predicate>
    std::vector<std::uint32_t> paths_where(Predicate predicate) {
        std::vector<std::uint32_t> found;
        for (std::uint32_t i = 0; i < next_.memories.size(); ++i) {
            if (predicate(path(i), memory(i))) {
                found.push_back(i);
            }
        }
        return found;
    }

    template <class Predicate>
    static std::vector<std::uint32_t> indices(PathRange range, Predicate predicate) {
        std::vector<std::uint32_t> found;
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            if (predicate(i)) {
                found.push_back(i);
            }
        }
        return found;
    }

    std::uint32_t longest(PathRange range) {
        std::uint32_t bounces = 0;
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            bounces = std::max(bounces, path(i).vpl_count);
        }
        return bounces;
    }

    [[nodiscard]] gpu::LightKind kind_of(std::uint32_t i) {
        return lights_.entries[path(i).light].light.kind;
    }

    std::vector<glm::dvec3> starts_of(const std::vector<std::uint32_t>& paths) {
        std::vector<glm::dvec3> points;
        points.reserve(paths.size());
        for (const std::uint32_t i : paths) {
            points.push_back(to_emission_domain(kind_of(i), memory(i).start));
        }
        return points;
    }

    PathRange range_around(std::uint32_t i) {
        PathRange range{i, i + 1};
        while (range.first > 0 && path(range.first - 1).light == path(i).light) {
            --range.first;
        }
        while (range.last < next_.memories.size() && path(range.last).light == path(i).light) {
            ++range.last;
        }
        return range;
    }

    /// Where those paths of the light of path `i` are sparsest that get as far as it; nothing if none do.
    std::optional<glm::vec2> thinnest_place(std::uint32_t i) {
        const auto present =
            indices(range_around(i), [&](std::uint32_t j) { return path(j).length >= path(i).vpl_count; });
        const auto thinnest =
            thinnest_places(emission_cells(starts_of(present), emission_domain(kind_of(i))), 1);
        if (thinnest.empty()) {
            return std::nullopt;
        }
        return glm::vec2(from_emission_domain(kind_of(i), thinnest.front().centre));
    }

    /// Moves paths of so many bounces, among all that get as far.
    void spread(PathRange range, std::uint32_t bounces) {
        const auto there = indices(range, [&](std::uint32_t i) { return path(i).length >= bounces; });
        const EmissionDomain domain = emission_domain(kind_of(range.first));
        const EmissionCells cells = emission_cells(starts_of(there), domain);
        const std::vector<EmptyCircle> places = thinnest_places(cells, left_);
        std::vector<std::uint32_t> densest(there.size());
        std::iota(densest.begin(), densest.end(), 0U);
        std::erase_if(densest, [&](std::uint32_t k) {
            return path(there[k]).vpl_count != bounces || path(there[k]).kept == 0;
        });
        std::ranges::stable_sort(densest, {}, [&](std::uint32_t k) { return cells.areas[k]; });
        for (std::size_t k = 0; k < std::min(places.size(), densest.size()) && bounces <= left_; ++k) {
            const double gap = 2.0 * std::numbers::pi * (1.0 - places[k].cosine);
            if (gap < worthwhile_gain * cells.areas[densest[k]]) {
                return;
            }
            left_ -= bounces;
            begin(there[densest[k]], glm::vec2(from_emission_domain(kind_of(range.first), places[k].centre)));
        }
    }

    void weigh(PathRange range, std::uint32_t bounce) {
        const auto planned = indices(range, [&](std::uint32_t i) { return path(i).vpl_count > bounce; });
        const auto there = indices(range, [&](std::uint32_t i) { return path(i).length > bounce; });
        const std::vector<double> factors = departures(planned, bounce);
        const EmissionDomain domain = emission_domain(kind_of(range.first));
        std::vector<double> shares = emission_cells(starts_of(there), domain).areas;
        double of_all = 0.0;
        for (std::size_t k = 0; k < there.size(); ++k) {
            const auto in_plan = std::ranges::lower_bound(planned, there[k]) - planned.begin();
            shares[k] *= factors[static_cast<std::size_t>(in_plan)];
            of_all += shares[k];
        }
        double sum = 0.0;
        for (const std::uint32_t i : planned) {
            sum += static_cast<double>(weight(i, bounce));
        }
        for (std::size_t k = 0; k < there.size(); ++k) {
            weight(there[k], bounce) = static_cast<float>(sum * shares[k] / of_all);
        }
    }

    float& weight(std::uint32_t i, std::uint32_t bounce) {
        return next_.paths.places[path(i).first_vpl + bounce].weight;
    }

    /// By how much the plan's weight, which all of these paths share, departs from their cells' in the
    /// diagram of their points of the sequence; the less, the farther a path starts from there, and not at
    /// all from the mean distance between paths on. So a light's first small move does not show as a change
    /// from the plan's weights to the cells', nor does its last.
    std::vector<double> departures(const std::vector<std::uint32_t>& planned, std::uint32_t bounce) {
        std::vector<glm::dvec3> points;
        points.reserve(planned.size());
        for (const std::uint32_t i : planned) {
            points.push_back(to_emission_domain(kind_of(i), memory(i).canonical_start));
        }
        const EmissionDomain domain = emission_domain(kind_of(planned.front()));
        const double cell = area_of(domain) / static_cast<double>(planned.size());
        const auto area_of_path = [&](std::uint32_t i) -> double& {
            return next_.plan_areas[path(i).first_vpl + bounce];
        };
        if (area_of_path(planned.front()) == 0.0) {
            const std::vector<double> areas = emission_cells(points, domain).areas;
            for (std::size_t k = 0; k < planned.size(); ++k) {
                area_of_path(planned[k]) = areas[k];
            }
        }
        const std::vector<glm::dvec3> starts = starts_of(planned);
        std::vector<double> factors;
        factors.reserve(planned.size());
        for (std::size_t k = 0; k < planned.size(); ++k) {
            const double nearness =
                std::max(0.0, 1.0 - glm::distance(points[k], starts[k]) / std::sqrt(cell));
            const double area = area_of_path(planned[k]);
            factors.push_back(area > 0.0 ? glm::mix(1.0, cell / area, nearness) : 1.0);
        }
        return factors;
    }

    template <class Visit>
    void for_kept_places(Visit visit) {
        for (const gpu::Path& path : next_.paths.paths) {
            for (std::uint32_t bounce = 0; bounce < path.kept; ++bounce) {
                visit(path.first_vpl + bounce);
            }
        }
    }

    /// Gives how old the tile's map now is.
    std::uint32_t note_age(std::uint32_t tile, const VplChecks& checks) {
        StaleMap& map = next_.maps[tile];
        const bool outdated = !checks.moved.empty() && std::ranges::any_of(checks.moved, [&](const Box& box) {
            return may_see(checks.records[tile], box);
        });
        if (outdated) {
            map.throughput = checks.records[tile].throughput;
        }
        map.age += outdated || map.age > 0 ? 1 : 0;
        map = map.throughput > 0.0F ? map : StaleMap{};
        return map.age;
    }

    /// Flux, mean of the channels, that paths carry into each place as the plan has it.
    std::vector<double> plan_flux() {
        std::vector<double> flux(next_.paths.places.size());
        for (const gpu::Path& path : next_.paths.paths) {
            for (std::uint32_t bounce = 0; bounce < path.vpl_count; ++bounce) {
                const std::uint32_t place = path.first_vpl + bounce;
                flux[place] = mean_of(path.flux) * static_cast<double>(next_.paths.places[place].weight);
            }
        }
        return flux;
    }

    /// Bounces that are traced keep the tile of the bounce that they replace, or get one that nobody has.
    void give_tiles() {
        std::vector<std::uint8_t> taken(settings_.tiles, 0);
        for (const gpu::VplPlace& place : next_.paths.places) {
            if (place.tile != no_tile) {
                taken[place.tile] = 1;
            }
        }
        std::uint32_t free = 0;
        for (const gpu::Path& path : next_.paths.paths) {
            for (std::uint32_t bounce = 0; bounce < path.vpl_count; ++bounce) {
                const std::uint32_t place = path.first_vpl + bounce;
                std::uint32_t& tile = next_.paths.places[place].tile;
                if (bounce < path.length && tile == no_tile) {
                    free = next_free(taken, free);
                    taken[free] = 1;
                    tile = free;
                }
                if (bounce >= path.kept && bounce < path.length) {
                    next_.paths.maps_due.push_back(place);
                    next_.maps[tile] = {};
                }
                tile = tile == no_tile ? 0 : tile;  // of a VPL that is not alive: nobody looks at it
            }
        }
        for (std::uint32_t tile = 0; tile < settings_.tiles; ++tile) {
            next_.maps[tile] = taken[tile] != 0 ? next_.maps[tile] : StaleMap{};
        }
    }

    static std::uint32_t next_free(const std::vector<std::uint8_t>& taken, std::uint32_t from) {
        return static_cast<std::uint32_t>(std::find(taken.begin() + from, taken.end(), std::uint8_t{0}) -
                                          taken.begin());
    }

    const VplPaths& plan_;
    const LightTable& lights_;
    const ScheduleSettings& settings_;
    std::uint32_t left_;
    std::vector<std::uint8_t> moved_;
    VplMemory next_;
};

}  // namespace

std::vector<std::uint32_t> match_paths(const VplPaths& plan, const LightTable& lights,
                                       const VplMemory& memory) {
    std::map<std::tuple<LightKey, std::uint32_t>, std::uint32_t> known;
    for (std::uint32_t k = 0; k < memory.memories.size(); ++k) {
        const PathMemory& path = memory.memories[k];
        const gpu::LightKind kind = memory.lights[memory.paths.paths[k].light].light.kind;
        known.emplace(std::tuple(LightKey(path.light, kind), path.index), k);
    }
    std::vector<std::uint32_t> matches;
    matches.reserve(plan.paths.size());
    for (const gpu::Path& path : plan.paths) {
        const LightTable::Entry& light = lights.entries[path.light];
        const auto found = known.find(std::tuple(LightKey(light.entity, light.light.kind), path.index));
        matches.push_back(found == known.end() ? no_path : found->second);
    }
    return matches;
}

bool emits_differently(const gpu::Light& a, const gpu::Light& b) {
    return a.kind != b.kind || a.position != b.position || a.direction != b.direction || a.shape != b.shape ||
           a.cos_inner != b.cos_inner || a.cos_outer != b.cos_outer;
}

std::vector<std::uint8_t> moved_lights(const LightTable& lights, const VplMemory& memory) {
    std::map<LightKey, const gpu::Light*> before;
    for (const LightTable::Entry& entry : memory.lights) {
        before.emplace(LightKey(entry.entity, entry.light.kind), &entry.light);
    }
    std::vector<std::uint8_t> moved;
    moved.reserve(lights.entries.size());
    for (const LightTable::Entry& entry : lights.entries) {
        const auto found = before.find(LightKey(entry.entity, entry.light.kind));
        moved.push_back(found != before.end() && emits_differently(entry.light, *found->second) ? 1 : 0);
    }
    return moved;
}

VplMemory schedule_all(const VplPaths& plan, const LightTable& lights, const ScheduleSettings& settings) {
    VplMemory memory{.paths = plan,
                     .memories = {},
                     .maps = std::vector<StaleMap>(settings.tiles),
                     .lights = lights.entries,
                     .plan_areas = std::vector<double>(plan.places.size())};
    memory.memories.reserve(plan.paths.size());
    for (const gpu::Path& path : plan.paths) {
        memory.memories.push_back(
            {.light = lights.entries[path.light].entity, .index = path.index, .canonical = true});
    }
    memory.paths.map_count = plan.paths.empty() ? 0 : settings.tiles;
    return memory;
}

VplMemory schedule(const VplPaths& plan, const LightTable& lights, const VplMemory& memory,
                   const VplChecks& checks, const ScheduleSettings& settings) {
    Draft draft(plan, lights, memory, checks, settings);
    draft.trace_missing();
    draft.redraw_maps(checks);
    draft.settle();
    draft.spread();
    draft.weigh();
    return draft.finish();
}

}  // namespace candela
