// Vertex stage of the shadow maps of opaque surfaces.
#include "surfaces/mesh.glsl"

uniform mat4 clip_from_world;

void main() { gl_Position = clip_from_world * vec4(world_position(instances[vertex_instance]), 1.0); }
