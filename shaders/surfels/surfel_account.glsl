// What follows a bounce: how much of the light that is left the bounce takes, and an account of where the flux of the lights
// went, which tells whether another bounce is worth gathering. Each work group does so for every gl_NumWorkGroups.x-th
// cell; its first SURFEL_GROUP invocations add up, and all of them call each function.
#include "surfels/surfel_bounced.glsl"

layout(std430, binding = BINDING_FLUX_ACCOUNT) OF_THE_GROUP restrict buffer Flux { FluxAccount flux[]; };

uniform bool solves;  // all bounces are wanted, in the fewest steps; otherwise each step is a bounce

// Gathering stops when what is left is at most this share of the light of each cell, since that in a house is little beside
// that on the ground around it,
const float LITTLE = 2e-4;
// and all of it this share of the emitted flux, since white rooms reflect what is left a thousand times.
const float LITTLE_OF_ALL = 2e-3;

uint cell_of(uint i) { return gl_WorkGroupID.x + i * gl_NumWorkGroups.x; }

// A step sends x times the radiosity that is left, and y times that of the last step again.
struct Step {
    vec3 x;
    vec3 y;
};

// Sums over cells, of products of the radiosity r that is left and of what r and the last step, s, would take of it: r - Mr
// and s - Ms, with M for a bounce.
struct Products {
    vec3 rr;  // (r - Mr)²
    vec3 rs;  // (r - Mr) (s - Ms)
    vec3 ss;  // (s - Ms)²
    vec3 r;   // r (r - Mr)
    vec3 s;   // r (s - Ms)
};

shared Products products[SURFEL_GROUP];
shared Step step_of_all;

vec3 quotient(vec3 a, vec3 b) { return mix(vec3(0.0), a / b, greaterThan(b, vec3(0.0))); }

Products products_of(uint id) {
    vec3 albedo = cells[id].albedo;
    // Relative to the emitted flux, whose square may be too large for a float.
    vec3 unit = quotient(vec3(1.0), flux[gl_WorkGroupID.x].emitted);
    vec3 left = unit * bounced[at_left(id)].rgb;
    vec3 r = left - unit * albedo * bounced[at_gathered(id)].rgb;
    vec3 s = unit * (bounced[at_step(id)].rgb - albedo * bounced[at_step_gathered(id)].rgb);
    // In this measure a bounce is symmetric, as far as form factors are reciprocal.
    vec3 weight = mix(vec3(0.0), cells[id].area / albedo, greaterThan(albedo, vec3(1e-6)));
    return Products(weight * r * r, weight * r * s, weight * s * s, weight * left * r, weight * left * s);
}

void add(inout Products sum, Products other) {
    sum.rr += other.rr;
    sum.rs += other.rs;
    sum.ss += other.ss;
    sum.r += other.r;
    sum.s += other.s;
}

// The step after which the least is left. See README.md, "Steps of bounces".
Step best_step() {
    Products sum = products[0];
    for (uint i = 1u; i < SURFEL_GROUP; ++i) add(sum, products[i]);
    vec3 again = -quotient(sum.rs, sum.ss);
    vec3 x = quotient(sum.r + again * sum.s, sum.rr + again * sum.rs);
    return Step(x, x * again);
}

// Adds what has been gathered in a bounce after the first one.
void take_step() {
    uint lane = gl_LocalInvocationIndex;
    if (lane < SURFEL_GROUP) {
        products[lane] = Products(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
        for (uint i = lane; cell_of(i) < surfel_count; i += SURFEL_GROUP) add(products[lane], products_of(cell_of(i)));
    }
    memoryBarrierShared();
    barrier();
    if (lane == 0u) step_of_all = solves ? best_step() : Step(vec3(1.0), vec3(0.0));
    memoryBarrierShared();
    barrier();
    if (lane >= SURFEL_GROUP) return;
    for (uint i = lane; cell_of(i) < surfel_count; i += SURFEL_GROUP) {
        uint id = cell_of(i);
        vec3 left = bounced[at_left(id)].rgb;
        vec3 sent = step_of_all.x * left + step_of_all.y * bounced[at_step(id)].rgb;
        vec3 gathered = step_of_all.x * bounced[at_gathered(id)].rgb + step_of_all.y * bounced[at_step_gathered(id)].rgb;
        bounced[at_step(id)].rgb = sent;
        bounced[at_step_gathered(id)].rgb = gathered;
        bounced[at_left(id)].rgb = left - sent + cells[id].albedo * gathered;
        cells[id].indirect += gathered;
    }
}

shared vec3 emitted[SURFEL_GROUP];
shared vec3 absorbed[SURFEL_GROUP];
shared vec3 escaped[SURFEL_GROUP];
shared vec3 truncated[SURFEL_GROUP];
shared vec3 sizes[SURFEL_GROUP];  // of the truncated flux, whose sign varies
shared bool is_spent[SURFEL_GROUP];
shared bool goes_on;  // another bounce is worth gathering

// Flux that a cell reflects after the last bounce, which no surfel gathers any more. Less than 0 if the last step has sent
// too much.
vec3 left_over(uint id, CellLight cell, uint bounce) {
    if (bounce < 2u) return cell.direct - cell.emitted;
    return cell.area * bounced[at_left(id)].rgb;
}

void add_up_flux(uint lane, uint bounce) {
    emitted[lane] = vec3(0.0);
    absorbed[lane] = vec3(0.0);
    escaped[lane] = vec3(0.0);
    truncated[lane] = vec3(0.0);
    sizes[lane] = vec3(0.0);
    is_spent[lane] = true;
    for (uint i = lane; cell_of(i) < surfel_count; i += SURFEL_GROUP) {
        uint id = cell_of(i);
        CellLight cell = cells[id];
        vec3 rest = left_over(id, cell, bounce);
        vec3 indirect = cell.area * cell.indirect;
        emitted[lane] += cell.arriving - cell.from_emitters + cell.emitted;
        absorbed[lane] += cell.arriving + cell.emitted - cell.direct + (1.0 - cell.albedo) * indirect;
        escaped[lane] += rows[id].y * (cell.direct + cell.albedo * indirect - rest);
        truncated[lane] += rest;
        sizes[lane] += abs(rest);
        if (any(greaterThan(abs(rest), LITTLE * (cell.direct + cell.albedo * indirect)))) is_spent[lane] = false;
    }
}

void write_account() {
    FluxAccount account = FluxAccount(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0,
                                      uvec3(0u, 1u, 1u), 0u, uvec3(0u, 1u, 1u), 0u);
    vec3 all_left = vec3(0.0);
    goes_on = false;
    for (uint i = 0u; i < SURFEL_GROUP; ++i) {
        account.emitted += emitted[i];
        account.absorbed += absorbed[i];
        account.escaped += escaped[i];
        account.truncated += truncated[i];
        all_left += sizes[i];
        if (!is_spent[i]) goes_on = true;
    }
    goes_on = goes_on || any(greaterThan(all_left, LITTLE_OF_ALL * account.emitted));
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
