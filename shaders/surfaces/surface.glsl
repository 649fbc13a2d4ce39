// The visible surface, and its packed form in the G-buffer. Every shading path packs and unpacks the surface, even
// where it has no G-buffer, so that all of them shade exactly the same values.
#include "maths.glsl"

struct Surface {
    vec3 position;   // world space, metres
    vec3 normal;     // to be read through face_normal or shading_normal
    vec3 albedo;     // linear
    vec3 to_viewer;  // unit
    float pixel;     // metres: a pixel's width at the position
#ifdef GLOSSY
    // Then `albedo` is that of the diffuse part.
    vec4 mirror;      // reflectance in the mirror direction: where the surface faces the viewer, and (alpha) grazing
    float roughness;  // square root of GGX's α
#ifdef SHOW_METALNESS
    float metalness;
#endif
#endif
#ifdef BUMPY
    vec3 turned_normal;  // to be read through shading_normal
    float open;          // share of indirect light that reaches the surface
#endif
};

struct PackedSurface {
    vec3 albedo;  // already rounded to half floats
    vec2 normal;  // octahedral
};

// Visibility, creases and the test whether pixels lie on the same surface use the face normal, and the response to light
// the shading normal; unit vectors on the side that the viewer sees. The face normal is the interpolated normal of the
// vertices, or the host's. Only a normal texture makes the shading normal another one; one member for both keeps arrays
// of surfaces small.
vec3 face_normal(Surface surface) { return surface.normal; }
#ifdef BUMPY
vec3 shading_normal(Surface surface) { return surface.turned_normal; }
#else
vec3 shading_normal(Surface surface) { return surface.normal; }
#endif

// Share of indirect light that reaches the surface.
#ifdef BUMPY
float open_share(Surface surface) { return surface.open; }
#else
float open_share(Surface surface) { return 1.0; }
#endif

#ifdef GLOSSY

// What a material makes glossy, in the G-buffer.
struct PackedGloss {
    vec4 mirror;  // Material::mirror
    vec2 gloss;   // roughness, metalness
};

// The values as the G-buffer, of half floats, has them.
PackedGloss pack_gloss(vec4 mirror, vec2 gloss) {
    vec2 low = unpackHalf2x16(packHalf2x16(mirror.rg));
    vec2 high = unpackHalf2x16(packHalf2x16(mirror.ba));
    return PackedGloss(vec4(low, high), unpackHalf2x16(packHalf2x16(gloss)));
}

// Roughness of a surface whose normals differ within a pixel. `slope`: root of the mean square of their slopes against the
// normal that the pixel has. See README.md, "Bumps that are too small to be seen".
float widened_roughness(float roughness, float slope) {
    if (slope == 0.0) return roughness;
    float alpha = roughness * roughness;
    return sqrt(sqrt(min(alpha * alpha + slope * slope, 1.0)));
}

// Metal reflects its base colour in the mirror direction, and nothing else.
void set_gloss(inout Surface surface, PackedGloss stored) {
    float metalness = stored.gloss.y;
    surface.mirror = mix(stored.mirror, vec4(surface.albedo, 1.0), metalness);
    surface.albedo *= 1.0 - metalness;
    surface.roughness = stored.gloss.x;
#ifdef SHOW_METALNESS
    surface.metalness = metalness;
#endif
}

#endif

// What a material's images of details add, in the G-buffer.
struct PackedBumps {
    vec2 normal;  // octahedral: the shading normal
    float open;   // Surface::open
};

PackedBumps pack_bumps(vec3 normal, float open) { return PackedBumps(octahedral_encode(normal), open); }

#ifdef BUMPY

void set_bumps(inout Surface surface, PackedBumps stored) {
    surface.turned_normal = octahedral_decode(stored.normal);
    surface.open = stored.open;
}

#endif

PackedSurface pack_surface(vec3 albedo, vec3 normal) {
    vec3 rounded = vec3(unpackHalf2x16(packHalf2x16(albedo.rg)), unpackHalf2x16(packHalf2x16(albedo.bb)).x);
    return PackedSurface(rounded, octahedral_encode(normal));
}

// Change of a position per step along an axis of clip space, in metres. `column`: the axis' in world_from_clip; `w`: the
// position's before division.
vec3 step_in_clip(vec4 column, vec3 position, float w) { return (column.xyz - position * column.w) / w; }

// `window`: the pixel's centre in window coordinates (pixels), and its window depth.
Surface unpack_surface(PackedSurface surface, vec3 window, vec2 target_size, mat4 world_from_clip) {
    vec4 clip = vec4(window.xy / target_size * 2.0 - 1.0, window.z, 1.0);
    vec4 world = world_from_clip * clip;
    vec3 position = world.xyz / world.w;
    vec3 to_viewer = normalize(step_in_clip(world_from_clip[2], position, world.w));
    float pixel = 2.0 / target_size.x * length(step_in_clip(world_from_clip[0], position, world.w));
    Surface found;
    found.position = position;
    found.normal = octahedral_decode(surface.normal);
    found.albedo = surface.albedo;
    found.to_viewer = to_viewer;
    found.pixel = pixel;
    return found;
}

// Where rays from the surface start and its visibility is judged, on the side that the viewer sees. Corners are rounded to
// 1/256 of a pixel before they are drawn: GPUs put a surface up to √2/512 of a pixel behind where it is (software drivers do
// not), and at a crease a pixel may show what lies behind the other surface, and may be lit from behind. So the origin is
// as much above the surface, besides the offset, and 1/32 of a pixel nearer to the viewer; at least 24 steps of the largest
// coordinate, as positions far from the world's origin are rounded, and at most 32 offsets, so that the middle of a large
// pixel stays on its surface.
vec3 ray_origin(Surface surface, float ray_offset) {
    float nearer = max(surface.pixel / 32.0, 24.0 / 8388608.0 * largest(surface.position));
    float above = ray_offset + surface.pixel / 362.0;
    return surface.position + min(nearer, 32.0 * ray_offset) * surface.to_viewer + above * face_normal(surface);
}
