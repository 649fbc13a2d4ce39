// Light that virtual point lights (VPLs) send to surfaces. The entry is add_vpls. An invocation has SURFACES surfaces.
#include "bindings.glsl"
#include "indirect/gathered.glsl"
#include "indirect/vpl_list.glsl"
#include "maths.glsl"
#include "vpls/disc.glsl"
#include "sky/sky_patch.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"
#include "vpls/vpl_visibility.glsl"

#ifndef SURFACES
#define SURFACES 1
#endif

#ifndef SURFELS

layout(binding = UNIT_TRACED_VPLS) uniform usamplerBuffer traced_vpl_texels;

TracedVpl traced_vpl_at(uint index) {
    uvec4 words[5];
    for (int i = 0; i < 5; ++i) {
        words[i] = texelFetch(traced_vpl_texels, 5 * int(index) + i);
    }
    return TracedVpl(uintBitsToFloat(words[0].xyz), words[0].w, uintBitsToFloat(words[1].xyz), uintBitsToFloat(words[1].w),
                     uintBitsToFloat(words[2].xyz), 0.0, uintBitsToFloat(words[3].xyz), 0.0, uintBitsToFloat(words[4].xyz), 0.0);
}

const float CREASE_SLACK = 16.0;  // ray offsets: a receiver this little behind a VPL's plane counts as in front of it

// 1 above the surface that a VPL lies on, 0 beyond its edges. Falls off linearly beyond an edge, over a quarter of the
// distance to it. `aside`: metres from the VPL, in its plane. `ahead`: distance towards a straight edge over the
// distance to it. See README.md, "Edges of a VPL's surface".
float share_on_surface(TracedVpl vpl, vec3 aside) {
    float ahead = dot(max(aside * vpl.edges_up, -aside * vpl.edges_down), vec3(1.0));
    return clamp(5.0 - 4.0 * ahead, 0.0, 1.0);
}

// Geometry term cos θ cos θ' / r² between the surface and a VPL (Keller, "Instant Radiosity", 1997). It is at most 4/3
// of 1/R², as the VPL is treated as a disc of radius R (disc.glsl). Beyond an edge of the VPL's surface there is no
// crease, and the disc does not sink. Irradiance is flux/π times the term. See README.md, "Bound of the geometry term".
float geometry_term(TracedVpl vpl, Surface surface) {
    vec3 to_vpl = vpl.position - surface.position;
    float height = -dot(vpl.normal, to_vpl);
    if (height <= -CREASE_SLACK * vpl_constants.ray_offset) return 0.0;
    height = max(height, 0.0);
    float tilt = tilt_of(vpl.normal, face_normal(surface)) * share_on_surface(vpl, -to_vpl - height * vpl.normal);
    return sinking_disc_term(to_vpl, height, vpl.normal, vpl.radius2, tilt, face_normal(surface));
}

// π times the irradiance from the VPL, whose index is that of its depth map.
vec3 irradiance_from_traced(uint index, TracedVpl vpl, VplPose pose, Surface surface) {
    if (vpl.state == VPL_ESCAPED) return vec3(0.0);
    float geometry = geometry_term(vpl, surface);
    if (geometry > 0.0) geometry *= visibility_of_vpl(index, pose, surface);
    return vpl.flux * geometry;
}

