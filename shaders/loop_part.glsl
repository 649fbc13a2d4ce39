// The part of a long loop that a dispatch or draw runs through; see renderer/gpu/loop_parts.hpp.
uniform uint part_first;  // iterations in the dispatches or draws before this one
uniform uint part_size;   // at most as many in this one
