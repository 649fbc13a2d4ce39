// The sky in the mirror direction. A part of the rays of rough surfaces goes to bright parts of the sky that they reflect,
// drawn from a tree over the directions of its picture (renderer/passes/sky/sky_tree.hpp). See README.md, "Bright skies in
// rough surfaces".
#include "bindings.glsl"
#include "mirror/glossy_surface.glsl"
#include "sky/sky_picture.glsl"

// A mip level is a level of the tree. w: brightness; xyz: the same times direction, summed.
layout(binding = UNIT_SKY_TREE) uniform sampler2D sky_tree;

// Unit direction, world space, and the cosine of the radius with its surroundings. Zero: none.
uniform vec4 suns[MOST_SKY_SUNS];
uniform float share_to_sky;  // of the rays of a flat rough surface

// Surfaces reflect suns as directional lights: rays see what is beside them.
vec3 sky_without_suns(vec3 direction) {
    for (int i = 0; i < MOST_SKY_SUNS; ++i) {
        float cosine = dot(direction, suns[i].xyz);
        if (cosine <= suns[i].w) continue;
        vec3 aside = direction - cosine * suns[i].xyz + 1e-6 * suns[i].yzx;
        direction = normalize(suns[i].xyz + sqrt(1.0 / (suns[i].w * suns[i].w) - 1.0) * normalize(aside));
    }
    return sky_light(direction);
}

// Rays to bright parts serve where neighbouring pixels reflect the same ones, and are harmful elsewhere: where a pixel's
// only ray went to something bright that it hardly reflects, nothing else tells what it does reflect.
float share_to_sky_at(ivec2 at, Surface surface) {
    const int APART = 2;  // pixels
    float turned = 0.0;   // the most that the normals of neighbours differ by, radians
    for (int i = 0; i < 4; ++i) {
        int aside = (i & 1) * 2 * APART - APART;
        ivec2 there = at + (i < 2 ? ivec2(aside, 0) : ivec2(0, aside));
        vec3 normal = normal_at(clamp(there, ivec2(0), ivec2(view.target_size) - 1));
        turned = max(turned, distance(normal, shading_normal(surface)));
    }
    float alpha = surface.roughness * surface.roughness;
    float smooth_enough = 1.0 - smoothstep(0.5 * alpha, 2.0 * alpha, turned);
    // In smoother surfaces than these the lobe is smaller than the cells of the tree.
    return share_to_sky * smoothstep(0.08, 0.15, surface.roughness) * smooth_enough;
}

// Brightness of a cell as the lobe, as much wider as the cell is, reflects it.
float reflected_brightness(ivec2 cell, int level, Facets facets) {
    vec4 node = texelFetch(sky_tree, cell, level);
    if (node.w <= 0.0) return 0.0;
    float along = length(node.xyz);
    vec3 direction = rotate_y(node.xyz, rotation) / max(along, 1e-20);
    float spread = max(1.0 - along / node.w, 0.0);  // a quarter of the squared angular radius
    float cosine = dot(facets.normal, direction) + 2.0 * sqrt(spread);
    vec3 in_space = vec3(dot(direction, facets.tangent), dot(direction, facets.bitangent), dot(direction, facets.normal));
    vec3 middle = normalize(in_space + facets.viewer);
    float lobe = facets_along(middle.z, dot(middle.xy, middle.xy), min(facets.alpha * facets.alpha + spread, 1.0));
    return node.w * lobe * max(cosine, 0.0);
}

// Of the four children of a node, the first of which is `first`.
vec4 children(ivec2 first, int level, Facets facets) {
    return vec4(reflected_brightness(first, level, facets), reflected_brightness(first + ivec2(1, 0), level, facets),
                reflected_brightness(first + ivec2(0, 1), level, facets),
                reflected_brightness(first + ivec2(1, 1), level, facets));
}

float sum_of(vec4 v) { return v.x + v.y + v.z + v.w; }

// A direction, for `u` in [0, 1)²; zero if none is reflected.
vec3 direction_to_sky(Facets facets, vec2 u) {
    ivec2 cell = ivec2(0);
    for (int level = textureQueryLevels(sky_tree) - 2; level >= 0; --level) {
        cell *= 2;
        vec4 likely = children(cell, level, facets);
        if (sum_of(likely) <= 0.0) return vec3(0.0);
        float left = u.x * sum_of(likely);
        int child = 0;
        while (child < 3 && left >= likely[child]) left -= likely[child++];
        u.x = clamp(left / likely[child], 0.0, 0.9999999);
        cell += ivec2(child & 1, child >> 1);
    }
    vec2 at = (vec2(cell) + u) / vec2(textureSize(sky_tree, 0));
    return rotate_y(sky_direction(at), rotation);
}

// With which direction_to_sky finds a direction, 1/sr.
float density_to_sky(vec3 direction, Facets facets) {
    ivec2 size = textureSize(sky_tree, 0);
    ivec2 leaf = clamp(ivec2(sky_position(rotate_y(direction, -rotation)) * vec2(size)), ivec2(0), size - 1);
    float share = 1.0;
    for (int level = textureQueryLevels(sky_tree) - 2; level >= 0; --level) {
        ivec2 cell = leaf >> level;
        vec4 likely = children(cell & ~1, level, facets);
        share *= likely[(cell.x & 1) + 2 * (cell.y & 1)] / max(sum_of(likely), 1e-30);
    }
    float top = cos(PI * float(leaf.y) / float(size.y));
    float bottom = cos(PI * float(leaf.y + 1) / float(size.y));
    return share * float(size.x) / (2.0 * PI * (top - bottom));
}
