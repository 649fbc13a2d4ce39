// Pixels that too few neighbours fit ask VPLs themselves: every `fill_stride`-th of them, in their order, each pixel from
// another one on. The two estimates are weighted by the VPLs behind them.
#include "bindings.glsl"
#include "vpl_light.glsl"

layout(local_size_x = FILL_GROUP) in;

layout(std430, binding = BINDING_VPL_ORDER) readonly restrict buffer VplOrder { uint vpl_order[]; };
layout(std430, binding = BINDING_LACKING) readonly restrict buffer Lacking {
    uint lacking_groups[3];
    uint lacking_count;
    uint lacking[];
};

uniform mat4 world_from_clip;
uniform vec2 target_size;
uniform uint fill_stride;

layout(binding = UNIT_NORMAL) uniform sampler2D surface_normal;
layout(binding = UNIT_DEPTH) uniform sampler2D surface_depth;
layout(rgba32f, binding = IMAGE_INDIRECT) restrict uniform image2D reconstructed;

void main() {
    if (gl_GlobalInvocationID.x >= lacking_count) return;
    uint packed_pixel = lacking[gl_GlobalInvocationID.x];
    ivec2 at = ivec2(packed_pixel & 0xffffu, packed_pixel >> 16);
    PackedSurface stored = PackedSurface(vec3(0.0), texelFetch(surface_normal, at, 0).rg);
    float depth = texelFetch(surface_depth, at, 0).r;
    Surface surface = unpack_surface(stored, vec3(vec2(at) + 0.5, depth), target_size, world_from_clip);
    vec3 irradiance = vec3(0.0);
    for (uint i = (uint(at.x) + 2u * uint(at.y)) % fill_stride; i < vpl_count; i += fill_stride) {
        irradiance += irradiance_from_vpl(vpls[vpl_order[i]], surface);
    }
    vec4 found = imageLoad(reconstructed, at);
    float asked = 1.0 / float(fill_stride);
    vec3 mean = (found.rgb * found.a + irradiance) / (found.a + asked);  // irradiance = asked · what all would send
    if (fill_stride == 1u) mean = irradiance;
    imageStore(reconstructed, at, vec4(mean, 1.0));
}
