// Adds the light of the bounces to come, as far as it can be foreseen: once the light of each bounce is that of the one
// before times a factor, all further bounces together are a multiple of the last one. What is left afterwards is the
// error, which further bounces gather. See theory.md, "Bounces to come". One work group in all; an invocation adds up
// every SURFEL_GROUP-th cell.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_CELL_LIGHT) restrict buffer Cells { CellLight cells[]; };
layout(std430, binding = BINDING_BOUNCE) restrict buffer Bounce { vec4 bounced[]; };  // see surfel_bounce.comp

uniform uint bounce;  // number of the last bounce that was gathered, at least 3

// Most bounces like the last one that are added. Without a limit, rounding would decide where a closed room absorbs
// nothing.
const float MOST_BOUNCES = 1000.0;

shared vec3 products[SURFEL_GROUP];
shared vec3 squares[SURFEL_GROUP];
shared vec3 further;

uint at_last(uint id) { return (bounce + 1u) % 2u * surfel_count + id; }
uint at_previous(uint id) { return bounce % 2u * surfel_count + id; }

// Sums for the fewest left-over flux, relative to the light of each cell.
void add_up(uint lane) {
    vec3 product = vec3(0.0);
    vec3 square = vec3(0.0);
    for (uint id = lane; id < surfel_count; id += SURFEL_GROUP) {
        CellLight cell = cells[id];
        vec3 all = cell.direct + cell.area * cell.albedo * cell.indirect;
        vec3 last = bounced[at_last(id)].rgb;
        vec3 less = bounced[at_previous(id)].rgb - last;
        vec3 weight = mix(vec3(0.0), cell.area * cell.area / all, greaterThan(all, vec3(0.0)));
        product += weight * last * less;
        square += weight * less * less;
    }
    products[lane] = product;
    squares[lane] = square;
}

vec3 bounces_to_add() {
    vec3 product = vec3(0.0);
    vec3 square = vec3(0.0);
    for (uint i = 0u; i < SURFEL_GROUP; ++i) {
        product += products[i];
        square += squares[i];
    }
    return mix(vec3(0.0), clamp(product / square, 0.0, MOST_BOUNCES), greaterThan(square, vec3(0.0)));
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    add_up(lane);
    memoryBarrierShared();
    barrier();
    if (lane == 0u) further = bounces_to_add();
    memoryBarrierShared();
    barrier();
    for (uint id = lane; id < surfel_count; id += SURFEL_GROUP) {
        vec3 last = bounced[at_last(id)].rgb;
        vec3 previous = bounced[at_previous(id)].rgb;
        cells[id].indirect += further * bounced[2u * surfel_count + id].rgb;
        bounced[at_last(id)].rgb = last + further * (last - previous);
    }
}
