// All bounces after the first one, in one dispatch, for devices on which a chain of small dispatches takes long. One work
// group for each of column_stride classes of surfels: those whose indices are the same modulo column_stride gather from
// each other only. An invocation gathers for every BOUNCES_GROUP-th surfel of the class.
#define OF_THE_GROUP coherent
#include "surfels/surfel_account.glsl"

layout(local_size_x = BOUNCES_GROUP) in;

layout(std430, binding = BINDING_FORM_FACTORS) readonly restrict buffer FormFactors { uint form_factors[]; };

uniform uint bounces_before;  // number of the last one that was gathered before: 1, none, or 2
uniform uint last_bounce;

const uint ROWS = MOST_COLUMNS / BOUNCES_GROUP;  // of an invocation

shared vec3 sent[BOUNCES_GROUP];  // radiosities of some columns, times the surfels' scales

// `first`: the first of those columns.
void share_sent(uint first) {
    uint other = surfel_of(gl_WorkGroupID.x, first + gl_LocalInvocationIndex);
    vec4 left = other < surfel_count ? bounced[at_left(other)] : vec4(0.0);
    memoryBarrierShared();
    barrier();  // until the columns before have been read
    sent[gl_LocalInvocationIndex] = left.a * left.rgb;
    memoryBarrierShared();
    barrier();
}

uint row_of(uint k) { return cell_of(gl_LocalInvocationIndex + k * BOUNCES_GROUP); }

void gather() {
    vec3 sums[ROWS];
    for (uint k = 0u; k < ROWS; ++k) sums[k] = vec3(0.0);
    for (uint first = 0u; first < columns; first += BOUNCES_GROUP) {
        share_sent(first);
        uint pairs = min(columns - first, BOUNCES_GROUP) / 2u;
        for (uint i = 0u; i < pairs; ++i) {
            for (uint k = 0u; k < ROWS; ++k) {
                if (row_of(k) >= surfel_count) break;
                vec2 factors = unpackHalf2x16(form_factors[form_factors_at(row_of(k), first / 2u + i)]);
                sums[k] += factors.x * sent[2u * i] + factors.y * sent[2u * i + 1u];
            }
        }
    }
    for (uint k = 0u; k < ROWS && row_of(k) < surfel_count; ++k) {
        bounced[at_gathered(row_of(k))] = vec4(rows[row_of(k)].x * sums[k], 0.0);
    }
}

// What invocations have written to buffers is there for all others of the group.
void share_buffers() {
    memoryBarrierBuffer();
    memoryBarrierShared();
    barrier();
}

void main() {
    account_for(bounces_before);
    for (uint bounce = bounces_before + 1u; goes_on && bounce <= last_bounce; ++bounce) {
        gather();
        share_buffers();
        take_step();
        share_buffers();
        account_for(bounce);
    }
}
