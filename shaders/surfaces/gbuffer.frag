// Writes the visible surface to the G-buffer.
#include "surfaces/mesh_surface.glsl"

layout(location = 0) out vec4 albedo;
layout(location = 1) out vec2 packed_normal;

void main() {
    PackedSurface surface = fragment_surface(fragment_colour().rgb);
    albedo = vec4(surface.albedo, 1.0);
    packed_normal = surface.normal;
}
