#include "mesh_surface.glsl"
#include "light_list_all.glsl"
#include "lighting.glsl"

uniform mat4 world_from_clip;
uniform vec2 target_size;

layout(location = 0) out vec4 radiance;

void main() {
    Surface surfaces[SURFACES];
    vec3 reflected[SURFACES];
    surfaces[0] = unpack_surface(fragment_surface(), gl_FragCoord.xyz, target_size, world_from_clip);
    reflect_radiance(surfaces, reflected);
    radiance = vec4(reflected[0], 1.0);
}
