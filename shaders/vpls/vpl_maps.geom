// Emits the square of a VPL's slot in its layer of the atlas. One invocation per VPL.
#include "scene/changed_boxes.glsl"
#include "vpls/mapped_vpl.glsl"
#include "vpls/vpl_atlas.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

flat in uint vpl_id[];
flat out uint vpl_index;

void main() {
    if (!has_map(vpl_id[0])) return;
    MappedVpl vpl = mapped_vpl(vpl_id[0]);
    bool sees_above = vpl_map_frame(vpl.position, vpl.normal).bend > 0.0;
    if (sees_above && !may_have_changed_above(vpl.position, vpl.normal)) return;
    VplTile tile = vpl_tile(vpl_id[0]);
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 texel = tile.corner + uvec2(i & 1u, i >> 1u) * vpl_constants.map_resolution;
        gl_Position = vec4(vec2(texel) / vpl_constants.map_side * 2.0 - 1.0, 0.0, 1.0);
        gl_Layer = int(tile.layer);
        vpl_index = vpl_id[0];
        EmitVertex();
    }
    EndPrimitive();
}
