// Flux at the points of the surfels' cells: of the lights, with a shadow ray to each, or several; of surfaces that emit
// light (EMITTERS); of the sky (SKY); and the flux that the points emit themselves, π times radiance times area. One
// invocation per cell point.
#include "bindings.glsl"
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "lights/lights.glsl"
#include "loop_part.glsl"
#include "scene/materials.glsl"
#include "sampling.glsl"
#include "sky/sky_patch.glsl"
#include "types.glsl"
#include "vpls/disc.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_DIRECT_POINTS) restrict buffer DirectPoints { DirectPoint direct_points[]; };
layout(std430, binding = BINDING_LAST_POINTS) readonly restrict buffer LastPoints { DirectPoint last_points[]; };
layout(std430, binding = BINDING_KEPT_POINTS) readonly restrict buffer KeptPoints { uint kept_points[]; };  // by surfel
layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };

uniform uint first_row;  // of work groups, in this dispatch: see ComputeSteps::run_rows
uniform uint point_count;
uniform bool keeps;  // light at points whose cells are among kept_points
uniform uint light_count;
uniform float ray_offset;    // metres; rays start above the surface and end before the light, which may lie on another
uniform uint surfel_count;
uniform uint emitting_count;  // surfels that emit light: the last ones
#ifdef SKY
uniform uint sky_patch_count;
#endif

// Most near emitting surfels that each cell point sums. With more, an invocation would have more rays and points in its
// loops than software drivers run through.
const uint MOST_NEAR_EMITTERS = 256u;

// Rays from each cell point to a directional light: what it lights often has edges within a cell. With more than
// FEW_LIGHTS, one ray each, which bounds what an invocation does.
const uint SUN_RAYS = 8u;
const uint FEW_LIGHTS = 16u;

// Where a cell point receives the light of a source `height` above its plane: sunk behind its surface, so that the source
// is at least as high as the point's part of the surface is wide. See README.md, "Lights close to a surface".
vec3 sunk_position(CellPoint point, float height) {
    return point.position - max(sqrt(point.area) - height, 0.0) * point.normal;
}

// A number of a point, consecutive within a cell, which does not depend on what other surfels there are.
uint number_of(Surfel own, uint id) {
    uvec3 bits = floatBitsToUint(own.position);
    return hash_combine(hash_combine(hash(bits.x), bits.y), bits.z) + id - own.first_point;
}

// A place in a point's part of its cell: the point itself, or somewhere on the way to another point of the cell, which is
// in the same plane, so that it is on the surface as well. As far away as in a disc of the part's area.
vec3 place_in_part(CellPoint point, uint id, uint i) {
    Surfel own = surfels[point.surfel];
    CellPoint other = cell_points[own.first_point + (id - own.first_point + i) % own.point_count];
    vec3 apart = other.position - point.position;
    float distance2 = dot(apart, apart);
    bool in_plane = dot(point.normal, other.normal) > 0.999 && abs(dot(point.normal, apart)) < ray_offset;
    if (!in_plane || distance2 == 0.0) return point.position;
    float u = fract((float(i) + float(number_of(own, id) % 64u) / 64.0) * 0.618034);
    return point.position + min(sqrt(u * point.area / (PI * distance2)), 0.5) * apart;
}

// The share of a point's part that a light reaches. `direction`: to the light. One loop for all kinds of lights has the
// code for rays, which takes drivers long to compile, only once.
float lit_share(Light light, CellPoint point, uint id, vec3 direction) {
    bool directional = light.kind == LIGHT_DIRECTIONAL;
    uint rays = directional && light_count <= FEW_LIGHTS ? SUN_RAYS : 1u;
    uint hidden = 0u;
    for (uint i = 0u; i < rays; ++i) {
        vec3 origin = (directional ? place_in_part(point, id, i) : point.position) + ray_offset * point.normal;
        if (any_hit(origin, direction, 0.0, distance_to(light, origin) - ray_offset)) ++hidden;
    }
    return 1.0 - float(hidden) / float(rays);
}

// Of a light at a place or a directional one.
vec3 irradiance_from(Light light, CellPoint point, uint id) {
    bool directional = light.kind == LIGHT_DIRECTIONAL;
    vec3 to_light = light.position - point.position;
    float height = dot(point.normal, to_light);
    // A light on the surface lights it like one just in front of it.
    if (!directional && height < -ray_offset) return vec3(0.0);
    Incident incident = incident_light(light, directional ? point.position : sunk_position(point, max(height, 0.0)));
    float cos_surface = dot(point.normal, incident.direction);
    if (cos_surface <= 0.0 || incident.irradiance == vec3(0.0)) return vec3(0.0);
    vec3 to_place = directional ? incident.direction : normalize(to_light);
    return cos_surface * lit_share(light, point, id, to_place) * incident.irradiance;
}

// The part of many sources that a cell point receives: every `shares`-th, from `first` on, each with a weight. The points
// of a cell together receive all sources.
struct Share {
    uint first;
    uint step;  // `shares`
    float weight;
};

