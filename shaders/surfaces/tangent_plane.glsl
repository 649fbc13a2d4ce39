// Whether pixels lie on the same surface. See theory.md, "Same surface". For files that include view.glsl.
#include "surfaces/surface.glsl"

const float SAME_NORMAL = 0.9;  // smallest cosine between normals of the same surface

// Tangent plane of a surface in clip space: the dot product with (x, y, z, 1), in normalised device coordinates, is the
// distance from it in widths of a pixel at that depth.
vec4 tangent_plane(Surface surface) {
    vec3 normal = face_normal(surface);
    vec4 plane = vec4(normal, -dot(normal, surface.position)) * view.world_from_clip;
    return plane * (0.5 * view.target_size.y / length(view.world_from_clip[1].xyz));
}
