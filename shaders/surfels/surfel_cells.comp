// Sums up the points of a cell: its flux, mean albedo, and the disc that its emitted and directly
// reflected flux comes from.
// One invocation per surfel.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_DIRECT_POINTS) readonly restrict buffer DirectPoints { DirectPoint direct_points[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_CELL_LIGHT) writeonly restrict buffer Cells { CellLight cells[]; };

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= surfel_count) return;
    Surfel surfel = surfels[id];
    vec3 arriving = vec3(0.0);
    vec3 direct = vec3(0.0);
    vec3 emitted = vec3(0.0);
    vec3 from_emitters = vec3(0.0);
    vec3 albedo = vec3(0.0);
    float weight = 0.0;
    vec3 first = vec3(0.0);   // first and second moments of the flux's position relative to the surfel
    float second = 0.0;
    for (uint i = 0u; i < surfel.point_count; ++i) {
        DirectPoint point = direct_points[surfel.first_point + i];
        CellPoint place = cell_points[surfel.first_point + i];
        vec3 flux = point.albedo * point.arriving + point.emitted;
        emitted += point.emitted;
        from_emitters += point.from_emitters;
        arriving += point.arriving;
        direct += flux;
        albedo += place.area * point.albedo;
        float w = dot(flux, vec3(1.0));
        vec3 off = place.position - surfel.position;
        weight += w;
        first += w * off;
        second += w * dot(off, off);
    }
    CellLight cell = CellLight(surfel.position, surfel.area / PI, arriving, 0.0, direct, 0.0, emitted, 0.0,
                               from_emitters, 0.0, vec3(0.0), surfel.area, vec3(0.0), 0.0);
    if (surfel.area > 0.0) cell.albedo = albedo / surfel.area;
    if (weight > 0.0) {
        vec3 mean = first / weight;
        cell.centre += mean;
        // h² = 6 · variance + area / points: a square of side h has variance h² / 6, and each point represents an equal
        // share of the cell. The disc has the square's area. See README.md, "Width of a lit cell".
        float side2 = 6.0 * max(second / weight - dot(mean, mean), 0.0) + surfel.area / float(surfel.point_count);
        cell.radius2 = min(side2, surfel.area) / PI;
    }
    cells[id] = cell;
}
