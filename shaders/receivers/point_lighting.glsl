// Functions for the shaders of a host, which give the light at any point as far as the configuration shows it. Positions
// are in world space, in metres; normals in world space, of unit length; irradiance in lux or W/m².
#include "receivers/light_at_point.glsl"

// Number of lights.
uint candela_light_count() { return shown_light_count(); }

// Light number `index` at a surface, for a reflection of the host's own: `direction`, towards the light, of unit length,
// and `irradiance` of what faces the light, with the shadow. A light behind the surface gives none.
Incident candela_light(uint index, vec3 position, vec3 normal) { return light_at(index, surface_at(position, normal)); }

// The same at a point of the air, such as fog.
Incident candela_light(uint index, vec3 position) {
    vec3 direction = incident_light(lights[index], position).direction;
    return light_at(index, surface_at(position, direction));
}

// Irradiance from all lights.
vec3 candela_irradiance_from_lights(vec3 position, vec3 normal) {
    return irradiance_from_lights(0u, shown_light_count(), surface_at(position, normal));
}

#ifdef VPLS
uint candela_vpl_count() { return vpl_constants.count; }
const uint CANDELA_MOST_VPLS = uint(MOST_VPLS);
#else
uint candela_vpl_count() { return 0u; }
const uint CANDELA_MOST_VPLS = 1u;
#endif

// Irradiance from VPLs: what surfaces reflect and emit, and the sky. If there are more VPLs than `most`, every n-th stands
// for n; which ones depends on `pattern`, for example a particle's number. A software driver stops all loops of an
// invocation after 65,535 iterations in total: more than CANDELA_MOST_VPLS in an invocation may be too many for it.
vec3 candela_irradiance_from_vpls(vec3 position, vec3 normal, uint most, uint pattern) {
    uint stride = (candela_vpl_count() + most - 1u) / most | 1u;  // odd, as in shading/lighting.glsl
    Surface surface = surface_at(position, normal);
    vec3 sum = irradiance_from_vpls(pattern % stride, candela_vpl_count(), stride, surface);
    return float(stride) * max(sum, 0.0);  // some VPLs are negative
}

// Irradiance from everything.
vec3 candela_irradiance(vec3 position, vec3 normal, uint pattern) {
    return candela_irradiance_from_lights(position, normal) +
           candela_irradiance_from_vpls(position, normal, CANDELA_MOST_VPLS, pattern);
}
