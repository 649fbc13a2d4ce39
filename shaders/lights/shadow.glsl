// Shadows of lights. The shadow map tells where nothing stands between a surface and the light, whatever the size of what
// might, and elsewhere a ray decides: README.md, "Shadow maps". Depth is reversed: 1 at the near plane, 0 at infinity or
// at the map's far end. SHADOW_RAYS: shadows are enabled.
#include "bindings.glsl"
#include "lights/shadow_plane.glsl"
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"

#ifndef SHADOW_RAYS

float shadow_visibility(uint index, Light light, Surface surface) { return 1.0; }

#else

layout(std430, binding = BINDING_SHADOWS) readonly restrict buffer Shadows { Shadow shadows[]; };
layout(binding = UNIT_SHADOW_CUBES) uniform sampler2DArray shadow_cubes;
layout(binding = UNIT_SHADOW_MAPS) uniform sampler2DArray shadow_maps;

// Face of a cube that sees a direction (OpenGL 4.5, table 8.19).
uint cube_face(vec3 direction) {
    vec3 size = abs(direction);
    int axis = size.x >= max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
    return 2u * uint(axis) + (direction[axis] < 0.0 ? 1u : 0u);
}

const float UNKNOWN = 0.5;

// What the map shows of `origin`, which lies in a plane that faces the light. Nothing is in the way if in none of the four
// texels around it a triangle is nearer than that plane: 1. It is hidden if in all of them a triangle is nearer that covers
// all four: 0. See README.md, "Shadow maps".
float mapped_visibility(Shadow shadow, bool cube, vec3 origin, vec3 normal, vec3 light_position) {
    float resolution = float(cube ? textureSize(shadow_cubes, 0).x : textureSize(shadow_maps, 0).x);
    vec4 clip = shadow.from_world * vec4(origin, 1.0);
    vec3 at = clip.xyz / clip.w;
    float height = min(dot(normal, origin - light_position), -1e-30);
    vec2 slope = plane_slope(shadow.from_world, shadow.depth_scale, normal, height) * (2.0 / resolution);
    vec2 texels = (at.xy * 0.5 + 0.5) * resolution - 0.5;
    vec2 first = clamp(floor(texels), vec2(0.0), vec2(resolution - 2.0));
    vec2 off = first - texels;
    // Depths of the plane and of the map, in the order of textureGather.
    vec4 plane = at.z + slope.x * (off.x + vec4(0.0, 1.0, 1.0, 0.0)) + slope.y * (off.y + vec4(1.0, 1.0, 0.0, 0.0));
    vec3 between = vec3((first + 1.0) / resolution, float(shadow.layer));
    vec4 drawn = cube ? textureGather(shadow_cubes, between) : textureGather(shadow_maps, between);
    // What is drawn is cut off at 0 and 1.
    if (any(lessThan(plane, vec4(0.0))) || any(greaterThan(plane, vec4(1.0)))) return UNKNOWN;
    if (all(lessThanEqual(drawn, plane))) return 1.0;
    return all(greaterThan(drawn, plane)) && all(covers_all(drawn)) ? 0.0 : UNKNOWN;
}

// Whether a ray from `origin` to the light is blocked. It ends before the light, which may lie on a surface.
bool is_blocked(float ray_offset, vec3 origin, Light light) {
    vec3 direction = -light.direction;
    float end = INFINITY;
    if (light.kind != LIGHT_DIRECTIONAL) {
        float distance = max(length(light.position - origin), 1e-30);
        direction = (light.position - origin) / distance;
        end = distance - ray_offset;
    }
    return any_hit(origin, direction, 0.0, end);
}

// Share of the light lights[index] that reaches the surface, which must face it: 0 or 1.
float shadow_visibility(uint index, Light light, Surface surface) {
    Shadow shadow = shadows[index];
    if (shadow.kind == SHADOW_NONE) return 1.0;
    vec3 normal = face_normal(surface);
    vec3 origin = ray_origin(surface, shadow.ray_offset);
    if (shadow.kind != SHADOW_BY_RAYS) {
        bool cube = shadow.kind == SHADOW_CUBE;
        if (cube) shadow = shadows[shadow.layer + cube_face(origin - light.position)];
        float visibility = mapped_visibility(shadow, cube, origin, normal, light.position);
        if (visibility != UNKNOWN) return visibility;
    }
    return is_blocked(shadow.ray_offset, origin, light) ? 0.0 : 1.0;
}

#endif
