#include "bindings.glsl"
#include "types.glsl"

layout(std140, binding = UNIFORMS_VIEW) uniform View { ViewConstants view; };
