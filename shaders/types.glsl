// Structs shared by the shaders and the CPU: renderer/gpu/gpu_types.hpp includes this file as C++. Layout std430, those of
// uniform blocks also std140. A test compares every offset and stride with what the driver reports.
// Flux is in lm or W, irradiance in lux or W/m², depending on the unit of the lights.

// Values of members that C++ may leave out of an initialiser.
#ifdef __cplusplus
#define DEFAULT(value) = value
#else
#define DEFAULT(value)
#endif

struct Instance {
    vec4 world[3];  // rows of the local-to-world matrix
    uint material;
    uint pad0 DEFAULT(0u);
    uint pad1 DEFAULT(0u);
    uint pad2 DEFAULT(0u);
};

struct Material {
    vec4 base_colour;     // linear, and alpha
    uint first_texel;     // in the texel buffer, of its base-colour image at reduced resolution
    uint texel_width;     // texels; 0: no texture
    uint texel_height;
    uint flags;           // MATERIAL_*
    float alpha_cutoff;   // alpha below it is a hole; 0: no holes
    uint first_emissive_texel;  // the same of its emissive image
    uint emissive_width;
    uint emissive_height;
    vec3 emissive;        // radiance
    float metalness;      // without its texture, as the next
    vec4 mirror;          // reflectance of what is not metal, in the mirror direction: towards its normal, and grazing
    vec3 traced_mirror;   // Lambertian surfaces stand for glossy ones where light is traced: of albedo traced_share times
    float traced_share DEFAULT(1.0);  // the base colour, plus traced_mirror
    float roughness DEFAULT(1.0);
    float normal_scale DEFAULT(0.0);  // of the normals' x and y; 0: no normal texture
    float occlusion_strength DEFAULT(0.0);
    uint mean_gloss DEFAULT(0u);    // roughness and metalness with the mean of their texture, half floats
    uint first_normal_texel DEFAULT(0u);  // as first_texel, of its normal texture
    uint normal_width DEFAULT(0u);
    uint normal_height DEFAULT(0u);
    float transmission DEFAULT(0.0);
};

#define MATERIAL_DOUBLE_SIDED 1u
#define MATERIAL_BASE_COLOUR_WRAP_SHIFT 1u  // 2 bits for u, then 2 for v
#define MATERIAL_EMISSIVE_WRAP_SHIFT 5u
#define MATERIAL_NORMAL_WRAP_SHIFT 9u
#define MATERIAL_SECOND_UV_EMISSIVE 0x2000u  // the image lies by the second texture coordinates: SecondUvUse
#define MATERIAL_SECOND_UV_GLOSS 0x4000u
#define MATERIAL_SECOND_UV_NORMAL 0x8000u
#define MATERIAL_SECOND_UV_OCCLUSION 0x10000u
#define MATERIAL_ALPHA_IGNORED 0x20000u  // of glass: its alpha blends nothing
#define MATERIAL_WRAP_BITS 2u
#define MATERIAL_WRAP_MASK 3u

#define LIGHT_POINT 0u
#define LIGHT_SPOT 1u
#define LIGHT_DIRECTIONAL 2u

struct Light {
    vec3 position;   // metres; directional: centre of the footprint, a rectangle outside the scene that rays start on
    uint kind;       // LIGHT_*
    vec3 direction;  // unit, in which the light travels
    float range;     // metres; may be infinite
    vec3 intensity;  // candela; directional: lux
    float cos_outer;  // spot: of the cone
    vec2 shape;      // spot: the cone's falloff is (y - (1 - cos) x)²; directional: half extents of the footprint, metres
    float pad0 DEFAULT(0.0);
    float pad1 DEFAULT(0.0);
};

// What all lights have in common. A uniform block: shaders/lights/light_constants.glsl.
struct LightConstants {
    uint count;  // of lights
    uint pad0 DEFAULT(0u);
    uint pad1 DEFAULT(0u);
    uint pad2 DEFAULT(0u);
};

struct LightReceiver {
    vec3 position;  // metres
    float pad0 DEFAULT(0.0);
    vec3 normal;  // unit
    float pad1 DEFAULT(0.0);
};

