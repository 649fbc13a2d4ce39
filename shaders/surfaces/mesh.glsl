// Vertex inputs and transforms, for all vertex shaders that rasterise the scene's meshes.
#include "bindings.glsl"
#include "types.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 vertex_position;
layout(location = ATTRIBUTE_NORMAL) in vec3 vertex_normal;
layout(location = ATTRIBUTE_UV) in vec2 vertex_uv;
layout(location = ATTRIBUTE_COLOUR) in vec4 vertex_colour;
#ifdef BUMPY
layout(location = ATTRIBUTE_TANGENT) in vec4 vertex_tangent;
#endif
#ifdef SECOND_UV
layout(location = ATTRIBUTE_SECOND_UV) in vec2 vertex_second_uv;
#endif
layout(location = ATTRIBUTE_INSTANCE) in uint vertex_instance;

layout(std430, binding = BINDING_INSTANCES) readonly restrict buffer Instances { Instance instances[]; };

vec3 world_position(Instance instance) {
    vec4 local = vec4(vertex_position, 1.0);
    return vec3(dot(instance.world[0], local), dot(instance.world[1], local), dot(instance.world[2], local));
}

// Not normalised. Normals transform by the cofactor matrix, which also exists for singular matrices; its sign is
// flipped for mirrored instances.
vec3 world_normal(Instance instance) {
    vec3 x = instance.world[0].xyz;
    vec3 y = instance.world[1].xyz;
    vec3 z = instance.world[2].xyz;
    vec3 cofactors = vec3(dot(cross(y, z), vertex_normal), dot(cross(z, x), vertex_normal), dot(cross(x, y), vertex_normal));
    return cofactors * sign(dot(x, cross(y, z)));
}

#ifdef BUMPY

// Not normalised; w as in Vertex::tangent. In a mirrored instance, the normal and the tangent have the other bitangent.
vec4 world_tangent(Instance instance) {
    vec3 x = instance.world[0].xyz;
    vec3 y = instance.world[1].xyz;
    vec3 z = instance.world[2].xyz;
    vec3 local = vertex_tangent.xyz;
    return vec4(dot(x, local), dot(y, local), dot(z, local), vertex_tangent.w * sign(dot(x, cross(y, z))));
}

#endif
