#include "bindings.glsl"
#include "maths.glsl"

layout(binding = UNIT_RADIANCE) uniform sampler2D radiance;

uniform float exposure;   // multiplies radiance
uniform bool curve;       // off: radiance goes out as it is, linear, alpha telling where there is a surface

layout(location = 0) out vec4 colour;

// Narkowicz, "ACES Filmic Tone Mapping Curve" (2015). White long before the bound, which keeps the squares finite.
vec3 filmic(vec3 light) {
    vec3 x = min(light, 1e4);
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

void main() {
    vec4 linear = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0);
    colour = curve ? vec4(srgb_encode(filmic(linear.rgb * exposure)), 1.0) : linear;
}
