#pragma once

#include <glm/vec3.hpp>

namespace candela {

/// A place whose light a host asks for, such as that of a particle or of a figure that it draws itself: a
/// small surface that faces one way. For light from all sides, ask for several normals at one place.
struct Receiver {
    /// World space, metres. A surface that a GPU has drawn may hide a position on it, which was found by the
    /// depth of a pixel: as GPUs round corners to 1/256 of a pixel, let it be as much above the surface.
    glm::vec3 position;
    glm::vec3 normal;  ///< world space, unit length
    bool operator==(const Receiver&) const = default;
};

}  // namespace candela
