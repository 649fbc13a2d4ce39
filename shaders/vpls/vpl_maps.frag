// Depth map of a VPL: traces a ray through the centre of the texel. Slots without a map are cleared. One fragment per
// texel.
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "scene/changed_boxes.glsl"
#include "vpls/mapped_vpl.glsl"
#include "vpls/vpl_atlas.glsl"

flat in uint vpl_index;

void main() {
    // Helper invocations need no ray. In them, llvmpipe reads zeros from buffers.
    if (gl_HelperInvocation) return;
    gl_FragDepth = 0.0;
    if (!has_map(vpl_index)) return;
    uint task = map_task(vpl_index);
    MappedVpl vpl = mapped_vpl(vpl_index);
    vec3 origin = vpl_map_origin(vpl.position, vpl.normal);
    vec2 at = (gl_FragCoord.xy - vec2(vpl_tile(vpl.map).corner)) / float(vpl_constants.map_resolution);
    MapFrame frame = vpl_map_frame(vpl.position, vpl.normal, vpl.map);
    vec3 local = normalize(vpl_map_point(frame, at * 2.0 - 1.0));
    vec3 direction = local * frame.map_from_world;
    if (!everything_changed && (task & SURFEL_WHOLE) == 0u && !may_have_changed(origin, direction, INFINITY)) discard;
    Hit hit = closest_hit(origin, direction, 0.0, INFINITY);
    gl_FragDepth = hit.triangle == NO_TRIANGLE ? 0.0 : vpl_map_depth(frame, hit.t * local);
}
