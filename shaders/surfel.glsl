// Surfels: points on the surfaces, even in area, that gather light and send it on. Each has a cell of the surface around
// it, which is known by its points.
#include "bindings.glsl"
#include "disc.glsl"
#include "maths.glsl"
#include "types.glsl"

uniform uint surfel_count;
uniform uint columns;  // surfels that each one gathers from: all, or where they are many every column_stride-th
uniform uint column_stride;

// The surfel that a row has in a column.
uint surfel_of(uint row, uint column) { return column * column_stride + row % column_stride; }

// Where the form factors of a row's columns 2 * pair and 2 * pair + 1 are, two half floats: those of neighbouring rows side
// by side, as neighbouring invocations read them.
uint form_factors_at(uint row, uint pair) { return pair * surfel_count + row; }
