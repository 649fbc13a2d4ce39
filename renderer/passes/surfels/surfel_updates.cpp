#include "renderer/passes/surfels/surfel_updates.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <unordered_map>

#include <candela/graph/execute.hpp>
#include "renderer/passes/scene/changed_boxes.hpp"
#include "renderer/passes/surfels/surfel_visibility.hpp"

namespace candela {
namespace {

/// What the tasks of a frame depend on besides the surfels.
struct QueueKey {
    float ray_offset = 0.0F;       // metres
    std::uint32_t surfel_set = 0;  // its number
    bool operator==(const QueueKey&) const = default;
};

struct Queue {
    std::vector<TracedSurfel> surfels;  // by surfel of the last frame
    QueueKey key;
    std::uint64_t step = 0;               // of the scene's motion
    std::vector<std::vector<Box>> moved;  // SceneMotion::boxes of the last steps; at most most_steps
    [[nodiscard]] bool knows(std::uint64_t after) const { return step - after <= moved.size(); }
    bool operator==(const Queue&) const = default;
};

/// Steps of motion after which a surfel that has waited is traced as a whole.
constexpr std::size_t most_steps = 16;

/// SceneMotion::boxes of the steps before, and of this one.
std::vector<std::vector<Box>> last_steps(const SceneMotion& motion, const Queue* last) {
    if (last == nullptr) return {};
    if (motion.step == last->step) return last->moved;
    if (motion.everything || motion.step != last->step + 1) return {};
    std::vector<std::vector<Box>> steps = last->moved;
    steps.push_back(motion.boxes);
    if (steps.size() > most_steps) steps.erase(steps.begin());
    return steps;
}

/// Around what has moved after step number `step`, one of those that the queue knows.
std::vector<Box> moved_since(const Queue& queue, std::uint64_t step) {
    std::vector<Box> boxes;
    for (std::size_t i = queue.moved.size() - (queue.step - step); i < queue.moved.size(); ++i) {
        boxes.insert(boxes.end(), queue.moved[i].begin(), queue.moved[i].end());
    }
    return grouped(std::move(boxes), most_changed_boxes);
}

/// What has changed since the last frame.
struct Changes {
    bool everything = false;
    std::vector<Box> boxes;  // around each thing that has moved, enlarged by what rays may be off
};

/// The part of the half-space above a surfel that a box fills, about: that of the sphere around it. 0 if none
/// of the box is above. A map of the focus also sees what is below.
float share_of(const SurfelPlace& surfel, const Box& box) {
    const bool sees_below = surfel.map > SURFEL_MAP_SLOT;
    const glm::vec3 highest =
        glm::mix(box.lower, box.upper, glm::greaterThan(surfel.normal, glm::vec3(0.0F)));
    if (!sees_below && !(glm::dot(surfel.normal, highest - surfel.position) > 0.0F)) return 0.0F;
    const float distance = glm::distance(surfel.position, 0.5F * (box.lower + box.upper));
    const float radius = 0.5F * glm::distance(box.lower, box.upper);
    if (distance <= radius) return 1.0F;
    return 1.0F - std::sqrt(1.0F - radius * radius / (distance * distance));
}

float changed_share(const SurfelPlace& surfel, const Changes& changes) {
    if (changes.everything) return 1.0F;
    float share = 0.0F;
    for (const Box& box : changes.boxes) share += share_of(surfel, box);
    return std::min(share, 1.0F);
}

/// A surfel in this frame, before and after it is decided what is traced.
struct Candidate {
    TracedSurfel known;
    std::uint64_t id = 0;
    std::uint64_t map_key = 0;
    std::uint32_t task = 0;     // if its turn has come
    std::uint32_t instead = 0;  // if it waits
};

/// Whether the depth map that is there may be looked up. That of a surfel which has moved shows nearly what
/// it sees. Pictures of different foci have nothing in common.
bool is_usable(const TracedSurfel& known, std::uint64_t map_key, std::uint32_t map) {
    const bool of_focus = std::max(known.map, map) > SURFEL_MAP_SLOT;
    return known.has_map && known.map == map && (known.map_key == map_key || !of_focus);
}

/// A surfel as it is in this frame.
struct SurfelNow {
    std::uint64_t cell = 0;
    std::uint64_t id = 0;
    std::uint64_t map_key = 0;
    std::uint32_t map = 0;
    float weight = 0.0F;         // in its urgency
    float changed_share = 0.0F;  // of what it sees; 1 if anything may have changed
    bool sees_change = false;    // within the boxes that have changed
    bool knows_changes = false;  // if it has waited, where things have moved since
};

/// `last`: null if it was not there. `keeps_factors`: KeptSurfels::keeps_factors.
Candidate candidate(const TracedSurfel* last, const SurfelNow& now, bool keeps_factors) {
    Candidate out{.known = last != nullptr ? *last : TracedSurfel{}, .id = now.id, .map_key = now.map_key};
    TracedSurfel& known = out.known;
    const bool was_there = last != nullptr;
    known.cell = now.cell;
    known.in_place = known.in_place && keeps_factors && known.id == now.id;
    known.has_map = is_usable(known, now.map_key, now.map);
    if (!was_there || !keeps_factors) out.instead |= SURFEL_NO_FACTORS;
    if (!known.has_map && (!was_there || last->has_map || last->map != now.map)) out.instead |= SURFEL_NO_MAP;
    known.map = now.map;
    const bool is_elsewhere = !known.in_place;
    const bool has_other_map = !known.has_map || known.map_key != now.map_key;
    const bool anything_changed = now.changed_share > 0.0F && !now.sees_change;
    if (is_elsewhere) out.task |= SURFEL_COLUMN;
    const bool waited_long = known.waits && !now.knows_changes;
    if (is_elsewhere || has_other_map || anything_changed || waited_long) {
        out.task |= SURFEL_WHOLE;
    } else if (now.sees_change || known.waits) {
        out.task |= SURFEL_CHANGED;
    }
    known.urgency += now.weight * (is_elsewhere || has_other_map ? 1.0F : now.changed_share);
    return out;
}

/// The surfels whose turn has come: those that send no light as long as they wait, then the most urgent ones.
std::vector<bool> most_urgent(const std::vector<Candidate>& candidates, std::size_t limit) {
    std::vector<std::uint32_t> order;
    order.reserve(candidates.size());
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
        if (candidates[i].task != 0) order.push_back(i);
    }
    std::ranges::stable_sort(order, std::greater{}, [&](std::uint32_t i) {
        return std::pair(candidates[i].instead != 0, candidates[i].known.urgency);
    });
    std::vector<bool> chosen(candidates.size());
    for (std::size_t i = 0; i < std::min(limit, order.size()); ++i) chosen[order[i]] = true;
    return chosen;
}

/// What is known of the surfel after the frame. `step`: of the scene's motion.
TracedSurfel after(const Candidate& candidate, bool is_traced, std::uint64_t step) {
    TracedSurfel now = candidate.known;
    now.waits = !is_traced && candidate.task != 0;
    if (!now.waits) now.step = step;
    if (!is_traced) return now;
    now.id = candidate.id;
    now.map_key = candidate.map_key;
    now.in_place = now.has_map = true;
    now.urgency = 0.0F;
    return now;
}

/// Resources of the node.
struct UpdateNode {
    ValueHandle<SpreadSurfels> spread;
    Surfels surfels;
    Tracing tracing;
    ValueHandle<SceneMotion> motion;
    SurfelFoci foci;
    SurfelSetChoice set;
    ValueHandle<UpdateClock> clock;
    ValueHandle<Queue> queue;
    SurfelUpdates out;
};

Changes changes_since(const SceneMotion& motion, const Queue* last, float slack) {
    if (last != nullptr && motion.step == last->step) return {};
    if (last == nullptr || motion.everything || motion.step != last->step + 1)
        return {.everything = true, .boxes = {}};
    Changes changes{.everything = false, .boxes = motion.boxes};
    for (Box& box : changes.boxes) {
        box.lower -= slack;
        box.upper += slack;
    }
    return changes;
}

std::vector<std::uint64_t> cells_of(const Queue& queue) {
    std::vector<std::uint64_t> cells;
    cells.reserve(queue.surfels.size());
    for (const TracedSurfel& surfel : queue.surfels) cells.push_back(surfel.cell);
    return cells;
}

std::vector<Candidate> candidates(const Execution& run, const UpdateNode& node, const Queue* last,
                                  const Queue& now, const Changes& changes) {
    const std::vector<std::uint64_t>& ids = run.value(node.surfels.ids);
    const std::vector<std::uint64_t>& cells = run.value(node.surfels.cells);
    const std::vector<SurfelPlace>& places = run.value(node.surfels.places);
    const SurfelMaps& maps = run.value(node.surfels.maps);
    const std::vector<Focus>& foci = run.value(node.foci.foci);
    std::unordered_map<std::uint64_t, const TracedSurfel*> known;
    for (std::size_t i = 0; last != nullptr && i < last->surfels.size(); ++i) {
        known.emplace(last->surfels[i].cell, &last->surfels[i]);
    }
    const bool keeps_factors = last == nullptr || kept_surfels(cells_of(*last), cells).keeps_factors();
    std::vector<Candidate> all;
    all.reserve(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const auto found = known.find(cells[i]);
        const TracedSurfel* const before = found == known.end() ? nullptr : found->second;
        const float share = changed_share(places[i], changes);
        const SurfelNow surfel{.cell = cells[i],
                               .id = ids[i],
                               .map_key = i < maps.slots.size() ? maps.keys[maps.slots[i]] : 0,
                               .map = places[i].map,
                               .weight = places[i].area * density_at(foci, places[i].position),
                               .changed_share = share,
                               .sees_change = share > 0.0F && !changes.everything,
                               .knows_changes = before != nullptr && now.knows(before->step)};
        all.push_back(candidate(before, surfel, keeps_factors));
    }
    return all;
}

/// How many of the surfels may be traced in this frame. `is_other`: they are other ones than in the last
/// frame.
std::size_t limit(const Execution& run, const UpdateNode& node, std::size_t surfels, bool is_other) {
    constexpr std::size_t most_ahead = 256;  // about a quarter of a second on two cores of a CPU
    constexpr std::size_t parts = frames_a_surfel_set - 1;
    if (node.set.is_next(run)) return std::min((surfels + parts - 1) / parts, most_ahead);
    return is_other ? std::numeric_limits<std::size_t>::max() : run.value(node.clock).limit;
}

void plan(Execution& run, const UpdateNode& node) {
    const Queue* const last = run.previous(node.queue);
    const SceneMotion& motion = run.value(node.motion);
    const float ray_offset = run.value(node.tracing.metrics).ray_offset();
    const Changes changes = changes_since(motion, last, 4.0F * ray_offset);
    Queue now{.surfels = {},
              .key = {ray_offset, node.set.number(run)},
              .step = motion.step,
              .moved = last_steps(motion, last)};
    const std::vector<Candidate> all = candidates(run, node, last, now, changes);
    const bool is_other = last != nullptr && last->key != now.key;
    const std::vector<bool> chosen = most_urgent(all, limit(run, node, all.size(), is_other));
    const SurfelTasks* const tasks_before = run.previous(node.out.tasks);
    SurfelTasks tasks{
        .of = {}, .changed = {}, .number = tasks_before != nullptr ? tasks_before->number + 1 : 0};
    WaitingSurfels waiting{.to_be_traced = 0,
                           .maps = run.value(node.surfels.maps).outdated,
                           .to_be_placed = run.value(node.spread).set->left};
    std::uint64_t oldest = motion.step;  // state of surfels of which parts are traced
    now.surfels.reserve(all.size());
    tasks.of.reserve(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (chosen[i] && (all[i].task & SURFEL_CHANGED) != 0) oldest = std::min(oldest, all[i].known.step);
        now.surfels.push_back(after(all[i], chosen[i], motion.step));
        tasks.of.push_back(chosen[i] ? all[i].task : all[i].instead);
        if (now.surfels.back().waits) ++waiting.to_be_traced;
    }
    tasks.changed = moved_since(now, oldest);
    const auto is_same = [](const TracedSurfel& a, const TracedSurfel& b) { return a.cell == b.cell; };
    const bool same_surfels = last != nullptr && std::ranges::equal(last->surfels, now.surfels, is_same);
    const bool nothing = std::ranges::count(tasks.of, 0U) == static_cast<std::ptrdiff_t>(tasks.of.size());
    run.set(node.out.waiting, waiting);
    run.set(node.queue, std::move(now));
    // Where nothing is to be traced, the passes that trace need not run.
    if (!nothing || !same_surfels || tasks_before == nullptr) run.set(node.out.tasks, std::move(tasks));
}

}  // namespace

