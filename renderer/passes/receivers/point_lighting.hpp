#pragma once

#include <candela/point_lighting.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/shading/lighting.hpp"

namespace candela {

/// `lighting` has no light lists, and its indirect light is that of VPLs.
[[nodiscard]] PointLighting make_point_lighting(const Gpu& gpu, const Lighting& lighting);

}  // namespace candela