// As many shares as the cell has points, up to MOST_CELL_SHARES, but enough that a point casts MOST_POINT_RAYS at most.
Share share_of(uint id, Surfel own, uint sources) {
    uint least = (sources + MOST_POINT_RAYS - 1u) / MOST_POINT_RAYS;
    uint shares = clamp(own.point_count, least, max(MOST_CELL_SHARES, least));
    bool covers_all = shares <= own.point_count;
    uint first = (covers_all ? id - own.first_point : number_of(own, id)) % shares;
    // How many points of the cell have the same share.
    float same = float((own.point_count - 1u - first) / shares + 1u);
    return Share(first, shares, covers_all ? float(own.point_count) / same : float(shares));
}

#ifdef EMITTERS

// Irradiance from the cell of a surfel that emits light. A ray to the surfel finds whether it is hidden; or where that is
// turned away, as the cell is bent, to the point of the cell that sends most.
vec3 irradiance_from_cell(Surfel emitter, CellPoint point) {
    vec3 sum = vec3(0.0);
    float most = 0.0;
    bool faces = dot(emitter.normal, point.position - emitter.position) > 0.0;
    vec3 target = emitter.position + ray_offset * emitter.normal;
    for (uint i = emitter.first_point; i < emitter.first_point + emitter.point_count; ++i) {
        CellPoint from = cell_points[i];
        float term = disc_term(from.middle, from.normal, from.area / PI, point.position, point.normal);
        if (term <= 0.0) continue;
        vec3 light = from.area * term * emission_at(materials[from.material], from.uv);
        sum += light;
        if (faces || dot(light, vec3(1.0)) <= most) continue;
        most = dot(light, vec3(1.0));
        target = from.position + ray_offset * from.normal;
    }
    if (sum == vec3(0.0)) return sum;
    vec3 origin = point.position + ray_offset * point.normal;
    return any_hit(origin, target - origin, 0.0, 1.0) ? vec3(0.0) : sum;
}

// Irradiance from surfaces that emit light: the point's share of them, and all that are near its cell.
vec3 irradiance_from_emitters(uint id, CellPoint point) {
    Surfel own = surfels[point.surfel];
    Share share = share_of(id, own, emitting_count);
    uint near_ones = 0u;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < emitting_count; ++i) {
        Surfel emitter = surfels[surfel_count - emitting_count + i];
        bool near = near_ones < MOST_NEAR_EMITTERS &&
                    is_near(emitter.position - own.position, own.width2 + emitter.width2);
        if (near) ++near_ones;
        if (near || i % share.step == share.first) sum += (near ? 1.0 : share.weight) * irradiance_from_cell(emitter, point);
    }
    return sum;
}

#else

vec3 irradiance_from_emitters(uint id, CellPoint point) { return vec3(0.0); }

#endif

#ifdef SKY

vec3 irradiance_from_sky(uint id, CellPoint point) {
    Share share = share_of(id, surfels[point.surfel], sky_patch_count);
    vec3 origin = point.position + ray_offset * point.normal;
    vec3 sum = vec3(0.0);
    for (uint i = share.first; i < sky_patch_count; i += share.step) {
        PatchLight light = light_of_patch(sky_patches[i], point.normal);
        if (light.cosine > 0.0 && !any_hit(origin, light.direction, 0.0, INFINITY)) {
            sum += light.cosine / PI * sky_patches[i].light;
        }
    }
    return share.weight * sum;
}

#else

vec3 irradiance_from_sky(uint id, CellPoint point) { return vec3(0.0); }

#endif

void main() {
    uint id = (first_row + gl_WorkGroupID.y) * SURFEL_GROUP + gl_LocalInvocationID.x;
    if (id >= point_count) return;
    CellPoint point = cell_points[id];
    uint kept = keeps ? kept_points[point.surfel] : NO_SURFEL;
    if (kept != NO_SURFEL) {
        if (part_first == 0u) direct_points[id] = last_points[kept + id - surfels[point.surfel].first_point];
        return;
    }
    Material material = materials[point.material];
    bool is_emission_uv = has_second_uv(point.material, MATERIAL_SECOND_UV_EMISSIVE);
    vec4 texture_colour = is_emission_uv ? material.base_colour : colour_at(material, point.uv);
    vec3 colour = texture_colour.rgb * vertex_colour(point.colour).rgb;
    vec3 irradiance = vec3(0.0);
    uint end = min(light_count, part_first + part_size);
    for (uint i = part_first; i < end; ++i) irradiance += irradiance_from(lights[i], point, id);
    if (part_first == 0u) irradiance += irradiance_from_sky(id, point);
    vec3 arriving = point.area * irradiance;
    if (part_first > 0u) {
        direct_points[id].arriving += arriving;
        return;
    }
    vec3 emitted = point.area * PI * emission_at(material, point.uv);
    vec3 from_emitters = emitting_count > 0u ? point.area * irradiance_from_emitters(id, point) : vec3(0.0);
    direct_points[id] = DirectPoint(arriving + from_emitters, 0.0, traced_albedo(material, colour), 0.0, emitted, 0.0,
                                    from_emitters, 0.0);
}
