// The light of the real lights at each point of the surfels' cells. One invocation a point.
#include "bindings.glsl"
#include "materials.glsl"
#include "types.glsl"
#include "lighting.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_DIRECT_POINTS) restrict buffer DirectPoints { DirectPoint direct_points[]; };

uniform uint point_count;

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= point_count) return;
    CellPoint point = cell_points[id];
    Material material = materials[point.material];
    vec4 colour = colour_at(material, point.uv);
    Surface surfaces[SURFACES];
    uvec2 pixels[SURFACES];
    vec3 irradiance[SURFACES];
    surfaces[0] = Surface(point.position, point.normal, colour.rgb);
    pixels[0] = uvec2(0u);
    irradiance[0] = vec3(0.0);
    gather_lights(surfaces, pixels, irradiance);
    float area = colour.a < material.alpha_cutoff ? 0.0 : point.area;
    vec3 arriving = irradiance[0] * area;
    if (lights_before > 0u) arriving += direct_points[id].arriving;
    direct_points[id] = DirectPoint(arriving, area, colour.rgb, 0.0);
}
