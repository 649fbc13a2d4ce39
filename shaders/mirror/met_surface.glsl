// The material of a surface that a ray has met, in the form of the G-buffer. Roughness and metalness are the means over their
// texture.
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "scene/materials.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"

// The triangle whose uv is that of this image.
TraceTriangle with_uv_of(uint image, uint index) {
    TraceTriangle triangle = triangle_at(index);
    return has_second_uv(triangle.material, image) ? triangle_at(index + triangle.second) : triangle;
}

#ifdef MIRRORED_BUMPS

mat3 world_from_mesh(Hit hit) {
    vec4 rows[3] = mesh_from_world(node_at(hit.instance));
    return inverse(transpose(mat3(rows[0].xyz, rows[1].xyz, rows[2].xyz)));
}

// The triangle's direction of increasing u, as the tangents of its vertices without their interpolation, and that of
// decreasing v, both beside the normal. Zero without texture coordinates.
void tangents_beside(vec3 across, TraceTriangle triangle, mat3 to_world, out vec3 along, out vec3 aside) {
    vec2 ab = triangle.uv_b - triangle.uv_a;
    vec2 ac = triangle.uv_c - triangle.uv_a;
    float area = ab.x * ac.y - ab.y * ac.x;
    vec3 to_u = to_world * (triangle.edge_ab * ac.y - triangle.edge_ac * ab.y) * sign(area);
    to_u -= dot(to_u, across) * across;
    along = to_u * inversesqrt(max(dot(to_u, to_u), 1e-30));
    aside = cross(across, along) * -sign(area) * sign(determinant(to_world));
}

// Where the normal texture turns the normal to. `spread`: how far normals spread there.
vec3 met_normal(Material material, TraceTriangle triangle, Hit hit, vec3 across, out float spread) {
    spread = 0.0;
    if (material.normal_scale == 0.0) return across;
    vec4 stored = stored_normal_at(material, hit_uv(triangle, hit.barycentric));
    spread = material.normal_scale * stored.a;
    vec3 local = 2.0 * stored.xyz - 1.0;
    vec3 along;
    vec3 aside;
    tangents_beside(across, triangle, world_from_mesh(hit), along, aside);
    return normalize(material.normal_scale * (local.x * along + local.y * aside) + local.z * across);
}

#endif

PackedGloss met_gloss(Material material, float spread) {
    vec2 gloss = unpackHalf2x16(material.mean_gloss);
    return pack_gloss(material.mirror, vec2(widened_roughness(gloss.x, spread), gloss.y));
}
