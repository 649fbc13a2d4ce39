// Whether a VPL sees a surface: in its depth map (VPL_VISIBILITY_MAPS), by a ray (VPL_VISIBILITY_RAYS), or always.
#include "bindings.glsl"
#include "maths.glsl"
#include "surface.glsl"
#include "types.glsl"
#include "vpl_constants.glsl"

#if defined(VPL_VISIBILITY_MAPS)

#include "vpl_atlas.glsl"

layout(binding = UNIT_VPL_MAPS) uniform sampler2DArrayShadow vpl_maps;

// Sine of the angle δ between a direction and the centres of the texels that its bilinear look-up reads. They are less
// than a texel of 2/N off along either side of the square; that is √2 · 2/N or less on the octahedron, where a step of
// (a, b) is √(3a² + b²)/√2 or √(a² + 3b²)/√2 long. The point there is 1/s from the centre, s = |x| + |y| + z of the unit
// direction, and a ball of radius e at a distance d is seen under asin(e/d). The look-up is turned by δ first, over which
// s, whose gradient on the sphere is √(3 - s²), grows by less than the factor 1 + 5/N, and never beyond √3.
float footprint_sine(vec3 direction, float texels) {
    float s = abs(direction.x) + abs(direction.y) + direction.z;
    return min(2.8284271 * min(s * (1.0 + 5.0 / texels), 1.7320508) / texels, 0.9);
}

// The surface is lifted along its normal before it is looked up, by so much that its own plane can nowhere be nearer in
// the map. Let the plane be at the perpendicular distance h from the map's origin and the surface ρ aside from the plane's
// nearest point. Lifted by l it is seen at the angle θ to the plane's normal with r sin θ = ρ and r cos θ = h - l; a texel
// read there holds the plane at h / cos(θ - δ) at the nearest. That is r or more if l ≥ r (cos(θ - δ) - cos θ) =
// ρ sin δ - (h - l)(1 - cos δ), and so with l = ρ tan δ. (Where θ < δ the nearest is h, and ρ < h sin δ cos δ makes r less.)
// No distance is taken off for the slope, so that even a surface seen at a grazing angle stays behind what stands in front
// of it; shadows begin at the foot of what casts them and end at most two texels from their true edge. A tenth of the
// distance more pays for shading normals that are some 5 degrees off, four ray offsets for rounding.
float lift_above_map(float aside, float distance, float sine) {
    return (aside + 0.1 * distance) * sine * inversesqrt(1.0 - sine * sine) + 4.0 * vpl_constants.ray_offset;
}

// Share of the VPL's light that reaches the surface, in [0, 1].
float vpl_visibility(Vpl vpl, Surface surface) {
    vec3 from_vpl = surface.position - vpl_map_origin(vpl);
    vec3 tangent, bitangent;
    basis_around(vpl.normal, tangent, bitangent);
    float texels = float(vpl_constants.map_resolution);

    float distance = length(from_vpl);
    float height = dot(surface.normal, from_vpl);
    float aside = sqrt(max(distance * distance - height * height, 0.0));
    vec3 local = vec3(dot(from_vpl, tangent), dot(from_vpl, bitangent), max(dot(from_vpl, vpl.normal), 0.0));
    float sine = footprint_sine(local / distance, texels);
    vec3 lifted = from_vpl + lift_above_map(aside, distance, sine) * surface.normal;

    vec3 seen = vec3(dot(lifted, tangent), dot(lifted, bitangent), max(dot(lifted, vpl.normal), 0.0));
    // Half a texel inside, so that the filter stays in the tile; and in 256ths, which add up exactly to the atlas's
    // coordinates, so that the result does not depend on the tile.
    vec2 inside = (hemi_octahedral_encode(seen) * 0.5 + 0.5) * texels;
    inside = clamp(floor(inside * 256.0 + 0.5) / 256.0, 0.5, texels - 0.5);
    VplTile tile = vpl_tile(vpl.map);
    vec2 at = (vec2(tile.corner) + inside) / vec2(textureSize(vpl_maps, 0).xy);
    float reference = clamp(vpl_map_depth(min(length(lifted), distance)), 0.0, 1.0);
    return texture(vpl_maps, vec4(at, float(tile.layer), reference));
}

#elif defined(VPL_VISIBILITY_RAYS)

#include "bvh.glsl"

float vpl_visibility(Vpl vpl, Surface surface) {
    vec3 target = vpl.position + vpl_constants.ray_offset * vpl.normal;
    vec3 origin = surface.position + vpl_constants.ray_offset * surface.normal;
    origin += max(dot(target - origin, vpl.normal), 0.0) * vpl.normal;  // no lower than the target, above its surface
    vec3 to_vpl = target - origin;
    float t_min = vpl_constants.crease_slack / max(length(to_vpl), 1e-30);
    return any_hit(origin, to_vpl, t_min, 1.0) ? 0.0 : 1.0;
}

#else

float vpl_visibility(Vpl vpl, Surface surface) { return 1.0; }

#endif
