// Directional lights; the CPU's half is renderer/passes/lights/directional_light.cpp.
#include "lights/incident.glsl"
#include "maths.glsl"

Incident incident_from_directional(Light light) { return Incident(-light.direction, light.intensity); }

// Rays start on the light's footprint.
Emission emission_of_directional(Light light, vec2 u) {
    vec3 tangent, bitangent;
    basis_around(light.direction, tangent, bitangent);
    vec2 at = (2.0 * u - 1.0) * light.shape;
    return Emission(light.position + (at.x * tangent + at.y * bitangent), light.direction);
}
