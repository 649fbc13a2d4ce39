#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/scene/components.hpp"

namespace candela {

/// Transforms, outermost first, whose product is the affine matrix (finite, last row 0 0 0 1): one where its
/// axes are perpendicular, which covers every T·R·S, mirrored and flattened ones included. A sheared matrix
/// takes two: its linear part is U·Σ·Vᵀ by singular value decomposition, so that the outer transform turns by
/// U and scales by Σ and the inner one turns by Vᵀ. Their `parent` is left null.
[[nodiscard]] std::vector<Transform> decompose(const glm::dmat4& matrix);

}  // namespace candela
