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
layout(binding = UNIT_VPL_SLOPES) uniform usampler2DArray vpl_slopes;

// The planes that the four texels around a direction see: (0, 0), (1, 0), (0, 1) and (1, 1).
struct SeenPlanes {
    vec4 x;  // the texels' centres, on the surface of the map
    vec4 y;
    vec4 z;
    vec4 depth;    // of the planes there
    vec4 along_x;  // at any point (x, y, z) of the surface it is along_x x + along_y y + along_z z
    vec4 along_y;
    vec4 along_z;
    vec4 weight;  // bilinear
};

SeenPlanes planes_around(uint map, MapFrame frame, vec2 place) {
    float side = float(vpl_constants.map_resolution);
    float texel = frame.width / side;
    vec2 inside = (place * 0.5 + 0.5) * side - 0.5;
    vec2 first = clamp(floor(inside), 0.0, side - 2.0);
    vec2 share = clamp(inside - first, 0.0, 1.0);
    VplTile tile = vpl_tile(map);
    vec3 middle = vec3((vec2(tile.corner) + first + 1.0) / vec2(textureSize(vpl_maps, 0).xy), float(tile.layer));
    uvec4 slopes = textureGather(vpl_slopes, middle).wzxy;
    vec4 slope_x = uintBitsToFloat(slopes << 16u);  // see pack_slope
    vec4 slope_y = uintBitsToFloat(slopes & 0xffff0000u);
    vec4 column = first.x + vec4(0.5, 1.5, 0.5, 1.5);
    vec4 row = first.y + vec4(0.5, 0.5, 1.5, 1.5);
    vec4 fold_x = mix(vec4(-frame.bend), vec4(frame.bend), greaterThanEqual(column + row, vec4(side)));
    vec4 fold_y = mix(vec4(-frame.bend), vec4(frame.bend), greaterThanEqual(column, row));
    SeenPlanes seen;
    seen.x = texel * (column + row) - frame.width;
    seen.y = texel * (column - row);
    seen.z = 1.0 - fold_x * seen.x - fold_y * seen.y;
    seen.depth = textureGather(vpl_maps, middle).wzxy;
    seen.along_z = seen.depth * (1.0 - slope_x * seen.x - slope_y * seen.y);
    seen.along_x = seen.depth * slope_x + fold_x * seen.along_z;
    seen.along_y = seen.depth * slope_y + fold_y * seen.along_z;
    seen.weight = vec4(1.0 - share.x, share.x, 1.0 - share.x, share.x) * vec4(1.0 - share.yy, share.yy);
    return seen;
}

// Depths of the planes at a point of the map's surface.
vec4 depths_at(SeenPlanes seen, vec3 at) { return seen.along_x * at.x + seen.along_y * at.y + seen.along_z * at.z; }

// Depths at the texels' centres of the plane through `at` with this normal, in the map's space.
vec4 depths_of_plane(SeenPlanes seen, vec3 at, vec3 normal) {
    vec3 along = normal * (vpl_constants.map_near / dot(normal, at));
    return along.x * seen.x + along.y * seen.y + along.z * seen.z;
}

float least(vec4 v) { return min(min(v.x, v.y), min(v.z, v.w)); }
float most(vec4 v) { return max(max(v.x, v.y), max(v.z, v.w)); }

// How much farther than its centre a texel may reach, relative to its distance: its diagonal.
float reach_of_texel(MapFrame frame) { return 2.8284271 * frame.width / float(vpl_constants.map_resolution); }

// How far a surface may be behind the plane of each texel and still be seen, relative to its distance. Curved surfaces, and
// things that are smaller than texels, would hide themselves: where the texels see different planes, it is a texel for those
// that face within 60 degrees of the surface. Rounded slopes make one plane differ by up to 0.002.
vec4 hiding_slack(SeenPlanes seen, vec4 planes, vec3 facing, float reach) {
    if (least(planes) > 0.998 * most(planes)) return vec4(0.0);
    // (along_x, along_y, along_z) is the plane's normal, times a factor, on the side that the VPL does not see.
    vec4 cosine = seen.along_x * facing.x + seen.along_y * facing.y + seen.along_z * facing.z;
    vec4 length2 = seen.along_x * seen.along_x + seen.along_y * seen.along_y + seen.along_z * seen.along_z;
    return reach * vec4(lessThan(cosine * abs(cosine), -0.25 * length2));
}

// Whether what a texel sees is before walls that hide the surface in others, whose planes have this sum: as the floor in
// front of a wall is.
vec4 is_before(SeenPlanes seen, vec4 hides) {
    vec3 walls = vec3(dot(hides, seen.along_x), dot(hides, seen.along_y), dot(hides, seen.along_z));
    vec4 depths = walls.x * seen.x + walls.y * seen.y + walls.z * seen.z;
    return vec4(greaterThan(dot(hides, vec4(1.0)) * seen.depth, depths));
}

// A map covers the hemisphere along its axis only.
vec3 above_horizon(vec3 at) { return vec3(at.xy, max(at.z, 0.0)); }

const float NEAR = 0.25;  // of a texel's diagonal; by trial: rough surfaces need more, thin walls less
const float OUTSIDE = 1.0;  // visibility beyond the field of view of a perspective map

// Share of the VPL's light that reaches the surface, in [0, 1], by the four texels around its direction. What a texel sees
// hides the surface if the surface is behind its plane, and it before the plane of the surface. Where some hide it, others
// show it only if their planes are near it, as on the bumps of a rough surface: past the edge of a wall they may see
// anything. `map`: see vpl_atlas.glsl. See README.md, "Planes in VPL maps".
float visibility_of_vpl(uint map, VplPose pose, Surface surface) {
    MapFrame frame = pose.frame;
    vec3 facing = frame.map_from_world * face_normal(surface);
    vec3 at = frame.map_from_world * (ray_origin(surface, vpl_constants.ray_offset) - pose.origin);
    vec3 direction = above_horizon(at);
    float inverse_length = 1.0 / vpl_map_length(frame, direction);
    vec3 point = direction * inverse_length;
    vec2 place = vpl_map_place(frame, point);
    if (max(abs(place.x), abs(place.y)) > 1.001) return OUTSIDE;
    SeenPlanes seen = planes_around(map, frame, place);
    float own_depth = vpl_constants.map_near * inverse_length;
    float reach = reach_of_texel(frame);
    vec4 planes = depths_at(seen, point);
    vec4 slack = hiding_slack(seen, planes, facing, reach);
    vec4 before = vec4(greaterThan(seen.depth, depths_of_plane(seen, at, facing)));
    vec4 hides = before * vec4(greaterThan(planes, own_depth * (1.0 + slack)));
    if (most(hides) == 0.0) return 1.0;
    vec4 near = vec4(lessThan(abs(planes - own_depth), vec4(NEAR * reach * own_depth)));
    float shown = dot(seen.weight, near * (1.0 - hides) * (1.0 - is_before(seen, hides)));
    return shown > 0.0 ? shown / (shown + dot(seen.weight, hides)) : 0.0;
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
