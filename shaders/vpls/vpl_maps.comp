// Maps of what VPLs see: traces a ray through the centre of each texel and stores the plane that it meets. Slots without a
// map are cleared. One work group per block of MAP_BLOCK² texels, z: task; one invocation per texel.
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "scene/changed_boxes.glsl"
#include "vpls/mapped_vpl.glsl"
#include "vpls/vpl_atlas.glsl"

layout(local_size_x = MAP_BLOCK, local_size_y = MAP_BLOCK) in;

layout(r32f, binding = IMAGE_VPL_MAPS) writeonly restrict uniform image2DArray vpl_maps;
layout(r32ui, binding = IMAGE_VPL_SLOPES) writeonly restrict uniform uimage2DArray vpl_slopes;

uniform uint first_task;

bool is_outdated(MapTask task, MappedVpl vpl) {
    if (everything_changed) return has_map(task.index);  // the atlas is cleared
    if (task.task == SURFEL_WHOLE) return true;
    bool sees_above = vpl.map <= SURFEL_MAP_SLOT;
    return has_map(task.index) && (!sees_above || may_have_changed_above(vpl.position, vpl.normal));
}

// Whether the ray of a texel may meet something else than before.
bool is_outdated_along(MapTask task, vec3 origin, vec3 direction) {
    return task.task == SURFEL_WHOLE || may_have_changed(origin, direction, INFINITY);
}

// Normal of the triangle, on the side that the ray meets.
vec3 met_normal(Hit hit, vec3 direction) {
    vec3 front = front_of(hit);
    return dot(front, direction) < 0.0 ? front : -front;
}

// In blocks of 4 × 2, so that neighbouring invocations trace similar rays.
uvec2 own_texel() {
    uint i = gl_LocalInvocationIndex;
    uvec2 in_block = uvec2((i & 3u) | (i >> 1u & 4u), (i >> 2u & 1u) | (i >> 4u) << 1u);
    return gl_WorkGroupID.xy * uint(MAP_BLOCK) + in_block;
}

void store(ivec3 at, float depth, uint slope) {
    imageStore(vpl_maps, at, vec4(depth));
    imageStore(vpl_slopes, at, uvec4(slope));
}

void main() {
    MapTask task = map_task(first_task + gl_WorkGroupID.z);
    MappedVpl vpl = mapped_vpl(task.index);
    uvec2 texel = own_texel();
    if (max(texel.x, texel.y) >= vpl_constants.map_resolution || !is_outdated(task, vpl)) return;
    VplTile tile = vpl_tile(vpl.map);
    ivec3 at = ivec3(tile.corner + texel, tile.layer);
    if (!has_map(task.index)) {
        store(at, 0.0, 0u);
        return;
    }
    MapFrame frame = vpl_map_frame(vpl.position, vpl.normal, vpl.map);
    vec3 point = vpl_map_point(frame, (vec2(texel) + 0.5) / float(vpl_constants.map_resolution) * 2.0 - 1.0);
    vec3 origin = vpl_map_origin(vpl.position, vpl.normal);
    vec3 local = normalize(point);
    vec3 direction = local * frame.map_from_world;
    if (!is_outdated_along(task, origin, direction)) return;
    Hit hit = closest_hit(origin, direction, 0.0, INFINITY);
    if (hit.triangle == NO_TRIANGLE) {
        store(at, 0.0, 0u);
        return;
    }
    vec3 normal = frame.map_from_world * met_normal(hit, direction);
    vec2 slope = slope_of_plane(frame, point, normal, vpl_map_side(texel));
    store(at, vpl_map_depth(frame, hit.t * local), pack_slope(slope));
}
