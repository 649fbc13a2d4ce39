// One point for each map that is due; vpl_maps.geom makes a tile of it.
#include "bindings.glsl"

layout(std430, binding = BINDING_MAPS_DUE) readonly restrict buffer MapsDue { uint maps_due[]; };

flat out uint due_vpl;

void main() {
    due_vpl = maps_due[gl_VertexID];
    gl_Position = vec4(0.0);
}
