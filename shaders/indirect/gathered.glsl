// The light that a surface has gathered from VPLs, for its face normal, and (DIRECTED) how it is distributed over
// directions, so that normal textures show in it. See README.md, "Direction of gathered light".
#include "surfaces/surface.glsl"

struct Gathered {
    vec3 irradiance;  // times π
#ifdef DIRECTED
    // Sums over the VPLs, of what a surface that faces one receives from it, mean of the channels: times its direction,
    // and (alpha) alone.
    vec4 flow;
#endif
};

#ifdef DIRECTED

const float LEAST_FACING = 0.05;  // cosine: keeps the flow from VPLs at the horizon finite

Gathered nothing_gathered() { return Gathered(vec3(0.0), vec4(0.0)); }

// Adds π times the irradiance from a VPL that lies in that direction, of any length.
void add_gathered(inout Gathered gathered, vec3 irradiance, vec3 to_vpl, Surface surface) {
    if (irradiance == vec3(0.0)) return;
    vec3 direction = to_vpl * inversesqrt(max(dot(to_vpl, to_vpl), 1e-20));
    float received = dot(irradiance, vec3(1.0 / 3.0)) / max(dot(direction, face_normal(surface)), LEAST_FACING);
    gathered.irradiance += irradiance;
    gathered.flow += received * vec4(direction, 1.0);
}

// Irradiance for a normal over that from the direction `main` alone: light from there and, as far as `spread`, from all
// the hemisphere around it.
float share_facing(vec3 normal, vec3 main, float spread) {
    float cosine = dot(normal, main);
    return mix(max(cosine, 0.0), 0.5 + 0.5 * cosine, spread);
}

// π times the irradiance for the shading normal.
vec3 irradiance_of(Gathered gathered, Surface surface) {
    float flow = length(gathered.flow.xyz);
    if (flow == 0.0 || gathered.flow.w <= 0.0) return gathered.irradiance;
    vec3 main = gathered.flow.xyz / flow;
    float spread = clamp(2.0 - 2.0 * flow / gathered.flow.w, 0.0, 1.0);
    float for_face = share_facing(face_normal(surface), main, spread);
    float more = max(LEAST_FACING - for_face, 0.0);
    return gathered.irradiance * ((share_facing(shading_normal(surface), main, spread) + more) / (for_face + more));
}

#else

Gathered nothing_gathered() { return Gathered(vec3(0.0)); }

void add_gathered(inout Gathered gathered, vec3 irradiance, vec3 to_vpl, Surface surface) {
    gathered.irradiance += irradiance;
}

vec3 irradiance_of(Gathered gathered, Surface surface) { return gathered.irradiance; }

#endif
