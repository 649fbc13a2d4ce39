// Evaluates the light at a surface; all shading paths use it. Direct light comes from the lights of light_list.glsl,
// with shadows. Indirect light is either read from an image that earlier passes gathered (INDIRECT_IRRADIANCE) or
// summed over the VPLs (VPLS). An invocation shades SURFACES surfaces, which share the light list of the first one
// unless LIGHT_LIST_PER_SURFACE is defined.
#include "bindings.glsl"
#include "indirect/gathered.glsl"
#include "lights/light_list.glsl"
#include "lights/lights.glsl"
#include "lights/shadow.glsl"
#include "loop_part.glsl"
#include "shading/gloss.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"

#ifndef SURFACES
#define SURFACES 1
#endif

// What a surface reflects towards the viewer: a sum over the lights for each lobe of its material, without the factors
// that all lights share, which radiance_of applies.
struct Reflected {
    vec3 diffuse;  // the irradiance
#ifdef GLOSSY
    vec3 mirror;  // radiance
#endif
};

#ifdef GLOSSY

void add_from(inout Reflected reflected, vec3 irradiance, Response response) {
    reflected.diffuse += response.diffuse * irradiance;
    reflected.mirror += response.mirror * irradiance;
}

void add_from_direction(inout Reflected reflected, vec3 irradiance, vec3 direction, Surface surface) {
    add_from(reflected, irradiance, response_to(direction, surface));
}

void add_from_all_sides(inout Reflected reflected, vec3 irradiance, Surface surface) {
    add_from(reflected, irradiance, response_to_all_sides(surface));
}

Reflected nothing_reflected() { return Reflected(vec3(0.0), vec3(0.0)); }

vec3 radiance_of(Reflected reflected, Surface surface) {
    return surface.albedo / PI * reflected.diffuse + reflected.mirror;
}

#else

void add_from_direction(inout Reflected reflected, vec3 irradiance, vec3 direction, Surface surface) {
    reflected.diffuse += irradiance;
}

void add_from_all_sides(inout Reflected reflected, vec3 irradiance, Surface surface) { reflected.diffuse += irradiance; }

Reflected nothing_reflected() { return Reflected(vec3(0.0)); }

vec3 radiance_of(Reflected reflected, Surface surface) { return surface.albedo / PI * reflected.diffuse; }

#endif

// `light` is lights[index].
void add_light(inout Reflected reflected, uint index, Light light, Surface surface) {
    Incident incident = incident_light(light, surface.position);
    float cos_surface = dot(shading_normal(surface), incident.direction);
    if (cos_surface <= 0.0 || incident.irradiance == vec3(0.0)) return;
#ifdef BUMPY
    if (dot(face_normal(surface), incident.direction) <= 0.0) return;
#endif
    vec3 irradiance = incident.irradiance * (cos_surface * shadow_visibility(index, light, surface));
    add_from_direction(reflected, irradiance, incident.direction, surface);
}

#ifndef DIRECT_HIDDEN

// Adds the lights of the surfaces' list. Loops over lights outside and surfaces inside, so that each light is fetched
// once.
void add_lights(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout Reflected reflected[SURFACES]) {
#ifdef LIGHT_LIST_PER_SURFACE
    for (int s = 0; s < SURFACES; ++s) {
        LightListRange list = light_list_at(pixels[s], surfaces[s].position);
        for (uint i = part_first; i < min(list.size, part_first + part_size); ++i) {
            uint index = light_list_entry(list, i);
            add_light(reflected[s], index, lights[index], surfaces[s]);
        }
    }
#else
    LightListRange list = light_list_at(pixels[0], surfaces[0].position);
    for (uint i = part_first; i < min(list.size, part_first + part_size); ++i) {
        uint index = light_list_entry(list, i);
        Light light = lights[index];
        for (int s = 0; s < SURFACES; ++s) add_light(reflected[s], index, light, surfaces[s]);
    }
#endif
}

#else

void add_lights(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout Reflected reflected[SURFACES]) {}

#endif

// A sum of VPLs some of which are negative may be so, too. `weight`: of the VPLs.
void add_gathered_light(inout Reflected reflected, Gathered gathered, float weight, Surface surface) {
    vec3 irradiance = max(irradiance_of(gathered, surface), 0.0) * weight / PI;
    add_from_all_sides(reflected, open_share(surface) * irradiance, surface);
}

