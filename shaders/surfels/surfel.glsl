// Surfels: points on the surfaces, which gather light and reflect it. Each surfel represents a cell,
// the part of the surface around it. A cell is sampled by its cell points (types.glsl, CellPoint).
#include "bindings.glsl"
#include "vpls/disc.glsl"
#include "maths.glsl"
#include "types.glsl"

uniform uint surfel_count;
uniform uint columns;  // even; surfels that each one gathers from, every column_stride-th of them
uniform uint column_stride;

// The surfel in a column of the form-factor matrix, for the row of surfel `row`. May be surfel_count or more: no
// surfel.
uint surfel_of(uint row, uint column) { return column * column_stride + row % column_stride; }

// Each invocation of surfel_bounce.comp gathers for so many surfels, which have the same columns, or if SLICED for a part
// of the columns of one. Neighbouring invocations have neighbouring surfels, and each has its next one so many surfels on.
#ifdef SLICED
#define ROWS_A_BOUNCE 1u
#else
#define ROWS_A_BOUNCE 4u
#endif
uint bounce_rows_apart() {
    uint all = ROWS_A_BOUNCE * column_stride;
    return (surfel_count + all - 1u) / all * column_stride;
}

// Index of the word that holds the form factors of columns 2 * pair and 2 * pair + 1 of a row, as two half floats. The
// words of neighbouring rows are adjacent, since neighbouring invocations read them together.
uint form_factors_at(uint row, uint pair) { return pair * surfel_count + row; }
