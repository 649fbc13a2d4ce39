// Binding points and limits, shared by GLSL and C++.

#define BINDING_INSTANCES 0
#define BINDING_MATERIALS 1
#define BINDING_LIGHTS 2
#define BINDING_SHADOWS 3
#define BINDING_TRACED_VPLS 4
#define BINDING_FLUX_ACCOUNT 5
#define BINDING_CHANGED_BOXES 6
#define BINDING_TEXELS 7
#define BINDING_PATHS 8
#define BINDING_PATH_WEIGHTS 9
#define BINDING_FLUX 10
#define BINDING_LIST_FIRST 11
#define BINDING_LIST_COUNT 12
#define BINDING_LIST_ENTRIES 13
#define BINDING_LIT_EMITTERS 14
#define BINDING_LAST 14
// The names below reuse a number where no pass needs both buffers.
// Passes that cull light lists draw no meshes.
#define BINDING_TILE_DEPTHS BINDING_INSTANCES
// Passes that trace VPLs read no light lists.
#define BINDING_VPL_RECORDS BINDING_LIST_FIRST
// A frame has traced VPLs or surfels.
#define BINDING_LIT_SURFELS BINDING_TRACED_VPLS
// Passes that light surfels, or shade with them, use no paths and draw no meshes.
#define BINDING_SURFELS BINDING_INSTANCES
#define BINDING_SURFEL_ROWS BINDING_LIGHTS
#define BINDING_CELL_POINTS BINDING_PATHS
#define BINDING_LIT_POINTS BINDING_PATH_WEIGHTS
#define BINDING_CELL_LIGHT BINDING_FLUX
#define BINDING_DIRECT_POINTS BINDING_LIST_COUNT
#define BINDING_FORM_FACTORS BINDING_LIST_FIRST
#define BINDING_COVER BINDING_LIST_COUNT
#define BINDING_BOUNCE BINDING_LIST_ENTRIES
// Passes that trace rays between surfels, or in their depth maps, light nothing.
#define BINDING_KEPT_SURFELS BINDING_SHADOWS
#define BINDING_LAST_FORM_FACTORS BINDING_TRACED_VPLS
#define BINDING_LAST_COVER BINDING_PATH_WEIGHTS
#define BINDING_LISTED_SURFELS BINDING_FLUX
#define BINDING_SURFEL_TASKS BINDING_LIST_ENTRIES
#define BINDING_MAP_TASKS BINDING_SHADOWS
#define BINDING_SEEN_SURFELS BINDING_SHADOWS
#define BINDING_GUIDE BINDING_LIST_ENTRIES
#define BINDING_KEPT_POINTS BINDING_LIST_FIRST
#define BINDING_LAST_POINTS BINDING_LIST_ENTRIES
// Passes that gather VPLs read no light lists.
#define BINDING_VPL_ORDER BINDING_LIST_FIRST
#define BINDING_FILL_MASK BINDING_LIST_COUNT
#define BINDING_FILL_LIST BINDING_LIST_ENTRIES
#define BINDING_VPL_SAMPLES BINDING_LIST_FIRST
#define BINDING_RECEIVERS BINDING_LIST_FIRST
#define BINDING_RECEIVED BINDING_LIST_COUNT
// Passes that inspect resources read light lists, but draw no meshes.
#define BINDING_INSPECTED_RANGES BINDING_INSTANCES
#define BINDING_INSPECTED_HISTOGRAM BINDING_MATERIALS
#define BINDING_INSPECTED_TEXEL BINDING_MATERIALS
// Passes that expose the picture read no other buffer.
#define BINDING_EXPOSURE BINDING_INSTANCES

#define MOST_STORAGE_BLOCKS 9  // of a program: blended surfaces, with light lists, surfels and rays

#define UNIFORMS_VIEW 0
#define UNIFORMS_CELLS 1
#define UNIFORMS_VPLS 2
#define UNIFORMS_LIGHTS 3
#define UNIFORMS_SKY 4
#define UNIFORMS_LAST 4

