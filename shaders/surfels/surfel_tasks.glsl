// What is to be traced in this frame.
#include "bindings.glsl"
#include "types.glsl"

// By surfel: SURFEL_CHANGED and the like. If everything may have changed, all is traced but where nothing is to be.
layout(std430, binding = BINDING_SURFEL_TASKS) readonly restrict buffer Tasks { uint tasks[]; };

uniform bool has_tasks;  // else all is traced

bool has_task(uint surfel, uint task) { return ((has_tasks ? tasks[surfel] : SURFEL_WHOLE) & task) != 0u; }
