// Light of all VPLs at a grid of pixels: renderer/passes/indirect/vpl_error.hpp. One invocation per pixel.
#include "bindings.glsl"
#include "loop_part.glsl"
#include "surfaces/visible_surface.glsl"
#include "indirect/vpl_light.glsl"

layout(local_size_x = SAMPLE_GROUP) in;

layout(std430, binding = BINDING_VPL_SAMPLES) restrict buffer Samples { vec4 samples[]; };

void main() {
    uvec2 cell = uvec2(gl_GlobalInvocationID.x % SAMPLE_COLUMNS, gl_GlobalInvocationID.x / SAMPLE_COLUMNS);
    if (cell.y >= SAMPLE_ROWS) return;
    ivec2 at = ivec2((vec2(cell) + 0.5) / vec2(SAMPLE_COLUMNS, SAMPLE_ROWS) * view.target_size);
    float depth = texelFetch(surface_depth, at, 0).r;
    Surface surfaces[SURFACES];
    Gathered gathered[SURFACES];
    surfaces[0] = visible_surface(at, depth, vec3(0.0));
    gathered[0] = nothing_gathered();
    uint end = depth > 0.0 ? min(vpl_constants.count, part_first + part_size) : 0u;
    add_vpls(vpl_list(part_first, 1u, end), surfaces, gathered);
    uint id = gl_GlobalInvocationID.x;
    vec3 before = part_first > 0u ? samples[id].rgb : vec3(0.0);
    samples[id] = vec4(before + gathered[0].irradiance, depth > 0.0 ? 1.0 : 0.0);
}
