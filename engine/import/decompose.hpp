#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include <candela/scene/components.hpp>

namespace candela {

/// Transforms, outermost first, whose product is the given affine matrix (finite, last row 0 0 0 1). One
/// transform is enough if the matrix's axes are perpendicular, which is the case for every T·R·S, also if it
/// is mirrored or flattened. A sheared matrix takes two. Its linear part is U·Σ·Vᵀ (singular value
/// decomposition): the outer transform rotates by U and scales by Σ, and the inner one rotates by Vᵀ.
/// `parent` is left null.
[[nodiscard]] std::vector<Transform> decompose(const glm::dmat4& matrix);

}  // namespace candela
