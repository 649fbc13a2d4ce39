// The square of a VPL's tile, in the layer of the atlas that the tile is in.
#include "bindings.glsl"
#include "types.glsl"
#include "vpl_atlas.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(std430, binding = BINDING_VPLS) readonly restrict buffer Vpls { Vpl vpls[]; };

flat in uint due_vpl[];
flat out uint mapped_vpl;

void main() {
    if (vpls[due_vpl[0]].normal == vec3(0.0)) return;  // no path came so far
    VplTile tile = vpl_tile(vpls[due_vpl[0]].map);
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 texel = tile.corner + uvec2(i & 1u, i >> 1u) * vpl_constants.map_resolution;
        gl_Position = vec4(vec2(texel) / vpl_constants.map_side * 2.0 - 1.0, 0.0, 1.0);
        gl_Layer = int(tile.layer);
        mapped_vpl = due_vpl[0];
        EmitVertex();
    }
    EndPrimitive();
}
