// Evaluates the light at a surface; all shading paths use it. Direct light comes from the lights of light_list.glsl,
// with shadows. Indirect light is either read from an image that earlier passes gathered (INDIRECT_IRRADIANCE) or
// summed over the VPLs (VPLS). An invocation shades SURFACES surfaces, which share the light list of the first one
// unless LIGHT_LIST_PER_SURFACE is defined.
#include "bindings.glsl"
#include "lights/light_list.glsl"
#include "lights/lights.glsl"
#include "lights/shadow.glsl"
#include "loop_part.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"

#ifndef SURFACES
#define SURFACES 1
#endif

layout(std430, binding = BINDING_LIGHTS) readonly restrict buffer Lights { Light lights[]; };

// `light` is lights[index].
vec3 irradiance_from_light(uint index, Light light, Surface surface) {
    Incident incident = incident_light(light, surface.position);
    float cos_surface = dot(shading_normal(surface), incident.direction);
    if (cos_surface <= 0.0 || incident.irradiance == vec3(0.0)) return vec3(0.0);
    return incident.irradiance * (cos_surface * shadow_visibility(index, light, surface));
}

#ifndef DIRECT_HIDDEN

// Adds the irradiance from the lights of the surfaces' list. Loops over lights outside and surfaces inside, so that
// each light is fetched once.
void gather_lights(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout vec3 irradiance[SURFACES]) {
#ifdef LIGHT_LIST_PER_SURFACE
    for (int s = 0; s < SURFACES; ++s) {
        LightListRange list = light_list_at(pixels[s], surfaces[s].position);
        for (uint i = part_first; i < min(list.size, part_first + part_size); ++i) {
            uint index = light_list_entry(list, i);
            irradiance[s] += irradiance_from_light(index, lights[index], surfaces[s]);
        }
    }
#else
    LightListRange list = light_list_at(pixels[0], surfaces[0].position);
    for (uint i = part_first; i < min(list.size, part_first + part_size); ++i) {
        uint index = light_list_entry(list, i);
        Light light = lights[index];
        for (int s = 0; s < SURFACES; ++s) irradiance[s] += irradiance_from_light(index, light, surfaces[s]);
    }
#endif
}

#else

void gather_lights(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout vec3 irradiance[SURFACES]) {}

#endif

#ifdef INDIRECT_IRRADIANCE

layout(binding = UNIT_INDIRECT) uniform sampler2D indirect_irradiance;

// π times the irradiance from the VPLs, as vpl_gather.comp and later passes computed it.
void gather_indirect(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout vec3 irradiance[SURFACES]) {
    for (int s = 0; s < SURFACES; ++s) irradiance[s] = texelFetch(indirect_irradiance, ivec2(pixels[s]), 0).rgb;
}

#elif defined(VPLS)

#include "indirect/vpl_light.glsl"

// π times the irradiance from the VPLs. There are no lists of VPLs, as a VPL reaches everything in front of it. If there
// are more than MOST_VPLS, every n-th VPL is used and the sum multiplied by n, with an odd n, because paths often have an even
// number of VPLs and all bounces should be used; neighbouring pixels use different VPLs.
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

#if defined(SHOW_ALBEDO) || defined(SHOW_NORMALS)

// What the surfaces are, instead of their light.
void reflect_radiance(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], out vec3 radiance[SURFACES]) {
    for (int s = 0; s < SURFACES; ++s) {
#ifdef SHOW_ALBEDO
        radiance[s] = surfaces[s].albedo;
#else
        radiance[s] = 0.5 * shading_normal(surfaces[s]) + 0.5;
#endif
    }
}

#else

// Radiance that the surfaces reflect: ρ/π times their irradiance. `pixels`: their pixels, counted from the target's
// lower left corner. SHOW_IRRADIANCE: as if they were white.
void reflect_radiance(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], out vec3 radiance[SURFACES]) {
    vec3 direct[SURFACES];
    vec3 indirect[SURFACES];
    for (int s = 0; s < SURFACES; ++s) direct[s] = indirect[s] = vec3(0.0);
    gather_lights(surfaces, pixels, direct);
    if (part_first == 0u) gather_indirect(surfaces, pixels, indirect);
#ifdef SHOW_IRRADIANCE
    for (int s = 0; s < SURFACES; ++s) surfaces[s].albedo = vec3(1.0);
#endif
    for (int s = 0; s < SURFACES; ++s) radiance[s] = surfaces[s].albedo / PI * (direct[s] + indirect[s] / PI);
}

#endif
