#include "bindings.glsl"
#include "types.glsl"

layout(std140, binding = UNIFORMS_VPLS) uniform VplsInCommon { VplConstants vpl_constants; };
