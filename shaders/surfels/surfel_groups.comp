// Adds up the light of the surfels of each group: the VPL that far pixels see in their place. It is written as the record
// of a surfel, behind those of all surfels: its points are the group's surfels, its depth map is that of the surfel in its
// middle, and its flux comes from the disc of the same mean and variance. See README.md, "Groups of surfels". One
// invocation per group.
#include "bindings.glsl"
#include "maths.glsl"
#include "types.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFEL_GROUPS) readonly restrict buffer Groups { SurfelGroup surfel_groups[]; };
layout(std430, binding = BINDING_LIT_SURFELS) restrict buffer LitSurfels { LitSurfel lit_surfels[]; };

uniform uint group_count;
uniform uint first_record;  // index of the first group's record

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= group_count) return;
    SurfelGroup group = surfel_groups[id];
    LitSurfel sum = lit_surfels[group.middle];
    sum.first_point = group.first;
    sum.point_count = group.count;
    sum.width2 = group.width2;
    sum.reach = group.reach;
    sum.thickness = group.thickness;
    sum.flux = vec3(0.0);
    sum.area = 0.0;
    float weight = 0.0;
    vec3 first = vec3(0.0);  // first and second moments of the flux's position relative to the middle surfel
    float second = 0.0;
    for (uint i = group.first; i < group.first + group.count; ++i) {
        LitSurfel surfel = lit_surfels[i];
        float w = dot(abs(surfel.flux), vec3(1.0));  // less than 0: README.md, "Shared items"
        vec3 off = surfel.centre - sum.position;
        sum.flux += surfel.flux;
        sum.area += surfel.area;
        weight += w;
        first += w * off;
        second += w * (dot(off, off) + PI / 6.0 * surfel.radius2);
    }
    sum.centre = sum.position;
    sum.radius2 = sum.area / PI;
    if (weight > 0.0) {
        vec3 mean = first / weight;
        sum.centre += mean;
        sum.radius2 = min(6.0 / PI * max(second / weight - dot(mean, mean), 0.0), sum.radius2);
    }
    lit_surfels[first_record + id] = sum;
}
