#include "surfaces/mesh.glsl"
#include "view/view.glsl"

invariant gl_Position;  // depth pre-pass and later passes must compute identical depths

out vec3 normal;
#ifdef BUMPY
out vec4 tangent;
#endif
out vec2 uv;
#ifdef SECOND_UV
out vec2 second_uv;
#endif
out vec4 colour_off_white;  // so that white is interpolated exactly
flat out uint material_index;

void main() {
    Instance instance = instances[vertex_instance];
    normal = world_normal(instance);
#ifdef BUMPY
    tangent = world_tangent(instance);
#endif
    uv = vertex_uv;
#ifdef SECOND_UV
    second_uv = vertex_second_uv;
#endif
    colour_off_white = vertex_colour - 1.0;
    material_index = instance.material;
    gl_Position = view.clip_from_world * vec4(world_position(instance), 1.0);
}