#ifdef INDIRECT_IRRADIANCE

layout(binding = UNIT_INDIRECT) uniform sampler2D indirect_irradiance;
#ifdef DIRECTED
layout(binding = UNIT_INDIRECT_DIRECTION) uniform sampler2D indirect_flow;
#endif

// Adds the light of the VPLs, as vpl_gather.comp and later passes computed it.
void add_indirect(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout Reflected reflected[SURFACES]) {
    for (int s = 0; s < SURFACES; ++s) {
        Gathered gathered;
        gathered.irradiance = texelFetch(indirect_irradiance, ivec2(pixels[s]), 0).rgb;
#ifdef DIRECTED
        gathered.flow = texelFetch(indirect_flow, ivec2(pixels[s]), 0);
#endif
        add_gathered_light(reflected[s], gathered, 1.0, surfaces[s]);
    }
}

#elif defined(VPLS)

#include "indirect/vpl_light.glsl"

// Adds the light of the VPLs. There are no lists of VPLs, as a VPL reaches everything in front of it. If there are more
// than MOST_VPLS, every n-th VPL is used and the sum multiplied by n, with an odd n, because paths often have an even
// number of VPLs and all bounces should be used; neighbouring pixels use different VPLs.
void add_indirect(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout Reflected reflected[SURFACES]) {
    Gathered gathered[SURFACES];
    for (int s = 0; s < SURFACES; ++s) gathered[s] = nothing_gathered();
    uint count = vpl_constants.count;
    uint vpl_stride = count <= uint(MOST_VPLS) ? 1u : (count + uint(MOST_VPLS) - 1u) / uint(MOST_VPLS) | 1u;
    add_vpls(vpl_list((pixels[0].x + 5u * pixels[0].y) % vpl_stride, vpl_stride, count), surfaces, gathered);
    for (int s = 0; s < SURFACES; ++s) add_gathered_light(reflected[s], gathered[s], float(vpl_stride), surfaces[s]);
}

#else

void add_indirect(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], inout Reflected reflected[SURFACES]) {}

#endif

#if defined(SHOW_ALBEDO) || defined(SHOW_NORMALS) || defined(SHOW_ROUGHNESS) || defined(SHOW_METALNESS)

// What the surfaces are, instead of their light. In a scene without glossy ones, all are as rough as can be.
#define SHOW_SURFACES
void reflect_radiance(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], out vec3 radiance[SURFACES]) {
    for (int s = 0; s < SURFACES; ++s) {
#ifdef SHOW_ALBEDO
        radiance[s] = surfaces[s].albedo;
#elif defined(SHOW_ROUGHNESS) && defined(GLOSSY)
        radiance[s] = vec3(surfaces[s].roughness);
#elif defined(SHOW_ROUGHNESS)
        radiance[s] = vec3(1.0);
#elif defined(SHOW_METALNESS) && defined(GLOSSY)
        radiance[s] = vec3(surfaces[s].metalness);
#elif defined(SHOW_METALNESS)
        radiance[s] = vec3(0.0);
#else
        radiance[s] = 0.5 * shading_normal(surfaces[s]) + 0.5;
#endif
    }
}

#else

// Radiance that the surfaces reflect. `pixels`: their pixels, counted from the target's lower left corner.
// SHOW_IRRADIANCE: as if they were white.
void reflect_radiance(Surface surfaces[SURFACES], uvec2 pixels[SURFACES], out vec3 radiance[SURFACES]) {
    Reflected reflected[SURFACES];
    for (int s = 0; s < SURFACES; ++s) reflected[s] = nothing_reflected();
    add_lights(surfaces, pixels, reflected);
    if (part_first == 0u) add_indirect(surfaces, pixels, reflected);
#ifdef SHOW_IRRADIANCE
    for (int s = 0; s < SURFACES; ++s) surfaces[s].albedo = vec3(1.0);
#endif
    for (int s = 0; s < SURFACES; ++s) radiance[s] = radiance_of(reflected[s], surfaces[s]);
}

#endif
