// Weights for a picture that is drawn to a target that has more pixels: those of bilinear interpolation between the
// nearest four pixels of the picture, of which those that do not show the surface that the pixel of the target shows
// hardly count, so that edges have the resolution of the target. One fragment per pixel of the target.
#include "bindings.glsl"
#include "output/enlarge.glsl"
#include "surfaces/visible_surface.glsl"
#include "surfaces/tangent_plane.glsl"

// The view and the textures of visible_surface.glsl are of the target.
layout(binding = UNIT_PICTURE_DEPTH) uniform sampler2D picture_depth;

layout(location = 0) out vec4 weights;

// The surface at a pixel of the target. Where there is none, the plane at infinity.
vec4 plane_at(vec2 pixel) {
    const float far_off = 1e9;
    float depth = texelFetch(surface_depth, ivec2(pixel), 0).r;
    if (depth == 0.0) return vec4(0.0, 0.0, far_off, 0.0);
    return tangent_plane(visible_face_normal(ivec2(pixel)), vec3(pixel / view.target_size * 2.0 - 1.0, depth));
}

// Factors on the weights of 2 × 2 pixels of the picture, `first` being the lowest of them. They fall with the square of
// the distance from the plane, and are 1/2 at a fortieth of a pixel of the picture: the pixels of a surface that curves
// keep their weights, those behind an edge lose them.
vec4 on_plane(vec4 plane, vec2 first, vec2 size) {
    const float half_at = 0.025;
    vec4 depths = textureGather(picture_depth, (first + 1.0) / size).wzxy;
    vec2 device = (first + 0.5) / size * 2.0 - 1.0;
    vec2 step = plane.xy * 2.0 / size;
    vec4 off = dot(plane.xyw, vec3(device, 1.0)) + vec4(0.0, step.x, step.y, step.x + step.y) + plane.z * depths;
    off *= size.y / view.target_size.y / half_at;  // from pixels of the target
    return 1.0 / (1.0 + off * off);
}

void main() {
    vec2 pixel = gl_FragCoord.xy;
    vec2 size = vec2(textureSize(picture_depth, 0));
    vec2 at = picture_position(pixel, view.target_size, size);
    vec2 first = floor(at);
    vec2 share = at - first;
    weights = vec4(1.0 - share.x, share.x, 1.0 - share.x, share.x) * vec4(1.0 - share.yy, share.yy);
    weights *= on_plane(plane_at(pixel), first, size);
    weights /= weights.x + weights.y + weights.z + weights.w;
}
