#include "renderer/passes/scene/scene_motion.hpp"

#include <glm/vec4.hpp>
#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/passes/scene/world_triangles.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

/// World-space boxes around the solid drawables of the items that moved, at their old and new places.
std::vector<Box> moved_boxes(const SceneLayout& layout, const ScenePlacement& before,
                             const ScenePlacement& now) {
    std::vector<Box> boxes;
    for (const SceneLayout::Drawable& drawable : layout.solids()) {
        const glm::mat4& from = before.world[drawable.item];
        const glm::mat4& to = now.world[drawable.item];
        if (from != to ||
            vertices_of(drawable, before.deformed).data() != vertices_of(drawable, now.deformed).data()) {
            boxes.push_back(place_box(bounds_of(drawable, before.deformed), from));
            boxes.push_back(place_box(bounds_of(drawable, now.deformed), to));
        }
    }
    return boxes;
}

/// The boxes, or one box around all of them if there are more than `most`.
std::vector<Box> at_most(std::vector<Box> boxes, std::size_t most) {
    if (boxes.size() <= most) return boxes;
    Box all;
    for (const Box& box : boxes) {
        all.grow(box);
    }
    return {all};
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
            if (!now.everything) now.boxes = moved_boxes(run.value(layout), last->placement, now.placement);
            run.set(motion, std::move(now));
        });
        return motion;
    });
}

std::optional<std::vector<Box>> changed_boxes(const SceneMotion& motion, std::uint64_t done) {
    if (motion.step == done) return std::vector<Box>{};
    if (motion.everything || motion.step != done + 1) return std::nullopt;
    return at_most(motion.boxes, MOST_CHANGED_BOXES);
}

gl::Uniforms changed_box_uniforms(const std::optional<std::vector<Box>>& boxes, float slack) {
    std::vector<glm::vec4> corners;
    for (const Box& box : boxes.value_or(std::vector<Box>{})) {
        corners.emplace_back(box.lower - slack, 0.0F);
        corners.emplace_back(box.upper + slack, 0.0F);
    }
    return {{"everything_changed", !boxes.has_value()},
            {"changed_box_count", static_cast<std::uint32_t>(corners.size() / 2)},
            {"changed_boxes", std::move(corners)}};
}

}  // namespace candela
