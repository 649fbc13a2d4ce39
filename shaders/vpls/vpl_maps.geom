// Emits the square of a VPL's slot in its layer of the atlas. One invocation per VPL.
#include "bindings.glsl"
#include "scene/changed_boxes.glsl"
#include "types.glsl"
#include "vpls/vpl_atlas.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(std430, binding = BINDING_VPLS) readonly restrict buffer Vpls { Vpl vpls[]; };

flat in uint vpl_id[];
flat out uint mapped_vpl;

void main() {
    Vpl vpl = vpls[vpl_id[0]];
    if (vpl.normal == vec3(0.0)) return;  // not in use: the path ended before this bounce
    if (vpl.map == NO_MAP) return;
    if (!may_have_changed_above(vpl.map_origin, vpl.normal)) return;
    VplTile tile = vpl_tile(vpl.map);
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 texel = tile.corner + uvec2(i & 1u, i >> 1u) * vpl_constants.map_resolution;
        gl_Position = vec4(vec2(texel) / vpl_constants.map_side * 2.0 - 1.0, 0.0, 1.0);
        gl_Layer = int(tile.layer);
        mapped_vpl = vpl_id[0];
        EmitVertex();
    }
    EndPrimitive();
}
