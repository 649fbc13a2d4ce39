// Between bounces that are gathered in dispatches of their own: see surfel_account.glsl. One work group in all.
#include "surfels/surfel_account.glsl"

layout(local_size_x = SURFEL_GROUP) in;

uniform uint bounce;  // number of the last one that was gathered; 1: none yet

void main() {
    if (bounce > 2u) take_step();
    account_for(bounce);
}
