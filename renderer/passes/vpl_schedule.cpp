#include "renderer/passes/vpl_schedule.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "renderer/passes/emission_cells.hpp"
#include "renderer/passes/vpl_weights.hpp"

namespace candela {
namespace {

constexpr std::uint32_t no_tile = 0xffffffffU;
// A path of a moving light is worth moving where the empty circle that it would fill is this many times as
// large as the cell that it leaves. Each move shows as a change of light, so that it must be worth it.
constexpr double worthwhile_gain = 16.0;

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
          by_light_(paths_by_light(plan.paths, lights)),
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
            [&](const gpu::Path& path, const PathMemory&) { return path.bounces < path.vpl_count; });
        std::ranges::stable_sort(
            missing, {}, [&](std::uint32_t i) { return std::tuple(path(i).bounces > 0, path(i).index); });
        for (const std::uint32_t i : missing) {
            if (!afford(path(i).vpl_count - path(i).bounces)) {
                continue;
            }
            if (path(i).bounces == 0) {
                begin(i, moved_[path(i).light] != 0 ? thinnest_place(i) : std::nullopt);
            }
            path(i).bounces = path(i).vpl_count;
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
        for (const LightPaths& light : by_light_) {
            const bool moves = moved_[path(light.first).light] != 0;
            for (std::uint32_t bounces = longest_path(next_.paths.paths, light); moves && bounces > 0;
                 --bounces) {
                spread(light, bounces);
            }
        }
    }

    VplMemory finish() {
        give_tiles();
        for (const gpu::Path& path : next_.paths.paths) {
            next_.paths.debt += path.vpl_count - path.bounces;
        }
        for (std::uint32_t i = 0; i < next_.memories.size(); ++i) {
            next_.paths.stale += memory(i).canonical ? 0 : path(i).bounces;
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
        path(i).bounces = path(i).kept = 0;
        if (known != no_path) {
            const gpu::Path& before = old.paths.paths[known];
            path(i).bounces = std::min(before.bounces, path(i).vpl_count);
            memory(i) = old.memories[known];
        }
        if (!checks.paths.empty()) {
            const CheckedLength& check = checks.paths[i];
            path(i).bounces = std::min(path(i).bounces, check.bounces);
            memory(i).start = check.start;
            memory(i).canonical_start = check.canonical_start;
            memory(i).located = true;
        }
        path(i).kept = path(i).bounces;
        // What is kept goes on by the sequence that it was begun by.
        path(i).seed = path(i).bounces > 0 ? old.paths.paths[known].seed : path(i).seed;
        const bool in_plan = path(i).seed == plan_.paths[i].seed && moved_[path(i).light] == 0;
        memory(i).canonical = memory(i).canonical && in_plan && path(i).bounces > 0;
        for (std::uint32_t bounce = 0; bounce < path(i).bounces; ++bounce) {
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

    [[nodiscard]] const LightPaths& paths_beside(std::uint32_t i) const {
        return *std::ranges::upper_bound(by_light_, i, {}, &LightPaths::last);
    }

    [[nodiscard]] EmissionCells cells_of(gpu::LightKind kind, const std::vector<std::uint32_t>& paths) const {
        return emission_cells(starts_on_sphere(next_, kind, paths), emission_domain(kind));
    }

    /// Where those paths of the light of path `i` are sparsest that get as far as it; nothing if none do.
    std::optional<glm::vec2> thinnest_place(std::uint32_t i) {
        const LightPaths& light = paths_beside(i);
        const auto present =
            paths_of(light, [&](std::uint32_t j) { return path(j).bounces >= path(i).vpl_count; });
        const auto thinnest = thinnest_places(cells_of(light.kind, present), 1);
        if (thinnest.empty()) {
            return std::nullopt;
        }
        return glm::vec2(from_emission_domain(light.kind, thinnest.front().centre));
    }

    /// Moves paths of so many bounces, among all that get as far.
    void spread(const LightPaths& light, std::uint32_t bounces) {
        const auto there = paths_of(light, [&](std::uint32_t i) { return path(i).bounces >= bounces; });
        const EmissionCells cells = cells_of(light.kind, there);
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
            begin(there[densest[k]], glm::vec2(from_emission_domain(light.kind, places[k].centre)));
        }
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
                if (bounce < path.bounces && tile == no_tile) {
                    free = next_free(taken, free);
                    taken[free] = 1;
                    tile = free;
                }
                if (bounce >= path.kept && bounce < path.bounces) {
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
    std::vector<LightPaths> by_light_;
    VplMemory next_;
};

}  // namespace

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
    VplMemory next = draft.finish();
    weigh_by_cells(next, lights);
    return next;
}

}  // namespace candela
