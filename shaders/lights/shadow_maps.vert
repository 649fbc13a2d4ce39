// Vertex stage of the shadow maps.
#include "surfaces/mesh.glsl"

layout(std430, binding = BINDING_MATERIALS) readonly restrict buffer Materials { Material materials[]; };

out vec3 vertex_in_world;
flat out uint vertex_has_holes;

void main() {
    Instance instance = instances[vertex_instance];
    vertex_in_world = world_position(instance);
    vertex_has_holes = materials[instance.material].alpha_cutoff > 0.0 ? 1u : 0u;
}
