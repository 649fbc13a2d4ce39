// What virtual point lights send to a surface.
#include "bindings.glsl"
#include "disc.glsl"
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
// beyond 4/3 of 1/R², R² being vpl_constants.radius2: the VPL stands for a disc. Beyond an edge of its surface there is no
// crease, and it does not sink. Multiplied by flux/π the term is the irradiance.
float geometry_term(Vpl vpl, Surface surface) {
    vec3 to_vpl = vpl.position - surface.position;
    float height = -dot(vpl.normal, to_vpl);
    if (height <= -vpl_constants.crease_slack) return 0.0;
    height = max(height, 0.0);
    float square = squareness(vpl.normal, surface.normal) * share_on_surface(vpl, -to_vpl - height * vpl.normal);
    return sinking_disc_term(to_vpl, height, vpl.normal, vpl_constants.radius2, square, surface.normal);
}

#ifndef SURFELS

// Geometry term times the share of the light that nothing holds back; that is looked up only where there is light.
float visible_geometry_term(Vpl vpl, Surface surface) {
    float geometry = geometry_term(vpl, surface);
    if (geometry > 0.0) geometry *= vpl_visibility(vpl, surface);
    return geometry;
}

// π times the irradiance from the VPL.
vec3 irradiance_from_vpl(Vpl vpl, Surface surface) { return vpl.flux * visible_geometry_term(vpl, surface); }

#else

layout(std430, binding = BINDING_LIT_POINTS) readonly restrict buffer LitPoints { LitPoint lit_points[]; };

// π times the irradiance from the cell of a surfel, were nothing in the way.
vec3 unoccluded_from_cell(Vpl vpl, Surface surface) {
    if (!is_near(vpl.map_origin - surface.position, vpl.area)) {
        return vpl.flux * disc_term(vpl.position, vpl.normal, vpl.radius2, surface.position, surface.normal);
    }
    vec3 sum = vec3(0.0);
    for (uint i = vpl.first_point; i < vpl.first_point + vpl.point_count; ++i) {
        LitPoint point = lit_points[i];
        sum += point.flux * disc_term(point.position, point.normal, point.area / PI, surface.position, surface.normal);
    }
    return sum;
}

// π times the irradiance from the VPL.
vec3 irradiance_from_vpl(Vpl vpl, Surface surface) {
    if (vpl.flux == vec3(0.0)) return vec3(0.0);
    vec3 unoccluded = unoccluded_from_cell(vpl, surface);
    return unoccluded == vec3(0.0) ? unoccluded : unoccluded * vpl_visibility(vpl, surface);
}

#endif
