// Visibility between a VPL and a surface: from the VPL's depth map (VPL_VISIBILITY_MAPS), by a shadow ray
// (VPL_VISIBILITY_RAYS), or always 1. VPLs on surfaces that emit light (EMITTERS) and patches of the sky (SKY) have no
// maps: their shadows are those of direct light, and a map's texels would be seen.
#include "bindings.glsl"
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"

#if defined(VPL_VISIBILITY_RAYS) || (defined(VPL_VISIBILITY_MAPS) && (defined(EMITTERS) || defined(SKY)))

float visibility_of_sky(vec3 direction, Surface surface) {
    vec3 origin = visible_position(surface, vpl_constants.ray_offset) + vpl_constants.ray_offset * surface.normal;
    return any_hit(origin, direction, 0.0, 1.0 / 0.0) ? 0.0 : 1.0;
}

float visibility_by_ray(Vpl vpl, Surface surface) {
    vec3 target = vpl.map_origin + vpl_constants.ray_offset * vpl.normal;
    vec3 origin = visible_position(surface, vpl_constants.ray_offset) + vpl_constants.ray_offset * surface.normal;
    // At least as high above the VPL's plane as the target.
    origin += max(dot(target - origin, vpl.normal), 0.0) * vpl.normal;
    return any_hit(origin, target - origin, 0.0, 1.0) ? 0.0 : 1.0;
}

#else

float visibility_of_sky(vec3 direction, Surface surface) { return 1.0; }

#endif

#if defined(VPL_VISIBILITY_MAPS)

#include "vpls/vpl_atlas.glsl"

layout(binding = UNIT_VPL_MAPS) uniform sampler2DArrayShadow vpl_maps;

// Sine of the largest angle δ between a direction and the centres of the texels that its bilinear look-up reads, in a
// map of N = `texels` texels along a side: sin δ ≤ 2√2 s / N with s = |x| + |y| + z. The factor 1 + 5/N allows for the
// lift, which turns the look-up by δ; s is never above √3. See theory.md, "Footprint of a look-up".
float footprint_sine(vec3 direction, float texels) {
    float s = abs(direction.x) + abs(direction.y) + direction.z;
    return min(2.8284271 * min(s * (1.0 + 5.0 / texels), 1.7320508) / texels, 0.9);
}

// Metres to lift the surface along its normal before the look-up: ρ tan δ, with ρ the distance `aside` from the foot of
// the perpendicular from the map's origin. Its own plane then never shadows it. Shadows begin at the foot of the object
// that casts them and end at most 2δ from their true edge. Added margins: a tenth of the distance for shading normals
// that are about 5 degrees off, and four ray offsets for rounding. See theory.md, "Lift above VPL maps".
float lift_above_map(float aside, float distance, float sine) {
    return (aside + 0.1 * distance) * sine * inversesqrt(1.0 - sine * sine) + 4.0 * vpl_constants.ray_offset;
}

// Share of the VPL's light that reaches the surface, in [0, 1], from four depth comparisons.
float vpl_visibility(Vpl vpl, Surface surface) {
#ifdef EMITTERS
    if (vpl.map == NO_MAP) return visibility_by_ray(vpl, surface);
#endif
    vec3 from_vpl = visible_position(surface, vpl_constants.ray_offset) - vpl_map_origin(vpl);
    vec3 tangent, bitangent;
    basis_around(vpl.normal, tangent, bitangent);
    float texels = float(vpl_constants.map_resolution);

    float distance = length(from_vpl);
    float height = dot(surface.normal, from_vpl);
    float aside = sqrt(max(distance * distance - height * height, 0.0));
    vec3 local = vec3(dot(from_vpl, tangent), dot(from_vpl, bitangent), max(dot(from_vpl, vpl.normal), 0.0));
    float sine = footprint_sine(local / distance, texels);
    vec3 lifted = from_vpl + lift_above_map(aside, distance, sine) * surface.normal;

    vec3 seen = vec3(dot(lifted, tangent), dot(lifted, bitangent), max(dot(lifted, vpl.normal), 0.0));
    // At least half a texel inside, so that the filter stays in the slot. Rounded to 1/256 texel, which adds exactly to
    // the slot's corner, so that the result does not depend on the slot.
    vec2 inside = (hemi_octahedral_encode(seen) * 0.5 + 0.5) * texels;
    inside = clamp(floor(inside * 256.0 + 0.5) / 256.0, 0.5, texels - 0.5);
    VplTile tile = vpl_tile(vpl.map);
    vec2 at = (vec2(tile.corner) + inside) / vec2(textureSize(vpl_maps, 0).xy);
    float reference = clamp(vpl_map_depth(min(length(lifted), distance)), 0.0, 1.0);
    return texture(vpl_maps, vec4(at, float(tile.layer), reference));
}

#elif defined(VPL_VISIBILITY_RAYS)

float vpl_visibility(Vpl vpl, Surface surface) { return visibility_by_ray(vpl, surface); }

#else

float vpl_visibility(Vpl vpl, Surface surface) { return 1.0; }

#endif
