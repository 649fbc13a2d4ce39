// The VPLs that have depth maps, each in the slot of its index: surfels (SURFELS), or traced VPLs.
#include "bindings.glsl"
#include "types.glsl"

struct MappedVpl {
    vec3 position;  // metres, on the surface
    vec3 normal;    // unit
};

#ifdef SURFELS

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };

// All but those on deformed triangles without area.
bool has_map(uint index) { return surfels[index].normal != vec3(0.0); }

MappedVpl mapped_vpl(uint index) { return MappedVpl(surfels[index].position, surfels[index].normal); }

#else

layout(std430, binding = BINDING_TRACED_VPLS) readonly restrict buffer TracedVpls { TracedVpl traced_vpls[]; };

bool has_map(uint index) { return traced_vpls[index].state == VPL_PLACED; }

MappedVpl mapped_vpl(uint index) { return MappedVpl(traced_vpls[index].position, traced_vpls[index].normal); }

#endif
