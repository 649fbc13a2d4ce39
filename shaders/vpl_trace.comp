// Traces paths of light from the lights and leaves a VPL at every diffuse bounce: Keller, "Instant Radiosity" (1997).
// Blended surfaces are not among the triangles: light passes through them unchanged. One invocation a path; path and
// bounce give the VPL's place, so that the order is that of the paths.
#include "bindings.glsl"
#include "bvh.glsl"
#include "lights.glsl"
#include "materials.glsl"
#include "sampling.glsl"
#include "types.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = BINDING_LIGHTS) readonly restrict buffer Lights { Light lights[]; };
layout(std430, binding = BINDING_PATHS) readonly restrict buffer Paths { Path paths[]; };
// Factor on the flux of a path that goes on from bounce i + 1, for those that do not.
layout(std430, binding = BINDING_CONTINUATION) readonly restrict buffer Continuation { float continuation[]; };
layout(std430, binding = BINDING_VPLS) writeonly restrict buffer Vpls { Vpl vpls[]; };
layout(std430, binding = BINDING_FLUX) writeonly restrict buffer Flux { FluxAccount flux[]; };

uniform uint path_count;
uniform uint max_bounces;
uniform float ray_offset;  // metres, off the surface

// Cosine to a spot's axis, distributed as its intensity: inverse of the cumulative flux of the inner cone, which is
// constant, followed by that of the quadratic falloff.
float sample_spot_cosine(Light light, float u) {
    float inner = 1.0 - light.cos_inner;
    float falloff = (light.cos_inner - light.cos_outer) / 3.0;
    float x = u * (inner + falloff);
    if (x < inner) return 1.0 - x;
    return light.cos_outer + (light.cos_inner - light.cos_outer) * pow(max(1.0 - (x - inner) / falloff, 0.0), 1.0 / 3.0);
}

void sample_emission(Light light, vec2 u, out vec3 origin, out vec3 direction) {
    origin = light.position;
    direction = light.direction;
    if (light.kind == LIGHT_POINT) direction = direction_at(vec3(0.0, 0.0, 1.0), 1.0 - 2.0 * u.x, u.y);
    if (light.kind == LIGHT_SPOT) direction = direction_at(light.direction, sample_spot_cosine(light, u.x), u.y);
    if (light.kind == LIGHT_DIRECTIONAL) {
        vec3 tangent, bitangent;
        basis_around(light.direction, tangent, bitangent);
        vec2 at = (2.0 * u - 1.0) * light.shape;
        origin += at.x * tangent + at.y * bitangent;
    }
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= path_count) return;
    Path path = paths[id];
    Light light = lights[path.light];

    for (uint i = 0u; i < path.vpl_count; ++i) vpls[path.first_vpl + i] = Vpl(vec3(0.0), id, vec3(0.0), i + 1u, vec3(0.0), 0u);

    vec3 origin, direction;
    sample_emission(light, sample_2d(path.index, 0u, path.seed), origin, direction);
    vec3 carried = path.flux;
    FluxAccount account = FluxAccount(carried, 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);

    for (uint bounce = 1u; bounce <= path.vpl_count; ++bounce) {
        Hit hit = closest_hit(origin, direction, 0.0, 1.0 / 0.0);
        if (hit.triangle == NO_TRIANGLE) {
            account.escaped += carried;
            break;
        }
        if (bounce == 1u && light.kind != LIGHT_DIRECTIONAL) {
            // What a ranged light holds back counts as escaped.
            float window = range_window(hit.t, light.range);
            account.escaped += carried * (1.0 - window);
            carried *= window;
        }
        TraceTriangle triangle = triangles[hit.triangle];
        vec3 front = normalize(cross(triangle.edge_ab, triangle.edge_ac));
        bool from_front = dot(front, direction) < 0.0;
        vec3 normal = from_front ? front : -front;
        vec3 albedo = from_front || is_double_sided(triangle.material) ? hit_colour(triangle, hit.barycentric).rgb : vec3(0.0);
        vec3 position = triangle.a + hit.barycentric.x * triangle.edge_ab + hit.barycentric.y * triangle.edge_ac;

        vec3 reflected = carried * albedo;
        account.absorbed += carried - reflected;
        vpls[path.first_vpl + bounce - 1u] = Vpl(position, id, normal, bounce, reflected, 0u);

        if (bounce == max_bounces) {
            account.truncated += reflected;
        } else if (bounce == path.vpl_count) {
            account.roulette += reflected;
        } else {
            carried = reflected * continuation[bounce - 1u];
            account.roulette -= carried - reflected;
            origin = position + ray_offset * normal;
            direction = cosine_direction(normal, sample_2d(path.index, bounce, path.seed));
        }
    }
    flux[id] = account;
}
