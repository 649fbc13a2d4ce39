// Emits the square of a VPL's slot in its layer of the atlas, if anything in it may have changed. One invocation per VPL
// or freed slot.
#include "scene/changed_boxes.glsl"
#include "vpls/mapped_vpl.glsl"
#include "vpls/vpl_atlas.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

flat in uint vpl_id[];
flat out uint vpl_index;

bool is_outdated(uint index, MappedVpl vpl) {
    uint task = map_task(index);
    if ((task & SURFEL_NO_MAP) != 0u) return false;
    if (everything_changed) return has_map(index);  // the atlas is cleared
    if ((task & SURFEL_WHOLE) != 0u) return true;
    if ((task & SURFEL_CHANGED) == 0u) return false;
    bool sees_above = (vpl.map & SURFEL_MAP_OF_FOCUS) == 0u;
    return has_map(index) && (!sees_above || may_have_changed_above(vpl.position, vpl.normal));
}

void main() {
    MappedVpl vpl = mapped_vpl(vpl_id[0]);
    if (!is_outdated(vpl_id[0], vpl)) return;
    VplTile tile = vpl_tile(vpl.map);
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 texel = tile.corner + uvec2(i & 1u, i >> 1u) * vpl_constants.map_resolution;
        gl_Position = vec4(vec2(texel) / vpl_constants.map_side * 2.0 - 1.0, 0.0, 1.0);
        gl_Layer = int(tile.layer);
        vpl_index = vpl_id[0];
        EmitVertex();
    }
    EndPrimitive();
}
