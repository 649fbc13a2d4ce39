// Depth map of a VPL: traces a ray through the centre of the texel. One fragment per texel.
#include "bindings.glsl"
#include "scene/bvh.glsl"
#include "scene/changed_boxes.glsl"
#include "types.glsl"
#include "vpls/vpl_atlas.glsl"

layout(std430, binding = BINDING_VPLS) readonly restrict buffer Vpls { Vpl vpls[]; };

flat in uint mapped_vpl;

void main() {
    // In helper invocations llvmpipe reads zeros from buffers; traversing a BVH of zeros would never end.
    if (gl_HelperInvocation) return;
    Vpl vpl = vpls[mapped_vpl];
    vec2 at = (gl_FragCoord.xy - vec2(vpl_tile(vpl.map).corner)) / float(vpl_constants.map_resolution);
    vec3 local = hemi_octahedral_decode(at * 2.0 - 1.0);
    vec3 tangent, bitangent;
    basis_around(vpl.normal, tangent, bitangent);
    vec3 direction = local.x * tangent + local.y * bitangent + local.z * vpl.normal;
    if (!may_have_changed(vpl_map_origin(vpl), direction, 1.0 / 0.0)) discard;
    Hit hit = closest_hit(vpl_map_origin(vpl), direction, 0.0, 1.0 / 0.0);
    gl_FragDepth = hit.triangle == NO_TRIANGLE ? 0.0 : vpl_map_depth(hit.t * local);
}