// Adds π times the irradiance from the VPL of that index. Loops over the surfaces inside, so that it is fetched, and the
// frame of its map made, once.
void add_traced(uint index, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {
    TracedVpl vpl = traced_vpl_at(index);
    VplPose pose = vpl_pose(vpl.position, vpl.normal, index);
    for (int s = 0; s < SURFACES; ++s) {
        vec3 irradiance = irradiance_from_traced(index, vpl, pose, surfaces[s]);
        add_gathered(gathered[s], irradiance, vpl.position - surfaces[s].position, surfaces[s]);
    }
}

// Adds π times the irradiance from the VPLs in the list.
void add_vpls(VplList list, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {
    for (; list.vpl != NO_VPL; advance(list)) add_traced(list.vpl, surfaces, gathered);
}

#else

layout(binding = UNIT_LIT_SURFELS) uniform usamplerBuffer lit_surfel_texels;
layout(binding = UNIT_LIT_POINTS) uniform usamplerBuffer lit_point_texels;

LitSurfel lit_surfel_at(uint index) {
    uvec4 words[5];
    for (int i = 0; i < 5; ++i) {
        words[i] = texelFetch(lit_surfel_texels, 5 * int(index) + i);
    }
    return LitSurfel(uintBitsToFloat(words[0].xyz), words[0].w, uintBitsToFloat(words[1].xyz), words[1].w,
                     uintBitsToFloat(words[2].xyz), uintBitsToFloat(words[2].w), uintBitsToFloat(words[3].xyz),
                     uintBitsToFloat(words[3].w), uintBitsToFloat(words[4].x), words[4].y, uintBitsToFloat(words[4].z),
                     uintBitsToFloat(words[4].w));
}

LitPoint lit_point_at(uint index) {
    vec4 words[3];
    for (int i = 0; i < 3; ++i) {
        words[i] = uintBitsToFloat(texelFetch(lit_point_texels, 3 * int(index) + i));
    }
    return LitPoint(words[0].xyz, words[0].w, words[1].xyz, words[1].w, words[2].xyz, words[2].w);
}

// disc_term at a visible surface.
float disc_term_at(Surface surface, vec3 position, vec3 normal, float radius2) {
    return disc_term(position, normal, radius2, surface.position, face_normal(surface));
}

// π times the unoccluded irradiance from the points of a cell.
vec3 unoccluded_from_points(uint first, uint count, Surface surface) {
    vec3 sum = vec3(0.0);
    for (uint i = first; i < first + count; ++i) {
        LitPoint point = lit_point_at(i);
        sum += point.flux * disc_term_at(surface, point.position, point.normal, point.area / PI);
    }
    return sum;
}

// π times the unoccluded irradiance from the cell of a surfel. Near the cell, its points are evaluated one by one.
vec3 unoccluded_from_cell(LitSurfel surfel, Surface surface) {
    if (is_near(surfel.position - surface.position, surfel.width2)) {
        return unoccluded_from_points(surfel.first_point, surfel.point_count, surface);
    }
    return surfel.flux * disc_term_at(surface, surfel.centre, surfel.normal, surfel.radius2);
}

// π times the irradiance from a surfel.
vec3 irradiance_from_surfel(LitSurfel surfel, VplPose pose, Surface surface) {
    if (surfel.flux == vec3(0.0)) return vec3(0.0);
    vec3 unoccluded = unoccluded_from_cell(surfel, surface);
    if (unoccluded == vec3(0.0)) return vec3(0.0);
    return unoccluded * visibility_of_vpl(surfel.map, pose, surface);
}

// Adds that light. Loops over the surfaces inside, so that the surfel is fetched, and the frame of its map made, once.
void add_surfel(uint index, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {
    LitSurfel surfel = lit_surfel_at(index);
    VplPose pose = vpl_pose(surfel.position, surfel.normal, surfel.map);
    for (int s = 0; s < SURFACES; ++s) {
        vec3 irradiance = irradiance_from_surfel(surfel, pose, surfaces[s]);
        add_gathered(gathered[s], irradiance, surfel.centre - surfaces[s].position, surfaces[s]);
    }
}

#ifdef EMITTERS

layout(std430, binding = BINDING_LIT_EMITTERS) readonly restrict buffer LitEmitters { LitEmitter lit_emitters[]; };

// Whether a cell is seen, of whose points `brightest` sends most: by a ray to the surfel; or where that is turned away, as
// the cell is bent, to that point.
float visibility_of_emitter(LitEmitter emitter, LitPoint brightest, Surface surface) {
    bool faces = dot(emitter.normal, surface.position - emitter.position) > 0.0;
    vec3 position = faces ? emitter.position : brightest.position;
    return visibility_by_ray(position, faces ? emitter.normal : brightest.normal, surface);
}

// π times the irradiance from a surfel that emits light. That light is direct: its points are evaluated one by one.
vec3 irradiance_from_emitter(LitEmitter emitter, Surface surface) {
    if (emitter.flux == vec3(0.0)) return vec3(0.0);
    vec3 sum = vec3(0.0);
    float most = 0.0;
    uint brightest = emitter.first_point;
    for (uint i = emitter.first_point; i < emitter.first_point + emitter.point_count; ++i) {
        LitPoint point = lit_point_at(i);
        vec3 light = point.flux * disc_term_at(surface, point.position, point.normal, point.area / PI);
        sum += light;
        if (dot(light, vec3(1.0)) <= most) continue;
        most = dot(light, vec3(1.0));
        brightest = i;
    }
    if (most == 0.0) return vec3(0.0);
    return sum * visibility_of_emitter(emitter, lit_point_at(brightest), surface);
}

void add_emitter(uint index, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {
    LitEmitter emitter = lit_emitters[index];
    for (int s = 0; s < SURFACES; ++s) {
        vec3 irradiance = irradiance_from_emitter(emitter, surfaces[s]);
        add_gathered(gathered[s], irradiance, emitter.position - surfaces[s].position, surfaces[s]);
    }
}

#else

void add_emitter(uint index, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {}

#endif

#ifdef SKY

// π times the irradiance from a patch of the sky.
vec3 irradiance_from_patch(vec3 radiance, PatchLight light, Surface surface) {
    if (light.cosine <= 0.0) return vec3(0.0);
    return radiance * (light.cosine * visibility_of_sky(light.direction, surface));
}

void add_patch(uint index, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {
    SkyPatch sky_patch = sky_patches[index];
    for (int s = 0; s < SURFACES; ++s) {
        PatchLight light = light_of_patch(sky_patch, face_normal(surfaces[s]));
        add_gathered(gathered[s], irradiance_from_patch(sky_patch.light, light, surfaces[s]), light.direction, surfaces[s]);
    }
}

#else

void add_patch(uint index, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {}

#endif

#ifdef BALANCED

#include "sampling.glsl"

// π times the irradiance from a direction, if a surface is there: README.md, "Shared items". The directions are those
// that follow the cosine. In this order the even ones (vpl_fill.comp), and the share of each class of pixels, are spread
// over the hemisphere.
vec3 irradiance_from_direction(vec3 towards, Surface surface) {
    vec3 origin = ray_origin(surface, vpl_constants.ray_offset);
    if (!is_surface(closest_hit(origin, towards, 0.0, INFINITY), towards)) return vec3(0.0);
    return PI / float(COVER_DIRECTIONS) * lit_surfel_at(vpl_constants.mean_record).flux;
}

void add_direction(uint index, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {
    uint place = index / 2u + index % 2u * (COVER_DIRECTIONS / 2u);
    for (int s = 0; s < SURFACES; ++s) {
        vec3 towards = cosine_direction(face_normal(surfaces[s]), sample_2d(place, 0u, 0u));
        add_gathered(gathered[s], irradiance_from_direction(towards, surfaces[s]), towards, surfaces[s]);
    }
}

#else

void add_direction(uint index, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {}

#endif

bool is_between(uint vpl, uint first, uint end) { return vpl >= first && vpl < end; }

// Adds π times the irradiance from the VPLs in the list. In it, kinds follow one another, or do so a few times. Each kind
// has a loop of its own, since software drivers run through branches that they do not take.
void add_vpls(VplList list, Surface surfaces[SURFACES], inout Gathered gathered[SURFACES]) {
    while (list.vpl != NO_VPL) {
        for (; list.vpl < vpl_constants.first_emitter; advance(list)) add_surfel(list.vpl, surfaces, gathered);
        for (; is_between(list.vpl, vpl_constants.first_emitter, vpl_constants.first_sky_patch); advance(list)) {
            add_emitter(list.vpl - vpl_constants.first_emitter, surfaces, gathered);
        }
        for (; is_between(list.vpl, vpl_constants.first_sky_patch, vpl_constants.first_direction); advance(list)) {
            add_patch(list.vpl - vpl_constants.first_sky_patch, surfaces, gathered);
        }
        for (; is_between(list.vpl, vpl_constants.first_direction, NO_VPL); advance(list)) {
            add_direction(list.vpl - vpl_constants.first_direction, surfaces, gathered);
        }
    }
}

#endif
