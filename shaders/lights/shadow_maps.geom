// Emits a rectangle that contains all texels of a shadow map that a triangle may be marked in: those whose centre is less
// than a texel, along each axis, from the triangle (Hasselgren et al., "Conservative Rasterization", GPU Gems 2, 2005).
#include "lights/shadow_plane.glsl"
#include "maths.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

uniform mat4 clip_from_world;
uniform float depth_scale;    // see Shadow
uniform vec3 light_position;  // metres; unused if the map is orthographic
uniform float least_w;        // what is nearer to the light hides nothing
uniform float texel;          // width in clip space

in vec3 vertex_in_world[];
flat in uint vertex_has_holes[];

// Homogeneous equations of the edges (Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates", 1997),
// positive on the triangle's side.
flat out mat3 edges;
// Where the triangle's plane has the depth base.z, and the plane's slope.
flat out vec3 base;
flat out vec2 slope;
flat out uint has_holes;
flat out vec4 rectangle;  // its lower and its upper corner

void main() {
    vec3 normal = cross(vertex_in_world[1] - vertex_in_world[0], vertex_in_world[2] - vertex_in_world[0]);
    if (normal == vec3(0.0)) return;
    vec4 clip[3];
    for (int i = 0; i < 3; ++i) clip[i] = clip_from_world * vec4(vertex_in_world[i], 1.0);

    // The rectangle around the part that is not too near.
    vec2 lower = vec2(INFINITY);
    vec2 upper = -lower;
    int farthest = 0;
    for (int i = 0; i < 3; ++i) {
        vec4 from = clip[i];
        vec4 to = clip[(i + 1) % 3];
        if (from.w > clip[farthest].w) farthest = i;
        if (max(from.w, to.w) < least_w) continue;
        vec4 between = mix(from, to, (least_w - from.w) / (to.w - from.w));
        if (from.w < least_w) from = vec4(between.xyz, least_w);
        if (to.w < least_w) to = vec4(between.xyz, least_w);
        lower = min(lower, min(from.xy / from.w, to.xy / to.w));
        upper = max(upper, max(from.xy / from.w, to.xy / to.w));
    }
    lower = max(lower - SHADOW_REACH * texel, -1.0);
    upper = min(upper + SHADOW_REACH * texel, 1.0);
    if (any(greaterThanEqual(lower, upper))) return;

    mat3 lines = mat3(cross(clip[1].xyw, clip[2].xyw), cross(clip[2].xyw, clip[0].xyw), cross(clip[0].xyw, clip[1].xyw));
    if (dot(lines[0], clip[0].xyw) < 0.0) lines = -lines;
    vec3 point = clip[farthest].xyz / clip[farthest].w;
    float height = dot(normal, vertex_in_world[farthest] - light_position);
    // A small rectangle is the corner of one triangle, which takes less time than two; the rest is discarded.
    bool is_small = all(lessThan(upper - lower, vec2(16.0 * texel)));
    vec2 far = is_small ? 2.0 * upper - lower : upper;
    for (int i = 0; i < (is_small ? 3 : 4); ++i) {
        edges = lines;
        base = point;
        slope = plane_slope(clip_from_world, depth_scale, normal, height);
        rectangle = vec4(lower, upper);
        has_holes = vertex_has_holes[0];
        gl_Position = vec4((i & 1) == 0 ? lower.x : far.x, (i & 2) == 0 ? lower.y : far.y, 0.5, 1.0);
        EmitVertex();
    }
    EndPrimitive();
}
