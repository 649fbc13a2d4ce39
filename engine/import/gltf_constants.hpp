#pragma once

namespace candela::gltf {

// Numbers that stand for names in glTF 2.0.
inline constexpr int signed_byte = 5120;
inline constexpr int unsigned_byte = 5121;
inline constexpr int unsigned_short = 5123;
inline constexpr int unsigned_int = 5125;
inline constexpr int floating_point = 5126;
inline constexpr int mode_triangles = 4;
inline constexpr int mode_triangle_strip = 5;
inline constexpr int vertices_target = 34962;
inline constexpr int indices_target = 34963;
inline constexpr int wrap_repeat = 10497;
inline constexpr int wrap_clamp_to_edge = 33071;
inline constexpr int wrap_mirrored_repeat = 33648;

}  // namespace candela::gltf
