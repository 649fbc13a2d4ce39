#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/bvh/bvh.hpp"
#include "shaders/bindings.glsl"

/// The structs that shaders read, with the memory layout of std430, or std140 for uniform blocks. Their GLSL
/// twins in shaders/types.glsl document the meaning and unit of each member.
namespace candela::gpu {

struct Instance {
    glm::vec4 world[3];
    std::uint32_t material;
    std::uint32_t pad0 = 0;
    std::uint32_t pad1 = 0;
    std::uint32_t pad2 = 0;
};

enum MaterialFlags : std::uint32_t { double_sided = 1, wrap_u_shift = 1, wrap_v_shift = 3 };

struct Material {
    glm::vec4 base_colour;
    std::uint32_t first_texel = 0;
    std::uint32_t texel_width = 0;
    std::uint32_t texel_height = 0;
    std::uint32_t flags = 0;
    float alpha_cutoff = 0.0F;
    float pad0 = 0.0F;
    float pad1 = 0.0F;
    float pad2 = 0.0F;
};

enum class LightKind : std::uint32_t { point, spot, directional };

struct Light {
    glm::vec3 position{0.0F};
    LightKind kind = LightKind::point;
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
    float range = 0.0F;
    glm::vec3 intensity{0.0F};
    std::int32_t shadow = -1;
    glm::vec2 shape{0.0F};
    float cos_inner = 0.0F;
    float cos_outer = 0.0F;
    bool operator==(const Light&) const = default;
};

struct LightConstants {
    std::uint32_t count;
    std::uint32_t pad0 = 0;
    std::uint32_t pad1 = 0;
    std::uint32_t pad2 = 0;
};

enum class ShadowKind : std::uint32_t { cube, perspective, orthographic };

struct Shadow {
    glm::mat4 from_world{1.0F};
    glm::vec3 axis{0.0F};
    float texel = 0.0F;
    float near_plane = 0.0F;
    std::uint32_t layer = 0;
    ShadowKind kind = ShadowKind::cube;
    std::uint32_t pad0 = 0;
    bool operator==(const Shadow&) const = default;
};

struct ViewConstants {
    glm::mat4 clip_from_world;
    glm::mat4 world_from_clip;
    glm::mat4 view_from_world;
    glm::vec2 target_size;
    glm::vec2 ray_scale;
    glm::vec2 ray_shift;
    glm::vec2 depth_terms;
    std::uint32_t orthographic;
    std::uint32_t pad0 = 0;
    std::uint32_t pad1 = 0;
    std::uint32_t pad2 = 0;
};

struct CellConstants {
    glm::uvec2 tiles;
    glm::uvec2 target_size;
    std::uint32_t slices;
    std::uint32_t tile_size;
    float first_depth;
    float depth_ratio;
};

struct TileDepth {
    float nearest;
    float farthest;
    std::uint32_t mask;
    std::uint32_t pad0;
};

struct Vpl {
    glm::vec3 position;
    std::uint32_t map;
    glm::vec3 normal;
    float radius2;
    glm::vec3 flux;
    std::uint32_t first_point;
    glm::vec3 edges_up;
    std::uint32_t point_count;
    glm::vec3 edges_down;
    float area;
    glm::vec3 map_origin;
    float pad0;
};

struct CellPoint {
    glm::vec3 position;
    std::uint32_t material;
    glm::vec3 normal;
    float area;
    glm::vec2 uv;
    std::uint32_t surfel;
    std::uint32_t pad0;
};

struct DirectPoint {
    glm::vec3 arriving;
    float area;
    glm::vec3 albedo;
    float pad0;
};

struct LitPoint {
    glm::vec3 position;
    float area;
    glm::vec3 normal;
    float pad0;
    glm::vec3 flux;
    float pad1;
};

struct CellLight {
    glm::vec3 centre;
    float radius2;
    glm::vec3 arriving;
    float pad2;
    glm::vec3 direct;
    float pad0;
    glm::vec3 albedo;
    float area;
    glm::vec3 indirect;
    float pad1;
};

struct VplConstants {
    std::uint32_t count;
    float radius2;
    float crease_slack;
    float ray_offset;
    std::uint32_t map_resolution;
    std::uint32_t map_tiles;
    float map_side;
    float map_inverse_reach;
};

using BvhNode = candela::BvhNode;

struct TraceTriangle {
    glm::vec3 a;
    std::uint32_t material;
    glm::vec3 edge_ab;
    std::uint32_t id;
    glm::vec3 edge_ac;
    std::uint32_t masked = 0;
    glm::vec2 uv_a;
    glm::vec2 uv_b;
    glm::vec2 uv_c;
    glm::vec2 pad1{0.0F};
};

struct Path {
    glm::vec3 flux;
    std::uint32_t light;
    std::uint32_t index;
    std::uint32_t seed;
    std::uint32_t first_vpl;
    std::uint32_t vpl_count;
    bool operator==(const Path&) const = default;
};

enum class VplState : std::uint32_t { placed, escaped };

struct VplRecord {
    glm::vec3 position;
    VplState state;
    glm::vec3 normal;
    float pad0;
    glm::vec3 throughput;
    float pad1;
};

struct FluxAccount {
    glm::vec3 emitted;
    std::uint32_t spent;
    glm::vec3 absorbed;
    float pad1;
    glm::vec3 escaped;
    float pad2;
    glm::vec3 truncated;
    float pad3;
    glm::vec3 roulette;
    float pad4;
};

/// Arguments of glMultiDrawElementsIndirect, in the layout that OpenGL defines.
struct DrawCommand {
    std::uint32_t index_count;
    std::uint32_t instance_count;
    std::uint32_t first_index;
    std::int32_t base_vertex;
    std::uint32_t base_instance;
};

static_assert(BVH_STACK_SIZE >= bvh_max_depth);

}  // namespace candela::gpu
