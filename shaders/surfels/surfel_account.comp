// Sums up over all cells where the flux of the lights went: absorbed, escaped, or left after the last bounce; and
// decides whether another bounce is worth gathering: the sizes of the dispatches for it are in the account. See
// theory.md, "Flux account of surfels". One work group in all; an invocation adds up every SURFEL_GROUP-th cell.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

// Scale, and 1 - covered share.
layout(std430, binding = BINDING_SURFEL_ROWS) readonly restrict buffer Rows { vec2 rows[]; };
layout(std430, binding = BINDING_CELL_LIGHT) readonly restrict buffer Cells { CellLight cells[]; };
layout(std430, binding = BINDING_BOUNCE) readonly restrict buffer Bounce { vec4 bounced[]; };  // see surfel_bounce.comp
layout(std430, binding = BINDING_FLUX_ACCOUNT) restrict buffer Flux { FluxAccount flux[]; };

uniform uint bounce;  // number of the last bounce that was gathered; 1: none yet

// Gathering stops when the last bounce adds no more than this share to the light of any cell. A share of all light would
// not do: that in a house is little beside that on the ground around it.
const float LITTLE = 2e-4;

shared vec3 emitted[SURFEL_GROUP];
shared vec3 absorbed[SURFEL_GROUP];
shared vec3 escaped[SURFEL_GROUP];
shared vec3 truncated[SURFEL_GROUP];
shared bool is_spent[SURFEL_GROUP];

// Flux that a cell reflects after the last bounce, which no surfel gathers any more. Less than 0 if too much of it was
// foreseen.
vec3 left_over(uint id, CellLight cell) {
    if (bounce < 2u) return cell.direct - cell.emitted;
    return cell.area * bounced[((bounce + 1u) % 2u) * surfel_count + id].rgb;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    emitted[lane] = absorbed[lane] = escaped[lane] = truncated[lane] = vec3(0.0);
    is_spent[lane] = true;
    for (uint id = lane; id < surfel_count; id += SURFEL_GROUP) {
        CellLight cell = cells[id];
        vec3 left = left_over(id, cell);
        vec3 indirect = cell.area * cell.indirect;
        emitted[lane] += cell.arriving - cell.from_emitters + cell.emitted;
        absorbed[lane] += cell.arriving + cell.emitted - cell.direct + (1.0 - cell.albedo) * indirect;
        escaped[lane] += rows[id].y * (cell.direct + cell.albedo * indirect - left);
        truncated[lane] += left;
        if (any(greaterThan(abs(left), LITTLE * (cell.direct + cell.albedo * indirect)))) is_spent[lane] = false;
    }
    memoryBarrierShared();
    barrier();
    if (lane > 0u) return;
    FluxAccount account = FluxAccount(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0,
                                      uvec3(0u, 1u, 1u), 0u, uvec3(0u, 1u, 1u), 0u);
    for (uint i = 0u; i < SURFEL_GROUP; ++i) {
        account.emitted += emitted[i];
        account.absorbed += absorbed[i];
        account.escaped += escaped[i];
        account.truncated += truncated[i];
        if (!is_spent[i]) account.account_groups.x = 1u;
    }
    uint all_groups = (bounce_rows_apart() + uint(BOUNCE_GROUP) - 1u) / uint(BOUNCE_GROUP);
    account.bounce_groups.x = account.account_groups.x * all_groups;
    flux[0] = account;
}