#define SHADOW_CUBE 0u
#define SHADOW_PERSPECTIVE 1u
#define SHADOW_ORTHOGRAPHIC 2u
#define SHADOW_BY_RAYS 3u
#define SHADOW_NONE 4u

// The shadow map of the light with the same index, or one of the faces of cubes, which follow those of the lights.
struct Shadow {
    mat4 from_world;   // to clip space; unused by cubes
    float depth_scale; // change of depth per change of the inverse distance along the map's axis, metres; orthographic: 0
    uint layer;        // of the map; cubes: index of the Shadow of their first face, whose layer is one of the cubes' array
    uint kind;         // of the map; SHADOW_BY_RAYS: there is none; SHADOW_NONE: the light casts no shadow
    float ray_offset;  // metres above a surface, where rays to the light start
};

// The camera's view of the current frame. A uniform block: shaders/view/view.glsl.
struct ViewConstants {
    mat4 clip_from_world;
    mat4 world_from_clip;
    mat4 view_from_world;
    vec2 target_size;    // pixels
    vec2 ray_scale;      // (ndc - ray_shift) · ray_scale: view-space x and y at depth 1 (orthographic: at any depth)
    vec2 ray_shift;
    vec2 depth_terms;    // a and b of window depth = a·z + b (orthographic), -a + b / depth (perspective)
    uint orthographic;   // 1: orthographic, 0: perspective
    uint pad0 DEFAULT(0u);
    uint pad1 DEFAULT(0u);
    uint pad2 DEFAULT(0u);
};

// The grid of cells that the view is divided into; see CellGrid in renderer/passes/lights/light_bins.hpp. A uniform block:
// shaders/lights/light_cells.glsl.
struct CellConstants {
    uvec2 tiles;         // cells across and up
    uvec2 target_size;   // pixels
    uint slices;
    uint tile_size;      // pixels
    float first_depth;   // metres: end of slice 0
    float depth_ratio;   // end of a slice over the end of the slice before
};

// Depths of the surfaces in a screen tile.
struct TileDepth {
    float nearest;   // metres; greater than `farthest` if there is no surface
    float farthest;
    uint mask;       // bits of those of the 32 slices between the two that have surfaces
    uint pad0 DEFAULT(0u);
};

// Virtual point lights (VPLs) are of five kinds: those on paths that were traced from the lights; or surfels, surfels on
// surfaces that emit light, patches of the sky, and directions in which all surfaces have the same light. Their indices run through the kinds in this order: VplConstants.

#define VPL_PLACED 0u
#define VPL_ESCAPED 1u  // the path has left the scene before this bounce

// A VPL at a bounce of a path. Its depth map is in the slot of its index, and shows the hemisphere.
struct TracedVpl {
    vec3 position;    // metres, on the surface
    uint state;       // VPL_*
    vec3 normal;      // unit; it sends light into this half-space
    float radius2;    // m², R²: bounds its geometry term to 4/3 of 1/R²
    vec3 flux;        // reflected
    float pad0 DEFAULT(0.0);
    vec3 edges_up;    // 1/m, inverse distances to edges along +x, +y, +z, 0: none near: vpl_edges.comp
    float pad1 DEFAULT(0.0);
    vec3 edges_down;  // 1/m, along -x, -y, -z
    float pad2 DEFAULT(0.0);
};

// A surfel: a point that gathers and sends light for the part of the surface around it, its cell.
struct Surfel {
    vec3 position;     // metres, on the surface
    uint first_point;  // index of its cell's first point
    vec3 normal;       // unit; of deformed triangles without area 0
    uint point_count;  // points of its cell
    float area;        // m², of its cell
    float width2;      // m², squared width of its cell: the area of a square one
    uint map DEFAULT(0u);   // slot of its depth map, and what it shows: SURFEL_MAP_*; unused if it emits light
    uint seed DEFAULT(0u);  // of its random directions
    float own DEFAULT(1.0F);  // share of `area` that is of its own item; the rest stands for other items
    float pad0 DEFAULT(0.0F);
    float pad1 DEFAULT(0.0F);
    float pad2 DEFAULT(0.0F);
};

