#include "renderer/passes/scene/scene_motion.hpp"

#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/passes/scene/changed_boxes.hpp"
#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {
namespace {

/// One box around both places, if fewer rays meet it than the two: about as many as its surface is large.
void add_moved(const Box& before, const Box& now, std::vector<Box>& boxes) {
    const auto size = [](const Box& box) { return half_area(box.lower, box.upper); };
    Box both = before;
    both.grow(now);
    if (size(both) <= size(before) + size(now)) {
        boxes.push_back(both);
        return;
    }
    boxes.push_back(before);
    boxes.push_back(now);
}

/// World-space boxes around the solid drawables of the items that moved, at their old and new places.
std::vector<Box> moved_boxes(const SceneLayout& layout, const ScenePlacement& before,
                             const ScenePlacement& now) {
    std::vector<Box> boxes;
    for (const std::uint32_t i : moved_solids(layout, before, now)) {
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        add_moved(place_box(bounds_of(drawable, before.deformed), before.world[drawable.item]),
                  place_box(bounds_of(drawable, now.deformed), now.world[drawable.item]), boxes);
    }
    return boxes;
}

}  // namespace

ValueHandle<SceneMotion> add_scene_motion(FrameGraph& graph, const SceneData& scene,
                                          ValueHandle<std::uint64_t> epoch) {
    return graph.add("scene-motion", [&](Pass& pass) {
        pass.keeps_state();
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(epoch);
        const auto motion = pass.update(graph.value<SceneMotion>("scene motion"));
        pass.run([=, layout = scene.layout, placement = scene.placement](Execution& run) {
            const SceneMotion* const last = run.previous(motion);
            SceneMotion now;
            now.epoch = run.value(epoch);
            now.geometry = run.value(layout).geometry;
            now.placement = run.value(placement);
            if (last != nullptr) {
                now.step = last->step + 1;
                now.everything = last->epoch != now.epoch || last->geometry != now.geometry;
            }
            if (!now.everything) {
                now.boxes = grouped(moved_boxes(run.value(layout), last->placement, now.placement),
                                    most_changed_boxes);
            }
            run.set(motion, std::move(now));
        });
        return motion;
    });
}

std::optional<std::vector<Box>> changed_boxes(const SceneMotion& motion, std::uint64_t done) {
    if (motion.step == done) return std::vector<Box>{};
    if (motion.everything || motion.step != done + 1) return std::nullopt;
    return motion.boxes;
}

}  // namespace candela