SurfelUpdates add_surfel_updates(FrameGraph& graph, ValueHandle<SpreadSurfels> spread, const Surfels& surfels,
                                 const Tracing& tracing, ValueHandle<SceneMotion> motion,
                                 const SurfelFoci& foci, const SurfelSetChoice& set,
                                 ValueHandle<UpdateClock> clock) {
    return graph.add("surfel-updates", [&](Pass& pass) {
        pass.keeps_state();
        pass.read(spread);
        pass.read(surfels.ids);
        pass.read(surfels.cells);
        pass.read(surfels.places);
        pass.read(surfels.maps);
        pass.read(tracing.metrics);
        pass.read(motion);
        pass.read(foci.foci);
        set.read(pass);
        pass.read(clock);
        const UpdateNode node{.spread = spread,
                              .surfels = surfels,
                              .tracing = tracing,
                              .motion = motion,
                              .foci = foci,
                              .set = set,
                              .clock = clock,
                              .queue = pass.update(graph.value<Queue>("queue of surfels")),
                              .out = {.tasks = pass.update(graph.value<SurfelTasks>("tasks of surfels")),
                                      .waiting = pass.write(graph.value<WaitingSurfels>("waiting surfels"))}};
        pass.run([=](Execution& run) { plan(run, node); });
        return node.out;
    });
}

}  // namespace candela
