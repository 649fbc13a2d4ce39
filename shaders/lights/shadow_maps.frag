// Draws a triangle into a texel of a shadow map if it comes within a texel of the centre, along each axis: the depth of its
// plane at the centre, and whether it hides all that is within a texel. See README.md, "Shadow maps".
#include "lights/shadow_plane.glsl"

uniform float texel;  // width in clip space

flat in mat3 edges;
flat in vec3 base;
flat in vec2 slope;
flat in uint has_holes;
flat in vec4 rectangle;  // lower and upper corner

void main() {
    vec2 at = gl_FragCoord.xy * texel - 1.0;
    if (any(lessThan(at, rectangle.xy)) || any(greaterThan(at, rectangle.zw))) discard;
    vec3 inside = vec3(at, 1.0) * edges;
    vec3 within = SHADOW_REACH * texel * (abs(row(edges, 0)) + abs(row(edges, 1)));
    if (any(lessThan(inside, -within))) discard;
    float depth = base.z + dot(slope, at - base.xy);
    // 1, too, where the plane contains the light.
    gl_FragDepth = shadow_depth(depth < 1.0 ? max(depth, 0.0) : 1.0, has_holes == 0u && all(greaterThan(inside, within)));
}
