// What every kind of light says of itself.
#include "types.glsl"

struct Incident {
    vec3 direction;   // unit, towards the light
    vec3 irradiance;  // on a surface that faces the light, unoccluded; lux or W/m²
};

// A ray that leaves a light.
struct Emission {
    vec3 origin;     // metres
    vec3 direction;  // unit
};
