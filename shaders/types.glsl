// Structs that the GPU and the CPU both see; their twins are in renderer/gpu_types.hpp.
// Layout std430; a test compares every offset and stride with what the driver reports.

struct Instance {
    vec4 world[3];  // rows of the local-to-world matrix
    uint material;
    uint pad0;
    uint pad1;
    uint pad2;
};

struct Material {
    vec4 base_colour;     // linear
    uint first_texel;     // of its reduced base-colour image in the texel buffer
    uint texel_width;     // 0: no texture
    uint texel_height;
    uint flags;           // MATERIAL_*
    float alpha_cutoff;   // where alpha is below it there is no surface; 0: there always is one
    float pad0;
    float pad1;
    float pad2;
};

#define MATERIAL_DOUBLE_SIDED 1u
#define MATERIAL_WRAP_U_SHIFT 1u
#define MATERIAL_WRAP_V_SHIFT 3u
#define MATERIAL_WRAP_MASK 3u

struct Light {
    vec3 position;   // metres; directional: centre of the footprint, outside the scene
    uint kind;       // LIGHT_*
    vec3 direction;  // unit, the way the light travels
    float range;     // metres
    vec3 intensity;  // candela; directional: lux
    int shadow;      // index into the shadows, -1: none
    vec2 shape;      // spot: scale and offset of the cone's falloff; directional: half extents of the footprint
    float cos_inner;
    float cos_outer;
};

// What all lights have in common. A uniform block: shaders/light_list.glsl.
struct LightConstants {
    uint count;  // of lights that are shown
    uint pad0;
    uint pad1;
    uint pad2;
};

#define LIGHT_POINT 0u
#define LIGHT_SPOT 1u
#define LIGHT_DIRECTIONAL 2u

struct Shadow {
    mat4 from_world;  // to clip space; unused by cubes
    vec3 axis;        // the map's viewing direction; unused by cubes
    float texel;      // width of a texel at unit distance (tangent units); directional: metres
    float near_plane; // metres, of perspective maps
    uint layer;       // of the map array, or cube of the cube array
    uint kind;        // SHADOW_*
    uint pad0;
};

#define SHADOW_CUBE 0u
#define SHADOW_PERSPECTIVE 1u
#define SHADOW_ORTHOGRAPHIC 2u

// The viewpoint, and what is drawn for it. A uniform block: shaders/view.glsl.
struct ViewConstants {
    mat4 clip_from_world;
    mat4 world_from_clip;
    mat4 view_from_world;
    vec2 target_size;    // pixels
    vec2 ray_scale;      // view-space x and y at depth 1 (orthographic: at any) of ndc - ray_shift
    vec2 ray_shift;
    vec2 depth_terms;    // a and b of window depth = a·z + b (orthographic), -a + b / depth (perspective)
    uint orthographic;   // 1: it is
    uint pad0;
    uint pad1;
    uint pad2;
};

// The grid of cells that the view is cut into; CellGrid in renderer/passes/light_bins.hpp says more. A uniform block:
// shaders/light_cells.glsl.
struct CellConstants {
    uvec2 tiles;         // cells across and up
    uvec2 target_size;   // pixels
    uint slices;
    uint tile_size;      // pixels
    float first_depth;   // metres: end of slice 0
    float depth_ratio;   // of the ends of neighbouring slices
};

// Of the surfaces in a screen tile.
struct TileDepth {
    float nearest;   // metres; beyond `farthest` where there is no surface
    float farthest;
    uint mask;       // which of 32 slices between the two have surfaces
    uint pad0;
};

struct Vpl {
    vec3 position;     // metres, on the surface
    uint map;          // tile of its depth map in the atlas
    vec3 normal;       // unit; it emits into this half-space
    float radius2;     // m², of the disc that shines; of surfels
    vec3 flux;         // reflected flux, lm or W as the lights have it; zero: not alive
    uint first_point;  // of its cell, of surfels
    vec3 edges_up;     // 1/m, of its surface along +x, +y, +z, 0 where none is near: vpl_edges.glsl; of traced ones
    uint point_count;  // of its cell
    vec3 edges_down;   // along -x, -y, -z
    float area;        // m², of its cell
    vec3 map_origin;   // metres, on the surface: where its depth map is drawn
    float pad0;
};

// A point of a surfel's cell, which stands for a part of the surface.
struct CellPoint {
    vec3 position;  // metres
    uint material;
    vec3 normal;    // unit
    float area;     // m²
    vec2 uv;
    uint surfel;    // whose cell it is of
    uint pad0;
};

// What a point of a cell has of the lights.
struct DirectPoint {
    vec3 arriving;  // flux
    float area;     // m²; 0: a hole in a mask, or what the surfel does not see
    vec3 albedo;
    float pad0;
};

// A point of a cell with all its light.
struct LitPoint {
    vec3 position;  // metres
    float area;     // m²
    vec3 normal;    // unit
    float pad0;
    vec3 flux;      // reflected
    float pad1;
};

// What a surfel's cell as a whole has of the lights, and of other surfels.
struct CellLight {
    vec3 centre;    // metres: where the lights' flux comes from, in the mean
    float radius2;  // m², of a disc as wide as that
    vec3 arriving;  // flux of the lights
    float pad2;
    vec3 direct;    // what it reflects of that
    float pad0;
    vec3 albedo;    // in the mean of its points
    float area;     // m², of its points that are no holes
    vec3 indirect;  // irradiance from the other surfels, of all bounces together
    float pad1;
};

// What all VPLs have in common. A uniform block: shaders/vpl_constants.glsl.
struct VplConstants {
    uint count;
    float radius2;            // m²: nearer than its root a VPL lights no more than from there
    float crease_slack;       // metres: by so many a surface behind a VPL's plane still counts as before it
    float ray_offset;         // metres, off a surface: where rays and depth maps start
    uint map_resolution;      // texels along a side of a tile of the atlas
    uint map_tiles;           // along a side of a layer
    float map_side;           // texels along a side of a layer
    float map_inverse_reach;  // 1/m: where depth is 0
};

struct BvhNode {
    vec3 lower;
    uint first;
    vec3 upper;
    uint count;
};

struct TraceTriangle {
    vec3 a;
    uint material;
    vec3 edge_ab;
    uint id;  // in the caller's numbering
    vec3 edge_ac;
    uint masked;  // 1: the material's mask may have holes in it
    vec2 uv_a;
    vec2 uv_b;
    vec2 uv_c;
    vec2 pad1;
};

struct Path {
    vec3 flux;       // of its light
    uint light;
    uint index;      // within the light's sequence
    uint seed;       // of the light's sequence
    uint first_vpl;  // of its bounces
    uint vpl_count;  // bounces that the path may make, at least 1
};

// A bounce without its flux.
struct VplRecord {
    vec3 position;    // metres; escaped: where the segment began
    uint state;       // VPL_*
    vec3 normal;      // unit; escaped: the segment's direction
    float pad0;
    vec3 throughput;  // product of the albedos so far, this bounce's included
    float pad1;
};

#define VPL_PLACED 0u
#define VPL_ESCAPED 1u

struct FluxAccount {
    vec3 emitted;
    uint spent;  // of surfels: 1 where too little is left to be gathered once more
    vec3 absorbed;
    float pad1;
    vec3 escaped;
    float pad2;
    vec3 truncated;
    float pad3;
    vec3 roulette;  // lost where the path was ended early, less what its continuation was weighted up by
    float pad4;
};
