// What follows some bounces: the light of those to come, as far as it can be foreseen, and an account of where the flux of
// the lights went, which tells whether another bounce is worth gathering. Each work group does so for every
// gl_NumWorkGroups.x-th cell; its first SURFEL_GROUP invocations add up, and all of them call each function.
#include "surfels/surfel_bounced.glsl"

layout(std430, binding = BINDING_FLUX_ACCOUNT) restrict buffer Flux { FluxAccount flux[]; };

// Most bounces like the last one that are added. Without a limit, rounding would decide where a closed room absorbs
// nothing.
const float MOST_BOUNCES = 1000.0;

// Gathering stops when the last bounce adds no more than this share to the light of any cell. A share of all light would
// not do: that in a house is little beside that on the ground around it.
const float LITTLE = 2e-4;

uint cell_of(uint i) { return gl_WorkGroupID.x + i * gl_NumWorkGroups.x; }

shared vec3 products[SURFEL_GROUP];
shared vec3 squares[SURFEL_GROUP];
shared vec3 further;

// Sums for the fewest left-over flux, relative to the light of each cell.
void add_up_products(uint lane, uint bounce) {
    vec3 product = vec3(0.0);
    vec3 square = vec3(0.0);
    for (uint i = lane; cell_of(i) < surfel_count; i += SURFEL_GROUP) {
        uint id = cell_of(i);
        CellLight cell = cells[id];
        vec3 all = cell.direct + cell.area * cell.albedo * cell.indirect;
        vec3 last = bounced[at_last(bounce, id)].rgb;
        vec3 less = bounced[at_previous(bounce, id)].rgb - last;
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

// Once the light of each bounce is that of the one before times a factor, all further bounces together are a multiple of
// the last one. What is left afterwards is the error, which further bounces gather. See README.md, "Bounces to come".
// `bounce`: number of the last one that was gathered, at least 3.
void add_bounces_to_come(uint bounce) {
    uint lane = gl_LocalInvocationIndex;
    if (lane < SURFEL_GROUP) add_up_products(lane, bounce);
    memoryBarrierShared();
    barrier();
    if (lane == 0u) further = bounces_to_add();
    memoryBarrierShared();
    barrier();
    if (lane >= SURFEL_GROUP) return;
    for (uint i = lane; cell_of(i) < surfel_count; i += SURFEL_GROUP) {
        uint id = cell_of(i);
        vec3 last = bounced[at_last(bounce, id)].rgb;
        vec3 previous = bounced[at_previous(bounce, id)].rgb;
        cells[id].indirect += further * bounced[2u * surfel_count + id].rgb;
        bounced[at_last(bounce, id)].rgb = last + further * (last - previous);
    }
}

shared vec3 emitted[SURFEL_GROUP];
shared vec3 absorbed[SURFEL_GROUP];
shared vec3 escaped[SURFEL_GROUP];
shared vec3 truncated[SURFEL_GROUP];
shared bool is_spent[SURFEL_GROUP];
shared bool goes_on;  // another bounce is worth gathering

// Flux that a cell reflects after the last bounce, which no surfel gathers any more. Less than 0 if too much of it was
// foreseen.
vec3 left_over(uint id, CellLight cell, uint bounce) {
    if (bounce < 2u) return cell.direct - cell.emitted;
    return cell.area * bounced[at_last(bounce, id)].rgb;
}

void add_up_flux(uint lane, uint bounce) {
    emitted[lane] = vec3(0.0);
    absorbed[lane] = vec3(0.0);
    escaped[lane] = vec3(0.0);
    truncated[lane] = vec3(0.0);
    is_spent[lane] = true;
    for (uint i = lane; cell_of(i) < surfel_count; i += SURFEL_GROUP) {
        uint id = cell_of(i);
        CellLight cell = cells[id];
        vec3 left = left_over(id, cell, bounce);
        vec3 indirect = cell.area * cell.indirect;
        emitted[lane] += cell.arriving - cell.from_emitters + cell.emitted;
        absorbed[lane] += cell.arriving + cell.emitted - cell.direct + (1.0 - cell.albedo) * indirect;
        escaped[lane] += rows[id].y * (cell.direct + cell.albedo * indirect - left);
        truncated[lane] += left;
        if (any(greaterThan(abs(left), LITTLE * (cell.direct + cell.albedo * indirect)))) is_spent[lane] = false;
    }
}

void write_account() {
    FluxAccount account = FluxAccount(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0,
                                      uvec3(0u, 1u, 1u), 0u, uvec3(0u, 1u, 1u), 0u);
    goes_on = false;
    for (uint i = 0u; i < SURFEL_GROUP; ++i) {
        account.emitted += emitted[i];
        account.absorbed += absorbed[i];
        account.escaped += escaped[i];
        account.truncated += truncated[i];
        if (!is_spent[i]) goes_on = true;
    }
    if (goes_on) {
        account.account_groups.x = 1u;
        account.bounce_groups.x = (bounce_rows_apart() + uint(BOUNCE_GROUP) - 1u) / uint(BOUNCE_GROUP);
    }
    flux[gl_WorkGroupID.x] = account;
}

// Sums up where the flux of the lights went: absorbed, escaped, or left after the last bounce; and decides whether to go on.
// The sizes of the dispatches for another bounce are in the account. See README.md, "Flux account of surfels". `bounce`:
// number of the last one that was gathered; 1: none yet.
void account_for(uint bounce) {
    uint lane = gl_LocalInvocationIndex;
    if (lane < SURFEL_GROUP) add_up_flux(lane, bounce);
    memoryBarrierShared();
    barrier();
    if (lane == 0u) write_account();
    memoryBarrierShared();
    barrier();
}
