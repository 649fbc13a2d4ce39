#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include "sandbox/editing/drag.hpp"
#include "sandbox/editing/viewport.hpp"

namespace candela::sandbox {

/// What the pointer does with the selection.
enum class Tool : std::uint8_t { move, surface, turn, scale };

/// A part of a gizmo that can be grabbed: a line in window coordinates, or, if it is only one point, a dot.
struct Handle {
    DragMode mode;
    std::vector<glm::vec2> line;
};

/// The handles around the selected entity; of the same size in the window, however far away that is. Lines
/// that the view shortens so much that dragging along them is impossible are left out.
struct Gizmo {
    glm::vec2 centre{0.0F};  ///< of the entity, window coordinates
    std::vector<Handle> handles;
};

/// The tool that is used instead of the chosen one where that would change nothing: turning a point light or
/// moving a directional one, for example.
[[nodiscard]] Tool usable_tool(const World& world, Entity entity, Tool tool);

/// The gizmo of a tool. `size` is the length of its axes in window coordinates. `position` is where it is
/// shown; world space. nullopt if that is behind the eye.
[[nodiscard]] std::optional<Gizmo> make_gizmo(const World& world, const Viewport& viewport, Entity entity,
                                              Tool tool, const glm::vec3& position, float size);

/// The index of the handle that is nearest to a position in the window, if it is within `radius`; dots win
/// over lines. Both in window coordinates.
[[nodiscard]] std::optional<std::size_t> handle_at(const Gizmo& gizmo, glm::vec2 position, float radius);

}  // namespace candela::sandbox