// What is traced for a surfel in a frame, of its form factors to others and its depth map. 0: nothing.
#define SURFEL_CHANGED 1u      // rays that pass the boxes in which the scene has changed
#define SURFEL_WHOLE 2u        // all rays
#define SURFEL_COLUMN 4u       // also those of the others to it
#define SURFEL_NO_FACTORS 8u   // nothing: its form factors become 0
#define SURFEL_NO_MAP 16u      // nothing: its depth map lets no light through

// The lower bits of Surfel::map are a slot. The others are 0 if the depth map shows the hemisphere, and otherwise 1 more
// than the index of the focus that it is a picture of: VplConstants::foci.
#define SURFEL_MAP_SLOT 0x1fffffffu
#define SURFEL_MAP_FOCUS_SHIFT 29u
#define SURFEL_MAP_FOCI 4

// A surfel with the light that its cell reflects, as a VPL.
struct LitSurfel {
    vec3 position;     // metres, of the surfel; its depth map is seen from ray_offset above it
    uint first_point;  // index of its cell's first LitPoint
    vec3 normal;       // unit; it sends light into this half-space
    uint point_count;  // points of its cell
    vec3 centre;       // metres: mean position of the flux
    float radius2;     // m², squared radius of the disc that the flux comes from
    vec3 flux;
    float area;        // m², of its cell
    float width2;      // m², squared width of its cell: the area of a square one
    uint map;          // Surfel::map
    float pad0 DEFAULT(0.0F);
    float pad1 DEFAULT(0.0F);
};

// A surfel on a surface that emits light, with that light and what its cell reflects, as a VPL.
struct LitEmitter {
    vec3 position;     // metres, of the surfel; rays to it end ray_offset above it
    uint first_point;  // index of its cell's first LitPoint
    vec3 normal;       // unit; it sends light into this half-space
    uint point_count;  // points of its cell
    vec3 flux;
    float area;        // m², of its cell
};

// A part of the sky, far away in one direction, as a VPL.
struct SkyPatch {
    vec3 direction;     // towards it, unit
    float half_width2;  // radians², squared half width
    vec3 light;         // π times the irradiance on a surface that faces it
    float pad0 DEFAULT(0.0);
};

// A sample point of a surfel's cell; represents a part of the surface. None is in a hole of a mask.
struct CellPoint {
    vec3 position;  // metres
    uint material;
    vec3 normal;    // unit
    float area;     // m²
    vec2 uv;        // MATERIAL_SECOND_UV_EMISSIVE: the second
    uint surfel;    // index of the surfel whose cell it belongs to
    uint colour;    // of the vertices, interpolated, in that case × the base colour's texture: as TraceTriangle::colour_a
    vec3 middle;    // metres, of the part that it represents: the light that it sends comes from there
    float pad0 DEFAULT(0.0F);
};

// Light that a cell point receives from the lights and from surfaces that emit light, and that it emits.
struct DirectPoint {
    vec3 arriving;  // flux
    float pad0 DEFAULT(0.0);
    vec3 albedo;    // linear
    float pad1 DEFAULT(0.0);
    vec3 emitted;   // flux
    float pad2 DEFAULT(0.0);
    vec3 from_emitters;  // the part of `arriving` that comes from surfaces that emit light
    float pad3 DEFAULT(0.0);
};

// A cell point with all the light that it reflects.
struct LitPoint {
    vec3 position;  // metres
    float area;     // m²
    vec3 normal;    // unit
    float pad0 DEFAULT(0.0);
    vec3 flux;      // emitted, and reflected of direct and indirect light
    float pad1 DEFAULT(0.0);
};

// Light of a surfel's cell as a whole, from the lights and from other surfels.
struct CellLight {
    vec3 centre;    // metres: mean position of the flux `direct`
    float radius2;  // m², squared radius of the disc that this flux comes from
    vec3 arriving;  // flux of the lights and of surfaces that emit light
    float pad2 DEFAULT(0.0);
    vec3 direct;    // the part of `arriving` that it reflects, and what it emits
    float pad0 DEFAULT(0.0);
    vec3 emitted;   // flux
    float pad3 DEFAULT(0.0);
    vec3 from_emitters;  // the part of `arriving` that comes from surfaces that emit light
    float pad4 DEFAULT(0.0);
    vec3 albedo;    // mean over the area of its points
    float area;     // m²
    vec3 indirect;  // irradiance from the other surfels, sum over all bounces
    float pad1 DEFAULT(0.0);
};