#define UNIT_BASE_COLOUR 0
#define UNIT_SHADOW_CUBES 1
#define UNIT_SHADOW_MAPS 2
#define UNIT_ALBEDO 3
#define UNIT_NORMAL 4
#define UNIT_DEPTH 5
#define UNIT_RADIANCE 6
#define UNIT_VPL_MAPS 7
#define UNIT_VPL_SLOPES 8
#define UNIT_BVH_NODES 9
#define UNIT_TRIANGLES 10
#define UNIT_LIT_SURFELS 11
#define UNIT_LIT_POINTS 12
#define UNIT_MIRROR_SHARES 13
#define UNIT_INDIRECT 14
#define UNIT_BUMPS 15
#define UNIT_LAST 15
// A frame has traced VPLs or surfels.
#define UNIT_TRACED_VPLS UNIT_LIT_SURFELS
// Passes that draw meshes read no G-buffer.
#define UNIT_EMISSION UNIT_ALBEDO
#define UNIT_SKY UNIT_INDIRECT
#define UNIT_METAL_ROUGHNESS UNIT_NORMAL
#define UNIT_NORMAL_MAP UNIT_DEPTH
#define UNIT_OCCLUSION UNIT_RADIANCE
#define UNIT_MIRROR UNIT_BASE_COLOUR
// Passes that read the direction of gathered light evaluate no VPLs.
#define UNIT_INDIRECT_DIRECTION UNIT_VPL_MAPS
// Passes that shade read no picture.
#define UNIT_GLOSS UNIT_RADIANCE
// Passes that add blended surfaces read no G-buffer.
#define UNIT_PART UNIT_BUMPS
// Passes that show what mirrors have found light nothing.
#define UNIT_MIRRORED_ALBEDO UNIT_LIT_SURFELS
#define UNIT_SKY_TREE UNIT_VPL_MAPS
#define UNIT_MIRRORED_PLACE UNIT_SHADOW_CUBES
#define UNIT_MIRRORED_NORMAL UNIT_SHADOW_MAPS
#define UNIT_MIRRORED_SOURCE UNIT_VPL_MAPS
// Passes that show textures read nothing else.
#define UNIT_INSPECTED UNIT_BASE_COLOUR
#define UNIT_FIRST_PICTURE UNIT_RADIANCE
#define UNIT_SECOND_PICTURE UNIT_MIRROR_SHARES
// Passes that enlarge pictures read no materials.
#define UNIT_PICTURE_DEPTH UNIT_ALBEDO
#define UNIT_PICTURE_WEIGHTS UNIT_DEPTH

#define IMAGE_RADIANCE 0
#define IMAGE_INDIRECT 0
#define IMAGE_INSPECTED 0
#define IMAGE_VPL_MAPS 0
#define IMAGE_VPL_SLOPES 1
#define IMAGE_INDIRECT_DIRECTION 1
#define IMAGE_LAST 1

#define ATTRIBUTE_POSITION 0
#define ATTRIBUTE_NORMAL 1
#define ATTRIBUTE_UV 2
#define ATTRIBUTE_INSTANCE 3
#define ATTRIBUTE_COLOUR 4
#define ATTRIBUTE_TANGENT 5
#define ATTRIBUTE_SECOND_UV 6

#define TONE_CURVE_NONE 0u  // tone_curves.glsl
#define TONE_CURVE_FILMIC 1u
#define TONE_CURVE_NEUTRAL 2u
#define TONE_CURVE_ACES 3u

#define BVH_STACK_SIZE 145

#define PIXEL_BLOCK 16      // pixels along an edge of the block that a work group shades: pixel_block.glsl
#define MAP_BLOCK 8         // texels along an edge of the part of a VPL's map that a work group of vpl_maps.comp traces
#define RECONSTRUCT_GROUP 64  // pixels of a row that a work group reconstructs
#define LIST_GROUP 256      // invocations of a work group that lists pixels: vpl_fill_list.comp
#define LIST_WORDS 16       // words of the fill mask that each of them lists
#define FILL_GROUP 64       // pixels that a work group gathers VPLs for: vpl_fill.comp
#define RECEIVER_GROUP 16   // receivers that a work group of receiver_light.comp lights
#define SAMPLE_GROUP 16     // the same in vpl_samples.comp
#define SAMPLE_COLUMNS 24   // of the grid of pixels in vpl_samples.comp
#define SAMPLE_ROWS 18
#define INSPECT_GROUP 64    // invocations of a work group of inspect_range.comp and inspect_histogram.comp: a power of two
#define INSPECT_BINS 64     // parts of the range that inspect_histogram.comp counts the values in
#define EXPOSURE_GROUP 64   // invocations of a work group of exposure.comp: a power of two
#define EXPOSURE_GROUPS 256 // work groups that a picture of any size is shared out to
#define NO_SURFEL 0xffffffffu
#define CULL_GROUP 64       // invocations of a work group in light_*.comp
#define SURFEL_GROUP 64     // invocations of a work group in surfel_*.comp: surfels, cell points or rows
#define BOUNCE_GROUP 32     // the same of surfel_bounce.comp, of a slice: ROWS_A_BOUNCE surfels each
#define BOUNCE_SLICES 16    // invocations of surfel_bounce.comp that share the columns of a surfel, where a device has many
#define BOUNCES_GROUP 512   // the same of surfel_bounces.comp
// Rays that an invocation of surfel_light.comp casts to sources of one kind in a dispatch, at most. Each ray loops over
// nodes of the BVH, and software drivers stop all loops of an invocation after 65,535 iterations in total.
#define MOST_POINT_RAYS 64
#define MOST_CELL_SHARES 16 // of many sources, which the points of a cell divide among them, unless a point's share is too large
#define COVER_RAYS 16       // rays that an invocation of surfel_cover.comp casts
#define COVER_PARTS 16      // invocations of surfel_cover.comp for one surfel
#define COVER_DIRECTIONS 64   // in which pixels find the share of their hemisphere that surfaces cover: vpl_light.glsl
#define MOST_SKY_SUNS 4
#define MOST_SKY_PATCHES 256  // in the uniform block of sky_patch.glsl
#define MOST_COLUMNS 2048   // largest number of surfels that one surfel gathers from
