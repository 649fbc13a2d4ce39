// Irradiance at any point: of the lights that are shown, with their shadows, and of VPLs (VPLS).
#include "bindings.glsl"
#include "indirect/gathered.glsl"
#include "lights/light_constants.glsl"
#include "lights/lights.glsl"
#include "lights/shadow.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"
#ifdef VPLS
#include "indirect/vpl_light.glsl"
#endif

// A small white surface without thickness, seen from the front.
Surface surface_at(vec3 position, vec3 normal) {
    Surface surface;
    surface.position = position;
    surface.normal = normal;
    surface.albedo = vec3(1.0);
    surface.to_viewer = normal;
    surface.pixel = 0.0;
    return surface;
}

#ifdef DIRECT_HIDDEN
uint shown_light_count() { return 0u; }
#else
uint shown_light_count() { return light_constants.count; }
#endif

// Light from lights[index] that reaches the surface; none from behind it.
Incident light_at(uint index, Surface surface) {
    Light light = lights[index];
    Incident incident = incident_light(light, surface.position);
    if (dot(face_normal(surface), incident.direction) <= 0.0 || incident.irradiance == vec3(0.0)) {
        return Incident(incident.direction, vec3(0.0));
    }
    return Incident(incident.direction, incident.irradiance * shadow_visibility(index, light, surface));
}

// Of the lights from `first` on, before `end`.
vec3 irradiance_from_lights(uint first, uint end, Surface surface) {
    vec3 sum = vec3(0.0);
    for (uint i = first; i < min(end, shown_light_count()); ++i) {
        Incident incident = light_at(i, surface);
        sum += incident.irradiance * max(dot(face_normal(surface), incident.direction), 0.0);
    }
    return sum;
}

#ifdef VPLS

// Of every stride-th VPL from `first` on, before `end`.
vec3 irradiance_from_vpls(uint first, uint end, uint stride, Surface surface) {
    Surface surfaces[SURFACES];
    Gathered gathered[SURFACES];
    surfaces[0] = surface;
    gathered[0] = nothing_gathered();
    add_vpls(vpl_list(first, stride, min(end, vpl_constants.count)), surfaces, gathered);
    return gathered[0].irradiance / PI;
}

#else

vec3 irradiance_from_vpls(uint first, uint end, uint stride, Surface surface) { return vec3(0.0); }

#endif