// Constants that all VPLs share. A uniform block: shaders/vpls/vpl_constants.glsl.
struct VplConstants {
    uint count;               // of all kinds
    uint first_emitter;       // index of the first surfel on a surface that emits light
    uint first_sky_patch;     // index of the first patch of the sky
    float ray_offset;         // metres above a surface, where rays and depth maps start
    uint map_resolution;      // texels along a side of a slot of the atlas
    uint map_tiles;           // slots along a side of a layer
    float map_side;           // texels along a side of a layer
    float map_near;           // metres, the octahedral distance at which map depth is 1
    vec4 foci[4];             // SURFEL_MAP_FOCI spheres, of which a far surfel's map shows one: centre and radius, metres
    uint mapped;              // VPLs with depth maps
    uint first_direction;     // index of the first direction of light that is the same everywhere
    uint mean_record;         // index of the LitSurfel that has this light: surfel_mean.comp
    uint pad0 DEFAULT(0u);
};

#ifndef __cplusplus  // C++ has it, with what its members mean, in engine/bvh/wide.hpp
struct WideNode {
    vec3 origin;
    uint exponents;
    uvec4 lower;
    uvec4 upper;
    uvec4 children;
};
#endif

#define INSTANCE_CHILD 7u  // WideNode: engine/bvh/wide.hpp

// A box of the tree of those in which the scene has changed: renderer/passes/scene/changed_boxes.hpp.
struct ChangedBox {
    vec3 lower;  // metres
    uint next;   // box to go on with if nothing in this one is of interest
    vec3 upper;
    uint pad0 DEFAULT(0u);
};

// In the space of its mesh, unless said otherwise.
struct TraceTriangle {
    vec3 a;
    uint material;
    vec3 edge_ab;
    uint id;      // index in the mesh; with TRIANGLE_MASKED: it may have holes of an alpha mask
    vec3 edge_ac;
    uint colour_a;  // of the vertex: rgb in sRGB, and alpha, 8 bits each
    vec2 uv_a;
    vec2 uv_b;
    vec2 uv_c;
    uint colour_b;
    uint colour_c;
    uint normal_a;  // of the vertex: octahedral, 16 bits each
    uint normal_b;
    uint normal_c;
    uint second DEFAULT(0u);  // the second texture coordinates are the uv of the triangle so many places behind; 0: none
};

#define TRIANGLE_MASKED 0x80000000u

struct Path {
    vec3 flux;       // of its light as a whole; a weight a bounce gives the path's share
    uint light;
    uint index;      // within the light's sequence
    uint seed;       // of the light's sequence
    uint first_vpl;  // index of the VPL of its first bounce
    uint vpl_count;  // largest number of its bounces, at least 1
};

// A bounce of a traced path, without its flux.
struct VplRecord {
    vec3 position;    // metres; escaped: where the segment began
    uint state;       // VPL_*
    vec3 normal;      // unit; escaped: the segment's direction
    float pad0 DEFAULT(0.0);
    vec3 throughput;  // product of the albedos so far, this bounce's included
    float pad1 DEFAULT(0.0);
};

// Where the flux of a path, of all surfels, or of a class of them (surfel_bounces.comp) went. emitted = absorbed + escaped + truncated + roulette, up to
// rounding; of surfels also up to the balance of the form factors, and without roulette.
struct FluxAccount {
    vec3 emitted;  // of surfels: flux of the lights that arrives at the cells, and that the cells emit
    float pad0 DEFAULT(0.0);
    vec3 absorbed;
    float pad1 DEFAULT(0.0);
    vec3 escaped;
    float pad2 DEFAULT(0.0);
    vec3 truncated;
    float pad3 DEFAULT(0.0);
    vec3 roulette;  // lost where the path was ended early, minus what higher weights added where it went on
    float pad4 DEFAULT(0.0);
    // Of surfels, work groups for the next bounce and for adding up after it: none if too little flux is left.
    uvec3 bounce_groups;
    uint pad5;
    uvec3 account_groups;
    uint pad6;
};
