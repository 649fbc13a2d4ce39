// Binding points and limits, shared by GLSL and C++.

#define BINDING_INSTANCES 0
#define BINDING_MATERIALS 1
#define BINDING_LIGHTS 2
#define BINDING_SHADOWS 3
#define BINDING_VPLS 4
#define BINDING_BVH_NODES 5
#define BINDING_TRIANGLES 6
#define BINDING_TEXELS 7
#define BINDING_PATHS 8
#define BINDING_PATH_WEIGHTS 9
#define BINDING_FLUX 10
#define BINDING_LIST_FIRST 11
#define BINDING_LIST_COUNT 12
#define BINDING_LIST_ENTRIES 13
#define BINDING_DIRECT_POINTS 14
#define BINDING_LAST 14
// Where lists are culled no meshes are drawn.
#define BINDING_TILE_DEPTHS BINDING_INSTANCES
// Where light is traced there are no lists.
#define BINDING_VPL_RECORDS BINDING_LIST_FIRST
// Surfels are lit without paths, and shaded with them.
#define BINDING_SURFELS BINDING_INSTANCES
#define BINDING_SURFEL_ROWS BINDING_LIGHTS
#define BINDING_CELL_POINTS BINDING_PATHS
#define BINDING_LIT_POINTS BINDING_PATH_WEIGHTS
#define BINDING_CELL_LIGHT BINDING_FLUX
#define BINDING_FLUX_ACCOUNT BINDING_BVH_NODES
#define BINDING_SEEN_POINTS BINDING_LIST_ENTRIES
#define BINDING_FORM_FACTORS BINDING_LIST_FIRST
#define BINDING_COVER BINDING_LIST_COUNT
#define BINDING_BOUNCE BINDING_LIST_ENTRIES
// Nor where VPLs are gathered.
#define BINDING_VPL_ORDER BINDING_LIST_FIRST
#define BINDING_LACKING_MASK BINDING_LIST_COUNT
#define BINDING_LACKING BINDING_LIST_ENTRIES

#define UNIFORMS_VIEW 0
#define UNIFORMS_CELLS 1
#define UNIFORMS_VPLS 2
#define UNIFORMS_LIGHTS 3
#define UNIFORMS_LAST 3

#define UNIT_BASE_COLOUR 0
#define UNIT_SHADOW_CUBES 1
#define UNIT_SHADOW_MAPS 2
#define UNIT_ALBEDO 3
#define UNIT_NORMAL 4
#define UNIT_DEPTH 5
#define UNIT_RADIANCE 6
#define UNIT_VPL_MAPS 7
#define UNIT_MEAN 8
#define UNIT_INDIRECT 9
#define UNIT_LAST 9

#define IMAGE_RADIANCE 0
#define IMAGE_INDIRECT 0
#define IMAGE_LAST 0

#define ATTRIBUTE_POSITION 0
#define ATTRIBUTE_NORMAL 1
#define ATTRIBUTE_UV 2
#define ATTRIBUTE_INSTANCE 3

#define BVH_STACK_SIZE 48

#define PIXEL_BLOCK 16      // pixels along an edge of what a work group shades: pixel_block.glsl
#define RECONSTRUCT_GROUP 64  // pixels of a row that a work group reconstructs
#define LIST_GROUP 256      // invocations of the one work group that lists pixels
#define FILL_GROUP 64       // pixels that a work group asks VPLs for
#define SURFEL_GROUP 64     // surfels, points or pairs of them that a work group lights
#define COVER_RAYS 16       // that an invocation casts to find how much of a hemisphere is covered
#define COVER_PARTS 16      // invocations a surfel
#define MOST_COLUMNS 2048   // surfels that another one gathers from
#define MOST_CHANGED_BOXES 8  // that passes are told of; more are told as one
