// Interleaved gathering (Wald et al., "Interactive Global Illumination using Fast Ray Tracing", 2002; Segovia et al.,
// "Non-interleaved Deferred Shading of Interleaved Sample Patterns", 2006): pixels form interleave² classes by their
// coordinates modulo `interleave`, and all pixels of a class use the same share of the VPLs.
uniform uint interleave;  // 1, 2, 4 or 8

// Index of the share of the class at `offset`, in the order of Bayer's dither matrix, so that a few neighbouring pixels
// have shares from all over the list of VPLs (Bayer, "An optimum method for two-level rendition of continuous-tone
// pictures", 1973).
uint share_of_class(uvec2 offset) {
    uint share = 0u;
    for (uint bit = 1u; bit < interleave; bit *= 2u) {
        uint x = (offset.x & bit) != 0u ? 1u : 0u;
        uint y = (offset.y & bit) != 0u ? 1u : 0u;
        share = 4u * share + 2u * (x ^ y) + y;
    }
    return share;
}
