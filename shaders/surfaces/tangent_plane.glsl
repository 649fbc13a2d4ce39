#include "view/view.glsl"

// The plane with this normal through a point in normalised device coordinates, in clip space: the dot product with
// (x, y, z, 1), in normalised device coordinates, is the distance from it in widths of a pixel at that depth. See
// README.md, "Same surface".
vec4 tangent_plane(vec3 normal, vec3 point) {
    mat4 m = view.world_from_clip;
    vec4 w = vec4(m[0].w, m[1].w, m[2].w, m[3].w);
    vec4 plane = vec4(normal, 0.0) * m;
    plane -= dot(plane, vec4(point, 1.0)) / dot(w, vec4(point, 1.0)) * w;
    return plane * (0.5 * view.target_size.y / length(m[1].xyz));
}
