// Light that virtual point lights (VPLs) send to a surface.
#include "bindings.glsl"
#include "vpls/disc.glsl"
#include "sky/sky_patch.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"
#include "vpls/vpl_visibility.glsl"

layout(std430, binding = BINDING_VPLS) readonly restrict buffer Vpls { Vpl vpls[]; };

// 1 above the surface that a VPL lies on, 0 beyond its edges. Falls off linearly beyond an edge, over a quarter of the
// distance to it. `aside`: metres from the VPL, in its plane. `ahead`: distance towards a straight edge over the
// distance to it. See theory.md, "Edges of a VPL's surface".
float share_on_surface(Vpl vpl, vec3 aside) {
    float ahead = dot(max(aside * vpl.edges_up, -aside * vpl.edges_down), vec3(1.0));
    return clamp(5.0 - 4.0 * ahead, 0.0, 1.0);
}

// Geometry term cos θ cos θ' / r² between the surface and a VPL (Keller, "Instant Radiosity", 1997). It is at most 4/3
// of 1/R², R² being vpl_constants.radius2, as the VPL is treated as a disc (disc.glsl). Beyond an edge of the VPL's
// surface there is no crease, and the disc does not sink. Irradiance is flux/π times the term. See theory.md, "Bound of
// the geometry term".
float geometry_term(Vpl vpl, Surface surface) {
    vec3 to_vpl = vpl.position - surface.position;
    float height = -dot(vpl.normal, to_vpl);
    if (height <= -vpl_constants.crease_slack) return 0.0;
    height = max(height, 0.0);
    float tilt = tilt_of(vpl.normal, face_normal(surface)) * share_on_surface(vpl, -to_vpl - height * vpl.normal);
    return sinking_disc_term(to_vpl, height, vpl.normal, vpl_constants.radius2, tilt, shading_normal(surface));
}

#ifndef SURFELS

// Geometry term times visibility, which is looked up only where the term is not zero.
float visible_geometry_term(Vpl vpl, Surface surface) {
    float geometry = geometry_term(vpl, surface);
    if (geometry > 0.0) geometry *= vpl_visibility(vpl, surface);
    return geometry;
}

// π times the irradiance from the VPL.
vec3 irradiance_from_vpl(Vpl vpl, Surface surface) { return vpl.flux * visible_geometry_term(vpl, surface); }

#else

layout(std430, binding = BINDING_LIT_POINTS) readonly restrict buffer LitPoints { LitPoint lit_points[]; };

// disc_term at a visible surface.
float disc_term_at(Surface surface, vec3 position, vec3 normal, float radius2) {
    return disc_term(position, normal, radius2, surface.position, face_normal(surface), shading_normal(surface));
}

// Whether the points of a cell are evaluated one by one: near the cell, and always if it emits light (EMITTERS), as
// that light is direct.
bool is_resolved(Vpl vpl, Surface surface) {
#ifdef EMITTERS
    if (vpl.map == NO_MAP) return true;
#endif
    return is_near(vpl.map_origin - surface.position, vpl.area);
}

// π times the unoccluded irradiance from the cell of a surfel.
vec3 unoccluded_from_cell(Vpl vpl, Surface surface) {
    if (!is_resolved(vpl, surface)) {
        return vpl.flux * disc_term_at(surface, vpl.position, vpl.normal, vpl.radius2);
    }
    vec3 sum = vec3(0.0);
    for (uint i = vpl.first_point; i < vpl.first_point + vpl.point_count; ++i) {
        LitPoint point = lit_points[i];
        sum += point.flux * disc_term_at(surface, point.position, point.normal, point.area / PI);
    }
    return sum;
}

#ifdef SKY

// π times the irradiance from a patch of the sky.
vec3 irradiance_from_patch(Vpl sky_patch, Surface surface) {
    PatchLight light = light_of_patch(sky_patch, shading_normal(surface));
    if (light.cosine <= 0.0) return vec3(0.0);
    return sky_patch.flux * (light.cosine * visibility_of_sky(light.direction, surface));
}

#endif

// π times the irradiance from the VPL.
vec3 irradiance_from_vpl(Vpl vpl, Surface surface) {
    if (vpl.flux == vec3(0.0)) return vec3(0.0);
#ifdef SKY
    if (vpl.map == IN_SKY) return irradiance_from_patch(vpl, surface);
#endif
    vec3 unoccluded = unoccluded_from_cell(vpl, surface);
    return unoccluded == vec3(0.0) ? unoccluded : unoccluded * vpl_visibility(vpl, surface);
}

#endif
