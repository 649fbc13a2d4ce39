// What virtual point lights send to a surface.
#include "bindings.glsl"
#include "surface.glsl"
#include "types.glsl"
#include "vpl_constants.glsl"
#include "vpl_visibility.glsl"

layout(std430, binding = BINDING_VPLS) readonly restrict buffer Vpls { Vpl vpls[]; };

// 1 above the surface that a VPL sits on, 0 beyond its edges, with a rim a quarter as wide between; `aside`: from the
// VPL, in its plane. Towards a straight edge `ahead` is the share of the way to it.
float share_on_surface(Vpl vpl, vec3 aside) {
    float ahead = dot(max(aside * vpl.edges_up, -aside * vpl.edges_down), vec3(1.0));
    return clamp(5.0 - 4.0 * ahead, 0.0, 1.0);
}

// Geometry term cos θ cos θ' / r² between the surface and a VPL (Keller, "Instant Radiosity", 1997), kept from growing
// beyond 4/3 of 1/R², R² being vpl_constants.radius2, in two ways, as the surface turns to the VPL. Facing it, the VPL stands for
// a disc, whose form factor on its axis is R² / (R² + r²) and not R² / r² (Howell et al., "Thermal Radiation Heat
// Transfer", configuration factor of a disc). Square to it that would darken creases, where a wall takes up half of the
// floor's sky from however near: there the VPL is seen as if it sank behind its own surface, by R at contact and R²/r
// farther off, which leaves the half, to within R over the wall's height. Beyond an edge of the VPL's surface there is no
// crease, and it remains a disc. Multiplied by flux/π the term is the irradiance.
float geometry_term(Vpl vpl, Surface surface) {
    vec3 to_vpl = vpl.position - surface.position;
    float height = -dot(vpl.normal, to_vpl);
    if (height <= -vpl_constants.crease_slack) return 0.0;
    height = max(height, 0.0);
    float square = 1.0 - max(-dot(vpl.normal, surface.normal), 0.0);
    square *= share_on_surface(vpl, -to_vpl - height * vpl.normal);
    float depth = square * vpl_constants.radius2 * inversesqrt(vpl_constants.radius2 + max(dot(to_vpl, to_vpl), 1e-12));
    vec3 to_sunk = to_vpl - depth * vpl.normal;
    float distance2 = max(dot(to_sunk, to_sunk), 1e-12);
    float cos_surface = max(dot(surface.normal, to_sunk), 0.0);
    return cos_surface * (height + depth) / (distance2 * (distance2 + (1.0 - square) * vpl_constants.radius2));
}

// Geometry term times the share of the light that nothing holds back; that is looked up only where there is light.
float visible_geometry_term(Vpl vpl, Surface surface) {
    float geometry = geometry_term(vpl, surface);
    if (geometry > 0.0) geometry *= vpl_visibility(vpl, surface);
    return geometry;
}

// π times the irradiance from the VPL.
vec3 irradiance_from_vpl(Vpl vpl, Surface surface) { return vpl.flux * visible_geometry_term(vpl, surface); }
