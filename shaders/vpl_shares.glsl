// Interleaved gathering (Wald et al., "Interactive Global Illumination using Fast Ray Tracing", 2002; Segovia et al.,
// "Non-interleaved Deferred Shading of Interleaved Sample Patterns", 2006): the pixels fall into interleave² classes by
// their place modulo `interleave`, and those of a class ask the same share of the VPLs.
uniform uint interleave;  // 1, 2, 4 or 8

// The order in which the classes have their shares: any few neighbours have shares from all over the VPLs (Bayer, "An
// optimum method for two-level rendition of continuous-tone pictures", 1973).
uint share_of_class(uvec2 offset) {
    uint share = 0u;
    for (uint bit = 1u; bit < interleave; bit *= 2u) {
        uint x = (offset.x & bit) != 0u ? 1u : 0u;
        uint y = (offset.y & bit) != 0u ? 1u : 0u;
        share = 4u * share + 2u * (x ^ y) + y;
    }
    return share;
}
