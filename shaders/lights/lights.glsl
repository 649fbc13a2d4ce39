// The lights and their kinds, for shading, for the tracing of VPLs, for surfels and for culling.
#include "bindings.glsl"
#include "lights/directional_light.glsl"
#include "lights/point_light.glsl"
#include "lights/spot_light.glsl"
#include "maths.glsl"

layout(std430, binding = BINDING_LIGHTS) readonly restrict buffer Lights { Light lights[]; };

// Light that a light sends to a point.
Incident incident_light(Light light, vec3 position) {
    if (light.kind == LIGHT_DIRECTIONAL) return incident_from_directional(light);
    Incident incident = incident_from_point(light, position);
    if (light.kind == LIGHT_SPOT) incident.irradiance *= cone_falloff(light, incident.direction);
    return incident;
}

// The ray for `u` in [0, 1)². Each ray of a light carries the same flux.
Emission sample_emission(Light light, vec2 u) {
    if (light.kind == LIGHT_DIRECTIONAL) return emission_of_directional(light, u);
    if (light.kind == LIGHT_SPOT) return emission_of_spot(light, u);
    return emission_of_point(light, u);
}

// Distance to the light, metres.
float distance_to(Light light, vec3 position) {
    return light.kind == LIGHT_DIRECTIONAL ? INFINITY : length(light.position - position);
}

// Share of the light that its range lets through to a point.
float share_in_range(Light light, vec3 position) {
    return light.kind == LIGHT_DIRECTIONAL ? 1.0 : range_window(distance(light.position, position), light.range);
}

// Cosine of the half angle of a cone around the light's direction that contains its light; -1: everywhere.
float bounding_cone(Light light) { return light.kind == LIGHT_SPOT ? cone_of_spot(light) : -1.0; }
