#include "bindings.glsl"
#include "types.glsl"

layout(std140, binding = UNIFORMS_LIGHTS) uniform LightsInCommon { LightConstants light_constants; };
