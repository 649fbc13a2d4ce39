#pragma once

#include <string>

#include <candela/scene/lights.hpp>
#include "engine/import/gltf_values.hpp"

namespace candela::gltf {

/// A light as an object of KHR_lights_punctual, with CANDELA_light if it casts no shadow.
struct WrittenLight {
    Json json;
    std::string warning;  ///< how it differs from the light; empty: it does not
};
/// The light must have no fault.
[[nodiscard]] WrittenLight write_light(const AnyLight& light);

/// The reverse. `index`: of the light, for errors. Throws SceneError if the type is unknown or if cones do
/// not fit.
[[nodiscard]] AnyLight read_light(const Json& source, int index);

}  // namespace candela::gltf
