// A ray from each glossy pixel, in a direction that its surface reflects to the viewer, and what it meets: another surface,
// as visible_surface.glsl reads it (MIRRORED), and what that one emits (EMISSION); or the sky (SKY). One fragment per pixel.
#include "maths.glsl"
#include "mirror/glossy_surface.glsl"
#ifdef EMITTERS
#include "mirror/emitter_rays.glsl"
#endif
#include "mirror/met_surface.glsl"
#include "sampling.glsl"
#include "scene/bvh.glsl"
#ifdef SKY
#include "mirror/sky_rays.glsl"
#endif

uniform uint ray_round;    // of rays through the same pixels, from 0
uniform float ray_offset;  // metres above the surface, where rays start

layout(location = 0) out vec4 width_and_position;    // metres: of a pixel there, 0 without a surface; position
layout(location = 1) out vec4 normal_and_direction;  // octahedral; from the surface towards the glossy one
// Alpha: radiance of an emitter that the ray was sent to, negative if it did not get there; 0: it was sent to none.
layout(location = 2) out vec4 albedo;
layout(location = 3) out vec4 radiance_and_density;  // of surface or sky; of the direction, 1/sr, 0: no ray
// As gbuffer.frag writes them.
layout(location = 4) out vec4 mirror;
layout(location = 5) out vec2 gloss;
#ifdef MIRRORED_BUMPS
layout(location = 6) out vec4 bumps;
#endif

// Neighbouring pixels have well distributed points. `pair`: of dimensions.
vec2 point_of(uvec2 pixel, uint pair) {
    uint in_block = (pixel.x & 3u) + 4u * (pixel.y & 3u);
    uint block = hash_combine(pixel.x >> 2u, pixel.y >> 2u);
    return sample_2d(16u * ray_round + in_block, pair, block);
}

struct SampledRay {
    vec3 direction;
    float density;  // 1/sr; 0: no ray
#ifdef EMITTERS
    Aim aim;
#endif
};

// Rays in a direction of the lobe, or to something bright that it reflects.
struct Shares {
    float to_emitters;
    float to_sky;
};

Shares shares_of_rays(ivec2 at, Surface surface) {
    Shares shares = Shares(0.0, 0.0);
#ifdef EMITTERS
    shares.to_emitters = share_to_emitters(surface);
#endif
#ifdef SKY
    shares.to_sky = share_to_sky_at(at, surface);
#endif
    return shares;
}

SampledRay sampled_ray(Surface surface, uvec2 pixel) {
    Facets facets = facets_of(surface);
    Shares shares = shares_of_rays(ivec2(pixel), surface);
    vec2 point = point_of(pixel, 0u);
    vec2 kind = point_of(pixel, 1u);
    SampledRay ray;
    ray.direction = sampled_direction(facets, point);
#ifdef SKY
    if (kind.x >= 1.0 - shares.to_sky) ray.direction = direction_to_sky(facets, point);
#endif
#ifdef EMITTERS
    Choices choices = choices_at(hash_combine(hash_combine(pixel.x, pixel.y), ray_round));
    if (kind.x < shares.to_emitters) ray.direction = direction_to_emitter(choices, surface.position, kind.y, point);
    ray.aim = aim_along(choices, surface.position, ray.direction);
#endif
    float by_lobe = lobe_towards(ray.direction, facets).sampled;
    ray.density = (1.0 - shares.to_emitters - shares.to_sky) * by_lobe;
    if (by_lobe <= 0.0) return ray;
#ifdef EMITTERS
    ray.density += shares.to_emitters * ray.aim.density;
#endif
#ifdef SKY
    if (shares.to_sky > 0.0) ray.density += shares.to_sky * density_to_sky(ray.direction, facets);
#endif
    return ray;
}

#ifdef EMITTERS
// Weights emitters among each other; within what a half float holds.
float aimed_radiance(Aim aim, Hit hit) {
    if (aim.radiance <= 0.0) return 0.0;
    float radiance = clamp(aim.radiance, 1e-4, 6e4);
    bool arrives = hit.triangle == NO_TRIANGLE || hit.t > 0.98 * aim.distance;
    return arrives ? radiance : -radiance;
}
#endif

#ifdef SKY
vec3 light_of_sky(vec3 direction) { return sky_without_suns(direction); }
#else
vec3 light_of_sky(vec3 direction) { return vec3(0.0); }
#endif

// Of what is seen at a distance behind a surface.
float width_behind(Surface surface, float distance) {
    if (view.orthographic != 0u) return surface.pixel;
    float depth = -(view.view_from_world * vec4(surface.position, 1.0)).z;
    return surface.pixel * (1.0 + distance / depth);
}

void put_no_material() {
    albedo.rgb = vec3(0.0);
    mirror = vec4(0.0);
    gloss = vec2(1.0, 0.0);
#ifdef MIRRORED_BUMPS
    bumps = vec4(normal_and_direction.xy, 1.0, 0.0);
#endif
}

void meet(Hit hit, vec3 origin, vec3 direction) {
    TraceTriangle triangle = triangle_at(hit.triangle);
    bool from_front = dot(front_of(hit), direction) < 0.0;
    width_and_position.yzw = origin + hit.t * direction;
    vec3 across = normalize(to_world(hit, hit_normal(triangle, hit.barycentric)));
    float side = from_front ? 1.0 : -1.0;
    normal_and_direction = vec4(octahedral_encode(side * across), octahedral_encode(-direction));
    put_no_material();
    radiance_and_density.rgb = vec3(0.0);
    if (!from_front && !is_double_sided(triangle.material)) return;
    Material material = materials[triangle.material];
    albedo.rgb = hit_colour(triangle, hit.barycentric).rgb;
    float spread = 0.0;
#ifdef MIRRORED_BUMPS
    vec3 turned = met_normal(material, with_uv_of(MATERIAL_SECOND_UV_NORMAL, hit.triangle), hit, across, spread);
    PackedBumps packed_bumps = pack_bumps(side * turned, 1.0);
    bumps = vec4(packed_bumps.normal, packed_bumps.open, 0.0);
#endif
    PackedGloss packed_gloss = met_gloss(material, spread);
    mirror = packed_gloss.mirror;
    gloss = packed_gloss.gloss;
#ifdef EMISSION
    radiance_and_density.rgb = emission_at(material, hit_uv(with_uv_of(MATERIAL_SECOND_UV_EMISSIVE, hit.triangle), hit.barycentric));
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (gl_HelperInvocation || !is_surface(at)) discard;
    Surface surface = glossy_surface(at);
    if (share_by_rays(surface) == 0.0) discard;
    SampledRay ray = sampled_ray(surface, uvec2(at));
    vec3 direction = ray.direction;
    if (ray.density <= 0.0 || dot(direction, face_normal(surface)) <= 0.0) discard;
    vec3 origin = ray_origin(surface, ray_offset);
    Hit hit = closest_hit(origin, direction, 0.0, INFINITY);
    width_and_position = vec4(0.0);
    normal_and_direction = vec4(0.0, 0.0, octahedral_encode(-direction));
    albedo.a = 0.0;
    put_no_material();
    radiance_and_density = vec4(light_of_sky(direction), ray.density);
#ifdef EMITTERS
    albedo.a = aimed_radiance(ray.aim, hit);
#endif
    if (hit.triangle == NO_TRIANGLE) return;
    meet(hit, origin, direction);
    width_and_position.x = width_behind(surface, hit.t);
}
