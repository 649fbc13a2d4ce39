// The one evaluator of light: real lights with their shadows, and light by way of surfaces, which has been gathered before
// (INDIRECT_IRRADIANCE) or comes from the VPLs (VPLS). A shading path finds the surfaces; light_list.glsl says which lights each of
// them visits. An invocation shades SURFACES of them, which have one list together unless LIGHT_LIST_PER_SURFACE says
// otherwise.
#include "bindings.glsl"
#include "light_list.glsl"
#include "lights.glsl"
#include "shadow.glsl"
#include "surface.glsl"
#include "types.glsl"

#ifndef SURFACES
#define SURFACES 1
#endif

uniform uint lights_before;  // entries of each list, in the dispatches or draws before this one
uniform uint lights_now;     // at most

layout(std430, binding = BINDING_LIGHTS) readonly restrict buffer Lights { Light lights[]; };

vec3 irradiance_from_light(Light light, Surface surface) {
    Incident incident = incident_light(light, surface.position);
    float cos_surface = dot(surface.normal, incident.direction);
    if (cos_surface <= 0.0 || incident.irradiance == vec3(0.0)) return vec3(0.0);
    float visibility = shadow_visibility(light.shadow, surface.position, surface.normal, light.position);
    return incident.irradiance * (cos_surface * visibility);
}

// Irradiance from the lights that the surfaces visit, light by light, so that each is fetched once for all of them.
void gather_lights(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout vec3 irradiance[SURFACES]) {
#ifdef LIGHT_LIST_PER_SURFACE
    for (int s = 0; s < SURFACES; ++s) {
        LightListRange list = light_list_at(pixels[s], surfaces[s].position);
        for (uint i = lights_before; i < min(list.size, lights_before + lights_now); ++i) {
            irradiance[s] += irradiance_from_light(lights[light_list_entry(list, i)], surfaces[s]);
        }
    }
#else
    LightListRange list = light_list_at(pixels[0], surfaces[0].position);
    for (uint i = lights_before; i < min(list.size, lights_before + lights_now); ++i) {
        Light light = lights[light_list_entry(list, i)];
        for (int s = 0; s < SURFACES; ++s) irradiance[s] += irradiance_from_light(light, surfaces[s]);
    }
#endif
}

#ifdef INDIRECT_IRRADIANCE

layout(binding = UNIT_INDIRECT) uniform sampler2D indirect_irradiance;

// π times the irradiance from the VPLs, which has been gathered before: vpl_gather.comp.
void gather_indirect(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout vec3 irradiance[SURFACES]) {
    for (int s = 0; s < SURFACES; ++s) irradiance[s] = texelFetch(indirect_irradiance, ivec2(pixels[s]), 0).rgb;
}

#elif defined(VPLS)

#include "vpl_light.glsl"

// π times the irradiance from the VPLs. All surfaces visit all of them: a VPL reaches everything in front of it. Where they
// are too many, every vpl_stride-th of them stands for all, and for pixels side by side not the same ones.
void gather_indirect(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout vec3 irradiance[SURFACES]) {
    uint count = vpl_constants.count;
    uint vpl_stride = count <= uint(MOST_VPLS) ? 1u : (count + uint(MOST_VPLS) - 1u) / uint(MOST_VPLS) | 1u;
    for (uint i = (pixels[0].x + 5u * pixels[0].y) % vpl_stride; i < count; i += vpl_stride) {
        Vpl vpl = vpls[i];
        for (int s = 0; s < SURFACES; ++s) irradiance[s] += irradiance_from_vpl(vpl, surfaces[s]);
    }
    for (int s = 0; s < SURFACES; ++s) irradiance[s] *= float(vpl_stride);
}

#else

void gather_indirect(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout vec3 irradiance[SURFACES]) {}

#endif

// Radiance that surfaces reflect: ρ/π times their irradiance. `pixels` are theirs, from the target's lower left.
void reflect_radiance(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], out vec3 radiance[SURFACES]) {
    vec3 direct[SURFACES];
    vec3 indirect[SURFACES];
    for (int s = 0; s < SURFACES; ++s) direct[s] = indirect[s] = vec3(0.0);
    gather_lights(surfaces, pixels, direct);
    if (lights_before == 0u) gather_indirect(surfaces, pixels, indirect);
    for (int s = 0; s < SURFACES; ++s) radiance[s] = surfaces[s].albedo / PI * (direct[s] + indirect[s] / PI);
}
