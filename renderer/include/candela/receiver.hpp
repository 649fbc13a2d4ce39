#pragma once

#include <glm/vec3.hpp>

namespace candela {

/// A place whose light a host asks for, such as that of a particle or of a figure that it draws itself: a
/// small surface that faces one way. For light from all sides, ask for several normals at one place.
struct Receiver {
    glm::vec3 position;  ///< world space, metres
    glm::vec3 normal;    ///< world space, unit length
    bool operator==(const Receiver&) const = default;
};

}  // namespace candela
