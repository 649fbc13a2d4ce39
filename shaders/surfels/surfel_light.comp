// Flux of the lights at the points of the surfels' cells, with one shadow ray to each light. One invocation a cell
// point.
#include "bindings.glsl"
#include "scene/bvh.glsl"
#include "lights/lights.glsl"
#include "scene/materials.glsl"
#include "types.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_LIGHTS) readonly restrict buffer Lights { Light lights[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_DIRECT_POINTS) restrict buffer DirectPoints { DirectPoint direct_points[]; };
layout(std430, binding = BINDING_SEEN_POINTS) readonly restrict buffer Seen { uint seen[]; };

uniform uint point_count;
uniform uint light_count;
uniform uint lights_before;  // in the dispatches before this one
uniform uint lights_now;     // at most
uniform float ray_offset;    // metres; rays start above the surface and end before the light, which may lie on another

bool is_hidden(Light light, vec3 origin, vec3 direction) {
    return any_hit(origin, direction, 0.0, distance_to(light, origin) - ray_offset);
}

vec3 irradiance_from(Light light, CellPoint point) {
    Incident incident = incident_light(light, point.position);
    float cos_surface = dot(point.normal, incident.direction);
    if (cos_surface <= 0.0 || incident.irradiance == vec3(0.0)) return vec3(0.0);
    if (is_hidden(light, point.position + ray_offset * point.normal, incident.direction)) return vec3(0.0);
    return cos_surface * incident.irradiance;
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= point_count) return;
    CellPoint point = cell_points[id];
    Material material = materials[point.material];
    vec4 colour = colour_at(material, point.uv);
    float area = seen[id] == 0u || colour.a < material.alpha_cutoff ? 0.0 : point.area;
    vec3 irradiance = vec3(0.0);
    uint end = min(light_count, lights_before + lights_now);
    for (uint i = lights_before; i < end && area > 0.0; ++i) irradiance += irradiance_from(lights[i], point);
    vec3 arriving = area * irradiance;
    if (lights_before > 0u) arriving += direct_points[id].arriving;
    direct_points[id] = DirectPoint(arriving, area, colour.rgb, 0.0);
}
