// Maps radiance to display colours, or copies it; see Display in tone_map.hpp. One fragment per pixel of the target.
// AUTOMATIC: times the exposure that exposure.comp has found for the picture.
// GUIDED: see enlarge.glsl.
#include "bindings.glsl"
#include "maths.glsl"
#include "output/enlarge.glsl"
#include "output/tone_curves.glsl"

#ifdef AUTOMATIC
layout(std430, binding = BINDING_EXPOSURE) readonly restrict buffer Exposure { vec2 exposures[]; };
#endif

uniform float exposure;
uniform uint curve;          // TONE_CURVE_*
uniform bool encoded;
uniform bool opaque;
uniform vec2 target_origin;  // in the framebuffer, pixels

layout(location = 0) out vec4 colour;

void main() {
    vec2 size = vec2(textureSize(radiance, 0));
    vec2 pixel = gl_FragCoord.xy - target_origin;
    vec4 linear = size == target_size ? texelFetch(radiance, ivec2(pixel), 0) : enlarged_radiance(pixel, size);
    vec3 shown = linear.rgb * exposure;
#ifdef AUTOMATIC
    shown *= exposures[0].x;
#endif
    shown = tone_curve(curve, shown);
    if (encoded) shown = srgb_encode(shown);
    colour = vec4(shown, opaque ? 1.0 : linear.a);
}
