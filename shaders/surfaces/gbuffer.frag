// Writes the visible surface to the G-buffer.
#include "surfaces/mesh_surface.glsl"

layout(location = 0) out vec2 packed_normal;
layout(location = 1) out vec4 albedo;

void main() {
    PackedSurface surface = fragment_surface(fragment_colour().rgb);
    packed_normal = surface.normal;
    albedo = vec4(surface.albedo, 1.0);
}
