// Visibility between a VPL and a surface: from the VPL's depth map (VPL_VISIBILITY_MAPS), by a shadow ray
// (VPL_VISIBILITY_RAYS), or always 1. Surfels that emit light (EMITTERS) and patches of the sky (SKY) have no maps:
// their shadows are those of direct light, and a map's texels would be seen. `position`: metres, of the VPL.
#include "bindings.glsl"
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"

#if defined(VPL_VISIBILITY_RAYS) || \
    (defined(VPL_VISIBILITY_MAPS) && (defined(EMITTERS) || defined(SKY) || defined(BALANCED)))

float visibility_of_sky(vec3 direction, Surface surface) {
    vec3 origin = ray_origin(surface, vpl_constants.ray_offset);
    return any_hit(origin, direction, 0.0, INFINITY) ? 0.0 : 1.0;
}

float visibility_by_ray(vec3 position, vec3 normal, Surface surface) {
    vec3 target = position + vpl_constants.ray_offset * normal;
    vec3 origin = ray_origin(surface, vpl_constants.ray_offset);
    // At least as high above the VPL's plane as the target.
    origin += max(dot(target - origin, normal), 0.0) * normal;
    return any_hit(origin, target - origin, 0.0, 1.0) ? 0.0 : 1.0;
}

#else

float visibility_of_sky(vec3 direction, Surface surface) { return 1.0; }
float visibility_by_ray(vec3 position, vec3 normal, Surface surface) { return 1.0; }

#endif

#if defined(VPL_VISIBILITY_MAPS)

#include "vpls/vpl_atlas.glsl"

// What the look-ups of all surfaces share.
struct VplPose {
    vec3 origin;  // of the map, metres
    MapFrame frame;
};

VplPose vpl_pose(vec3 position, vec3 normal, uint map) {
    return VplPose(vpl_map_origin(position, normal), vpl_map_frame(position, normal, map));
}

layout(binding = UNIT_VPL_MAPS) uniform sampler2DArray vpl_maps;

// The four texels around a direction: (0, 0), (1, 0), (0, 1) and (1, 1).
struct MapTexels {
    vec2 first;  // place of (0, 0) in the slot
    vec4 depth;
    vec2 at;  // place of the direction between them: in [0, 1], or up to half a texel beyond at the border of the map
};

vec4 bilinear_weights(vec2 at) { return vec4(1.0 - at.x, at.x, 1.0 - at.x, at.x) * vec4(1.0 - at.yy, at.yy); }

MapTexels texels_around(uint map, vec2 place) {
    float side = float(vpl_constants.map_resolution);
    vec2 inside = (place * 0.5 + 0.5) * side - 0.5;
    vec2 first = clamp(floor(inside), 0.0, side - 2.0);
    VplTile tile = vpl_tile(map);
    vec2 middle = (vec2(tile.corner) + first + 1.0) / vec2(textureSize(vpl_maps, 0).xy);
    vec4 depth = textureGather(vpl_maps, vec3(middle, float(tile.layer))).wzxy;
    return MapTexels(first, depth, inside - first);
}

// Whether the texels see one plane, or nothing at all. See theory.md, "One plane in a VPL map".
bool see_one_plane(MapTexels texels) {
    vec4 depth = texels.depth;
    float most = max(max(depth.x, depth.y), max(depth.z, depth.w));
    return abs(depth.x + depth.w - depth.y - depth.z) <= 1e-5 * most;
}

// Whether the plane that the texels see is not between the map's origin and the position.
bool is_before_plane(MapTexels texels, MapFrame frame, vec3 at) {
    return vpl_map_depth(frame, at) >= dot(bilinear_weights(texels.at), texels.depth);
}

