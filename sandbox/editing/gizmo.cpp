#include "sandbox/editing/gizmo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "sandbox/editing/objects.hpp"
#include "sandbox/editing/placing.hpp"

namespace candela::sandbox {

namespace {

/// Where the gizmo is and how large.
struct Frame {
    const Viewport& viewport;
    glm::vec3 position;
    float metres;  ///< length of an axis
    float size;    ///< the same in window coordinates
};

/// nullopt if a point is behind the eye.
std::optional<std::vector<glm::vec2>> project_all(const Viewport& viewport,
                                                  const std::vector<glm::vec3>& points) {
    std::vector<glm::vec2> seen;
    for (const glm::vec3& point : points) {
        const auto at = project(viewport, point);
        if (!at) return std::nullopt;
        seen.push_back(*at);
    }
    return seen;
}

/// Starts off the centre, so that the dot there can be grabbed.
void add_axis(Gizmo& gizmo, const Frame& frame, DragMode mode, const glm::vec3& axis) {
    constexpr float least_length = 0.15F;  // of a whole one
    constexpr float start = 0.2F;
    const auto line = project_all(
        frame.viewport, {frame.position + start * frame.metres * axis, frame.position + frame.metres * axis});
    if (line && glm::distance(gizmo.centre, line->back()) > least_length * frame.size) {
        gizmo.handles.push_back({mode, *line});
    }
}

void add_ring(Gizmo& gizmo, const Frame& frame, DragMode mode, const glm::vec3& axis, float radius) {
    constexpr float least_cosine = 0.1F;
    constexpr int corners = 48;
    const glm::vec3 view = glm::normalize(frame.position - ray_through(frame.viewport, gizmo.centre).origin);
    if (std::abs(glm::dot(view, axis)) < least_cosine) return;
    const glm::vec3 other =
        std::abs(axis.y) < 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
    const glm::vec3 u = glm::normalize(glm::cross(axis, other));
    const glm::vec3 v = glm::cross(axis, u);
    std::vector<glm::vec3> points;
    for (int corner = 0; corner <= corners; ++corner) {
        const float angle = glm::two_pi<float>() * static_cast<float>(corner % corners) / corners;
        points.push_back(frame.position +
                         radius * frame.metres * (std::cos(angle) * u + std::sin(angle) * v));
    }
    if (auto line = project_all(frame.viewport, points)) gizmo.handles.push_back({mode, std::move(*line)});
}

void add_axes(Gizmo& gizmo, const Frame& frame, const World& world, Entity entity, DragKind kind) {
    for (int axis = 0; axis < 3; ++axis) {
        const DragMode mode{kind, axis};
        add_axis(gizmo, frame, mode, axis_of(world, entity, mode));
    }
}

void add_rings(Gizmo& gizmo, const Frame& frame, const World& world, Entity entity) {
    constexpr float outer = 1.2F;  // around the other rings
    for (int axis = 0; axis < 3; ++axis) {
        const DragMode mode{DragKind::turn_around_axis, axis};
        add_ring(gizmo, frame, mode, axis_of(world, entity, mode), 1.0F);
    }
    add_ring(gizmo, frame, {DragKind::turn_around_view}, frame.viewport.forward, outer);
}

float distance_to_segment(glm::vec2 point, glm::vec2 a, glm::vec2 b) {
    const glm::vec2 along = b - a;
    const float squared = glm::dot(along, along);
    const float t = squared > 0.0F ? std::clamp(glm::dot(point - a, along) / squared, 0.0F, 1.0F) : 0.0F;
    return glm::distance(point, a + t * along);
}

float distance_to(const Handle& handle, glm::vec2 point) {
    float least = glm::distance(point, handle.line.front());
    for (std::size_t i = 1; i < handle.line.size(); ++i) {
        least = std::min(least, distance_to_segment(point, handle.line[i - 1], handle.line[i]));
    }
    return least;
}

}  // namespace

Tool usable_tool(const World& world, Entity entity, Tool tool) {
    if (!has_place(world, entity)) return Tool::turn;
    const bool only_light =
        is_light(world, entity) && family_of(world, entity).size() == 1 && !world.has<MeshInstance>(entity);
    const bool useless =
        only_light && (tool == Tool::scale || (tool == Tool::turn && !has_direction(world, entity)));
    return useless ? Tool::move : tool;
}

std::optional<Gizmo> make_gizmo(const World& world, const Viewport& viewport, Entity entity, Tool tool,
                                const glm::vec3& position, float size) {
    const auto centre = project(viewport, position);
    if (!centre) return std::nullopt;
    Gizmo gizmo{*centre, {}};
    const Frame frame{viewport, position, size * metres_per_unit(viewport, position), size};
    switch (tool) {
        case Tool::move:
            gizmo.handles.push_back({{DragKind::move_in_plane}, {*centre}});
            add_axes(gizmo, frame, world, entity, DragKind::move_along_axis);
            break;
        case Tool::surface:
            gizmo.handles.push_back({{DragKind::move_over_surface}, {*centre}});
            break;
        case Tool::turn:
            if (has_direction(world, entity)) gizmo.handles.push_back({{DragKind::aim}, {*centre}});
            add_rings(gizmo, frame, world, entity);
            break;
        case Tool::scale:
            gizmo.handles.push_back({{DragKind::scale}, {*centre}});
            add_axes(gizmo, frame, world, entity, DragKind::scale_along_axis);
            break;
    }
    return gizmo;
}

std::optional<std::size_t> handle_at(const Gizmo& gizmo, glm::vec2 position, float radius) {
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < gizmo.handles.size(); ++i) {
        const float distance = distance_to(gizmo.handles[i], position);
        if (!(distance <= radius)) continue;
        nearest = i;
        if (gizmo.handles[i].line.size() == 1) return nearest;
        radius = distance;
    }
    return nearest;
}

}  // namespace candela::sandbox
