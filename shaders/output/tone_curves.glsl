// Curves from exposed linear light to linear colours from 0 to 1: see ToneCurve in configuration.hpp.

// Narkowicz, "ACES Filmic Tone Mapping Curve" (2015). The bound of 1e4 keeps the squares finite; the curve is white
// long before it.
vec3 filmic(vec3 light) {
    vec3 x = min(light, 1e4);
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

// "Khronos PBR Neutral Tone Mapper", specification (2024); the names are those of its symbols. For light that is not
// negative. The bound of 1e30 keeps the sums finite.
vec3 neutral(vec3 light) {
    const float F90 = 0.04;
    const float KS = 0.8 - F90;
    const float KD = 0.15;
    vec3 c = clamp(light, 0.0, 1e30);
    float x = min(c.r, min(c.g, c.b));
    float f = x <= 2.0 * F90 ? x - x * x / (4.0 * F90) : F90;
    c -= f;
    float p = max(c.r, max(c.g, c.b));
    if (p <= KS) return c;
    float pn = 1.0 - (1.0 - KS) * (1.0 - KS) / (p + 1.0 - 2.0 * KS);
    float g = 1.0 / (KD * (p - pn) + 1.0);
    return mix(vec3(pn), c * (pn / p), g);
}

// Hill, "ACES.hlsl" (2016), in MJP's BakingLab: sRGB to AP1 with the saturation of the reference rendering transform, a
// fit to that and the output transform, and back to sRGB. Light is divided by 0.6 before, as in three.js and in "ACES
// Filmic (Hill Exposure Boost)" of Khronos' sample viewer: mid-grey then stays about as bright. Bound as in `filmic`.
vec3 aces(vec3 light) {
    const mat3 to_aces = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 from_aces =
        mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = to_aces * (min(light, 1e4) / 0.6);
    vec3 a = v * (v + 0.0245786) - 0.000090537;
    vec3 b = v * (0.983729 * v + 0.4329510) + 0.238081;
    return clamp(from_aces * (a / b), 0.0, 1.0);
}

// `curve`: TONE_CURVE_*
vec3 tone_curve(uint curve, vec3 light) {
    switch (curve) {
        case TONE_CURVE_FILMIC: return filmic(light);
        case TONE_CURVE_NEUTRAL: return neutral(light);
        case TONE_CURVE_ACES: return aces(light);
        default: return light;
    }
}