// Share of the texels whose surfaces are not nearer than the distance. The inverse of a unit direction's octahedral
// length is the length of its point on the octahedron.
float share_beyond(MapTexels texels, MapFrame frame, float distance) {
    float texel = 2.0 / float(vpl_constants.map_resolution);
    vec4 u = texel * (texels.first.x + vec4(0.5, 1.5, 0.5, 1.5)) - 1.0;
    vec4 v = texel * (texels.first.y + vec4(0.5, 0.5, 1.5, 1.5)) - 1.0;
    vec4 x = frame.width * 0.5 * (u + v);
    vec4 y = frame.width * 0.5 * (u - v);
    vec4 z = 1.0 - frame.bend * abs(x) - frame.bend * abs(y);
    vec4 nearest = vpl_constants.map_near * sqrt(x * x + y * y + z * z);
    vec4 share = bilinear_weights(clamp(texels.at, 0.0, 1.0));
    return dot(share, vec4(greaterThanEqual(nearest, distance * texels.depth)));
}

// A map covers the hemisphere along its axis only.
vec3 above_horizon(vec3 at) { return vec3(at.xy, max(at.z, 0.0)); }

// Sine of the largest angle δ between a direction and the centres of the texels that its bilinear look-up reads, in a
// map of N = `texels` texels along a side: sin δ ≤ 2√2 w s / N with w = MapFrame::width and s = vpl_map_length. The
// factor 1 + 5/N allows for the lift, which turns the look-up by δ; s is never above √3. See theory.md, "Footprint of a
// look-up".
float footprint_sine(MapFrame frame, vec3 direction, float texels) {
    float s = vpl_map_length(frame, direction);
    return min(2.8284271 * min(s * (1.0 + 5.0 / texels), 1.7320508) / texels * frame.width, 0.9);
}

// Metres to lift the surface along its normal before the look-up: ρ tan δ, with ρ the distance `aside` from the foot of
// the perpendicular from the map's origin. Its own plane then never shadows it. Shadows begin at the foot of the object
// that casts them and end at most 2δ from their true edge. Added margins: a tenth of the distance for shading normals
// that are about 5 degrees off, and four ray offsets for rounding. See theory.md, "Lift above VPL maps".
float lift_above_map(float aside, float distance, float sine) {
    return (aside + 0.1 * distance) * sine * inversesqrt(1.0 - sine * sine) + 4.0 * vpl_constants.ray_offset;
}

const float OUTSIDE = 1.0;  // visibility beyond the field of view of a perspective map

// Share of the VPL's light that reaches the surface, in [0, 1]. Where the map sees one plane in the surface's direction,
// it is 0 or 1, by the exact depth of that plane. Elsewhere it comes from four depth comparisons. `map`: see vpl_atlas.glsl.
float visibility_of_vpl(uint map, VplPose pose, Surface surface) {
    MapFrame frame = pose.frame;
    vec3 facing = frame.map_from_world * face_normal(surface);
    vec3 at = frame.map_from_world * (ray_origin(surface, vpl_constants.ray_offset) - pose.origin);
    float distance = length(at);
    float height = dot(facing, at);
    float aside = sqrt(max(distance * distance - height * height, 0.0));
    float sine = footprint_sine(frame, above_horizon(at) / distance, float(vpl_constants.map_resolution));
    vec3 lifted = at + lift_above_map(aside, distance, sine) * facing;
    vec3 seen = above_horizon(lifted);
    vec2 place = vpl_map_place(frame, seen);
    if (max(abs(place.x), abs(place.y)) > 1.001) return OUTSIDE;
    MapTexels texels = texels_around(map, place);
    if (see_one_plane(texels)) return is_before_plane(texels, frame, seen) ? 1.0 : 0.0;
    return share_beyond(texels, frame, min(length(lifted), distance));
}

#else

struct VplPose {
    vec3 position;  // metres
    vec3 normal;
};

VplPose vpl_pose(vec3 position, vec3 normal, uint map) { return VplPose(position, normal); }

#if defined(VPL_VISIBILITY_RAYS)

float visibility_of_vpl(uint map, VplPose pose, Surface surface) {
    return visibility_by_ray(pose.position, pose.normal, surface);
}

#else

float visibility_of_vpl(uint map, VplPose pose, Surface surface) { return 1.0; }

#endif

#endif
