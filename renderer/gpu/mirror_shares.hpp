#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace candela {

/// Texels along a side of the table of mirror shares.
inline constexpr std::uint32_t mirror_table_size = 32;

/// What a glossy surface reflects of light that is the same from all sides: glTF 2.0, appendix B.3, without
/// reflection between its microfacets. With its reflectances F0 where it faces the viewer and F90 at grazing
/// angles, it reflects the share x F0 + y F90 in the mirror direction, and its diffuse part is reduced by the
/// largest channel of (1 - z) F0 + z F90. `cosine`: between its normal and the direction to the viewer, above
/// 0. `roughness` in [0, 1].
[[nodiscard]] glm::vec3 mirror_shares(float cosine, float roughness);

/// The same for viewers in all directions, in proportion to the cosine.
[[nodiscard]] glm::vec3 mean_mirror_shares(float roughness);

/// mirror_shares as a table: rows of increasing roughness, in them increasing cosine, both from 0 to 1 in
/// equal steps.
[[nodiscard]] const std::vector<glm::vec3>& mirror_table();

}  // namespace candela
