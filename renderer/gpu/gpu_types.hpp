#pragma once

#include <cstdint>
#include <cstring>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/bvh/wide.hpp"
#include "shaders/bindings.glsl"

/// What shaders and the CPU share: shaders/types.glsl, compiled as C++.
namespace candela::gpu {

using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;

#include "shaders/types.glsl"

using WideNode = candela::WideNode;

/// Whether two structs are the same, byte for byte: they have no gaps.
template <class T>
[[nodiscard]] bool same_bytes(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}
inline bool operator==(const Light& a, const Light& b) {
    return same_bytes(a, b);
}
inline bool operator==(const Shadow& a, const Shadow& b) {
    return same_bytes(a, b);
}
inline bool operator==(const Path& a, const Path& b) {
    return same_bytes(a, b);
}

/// Arguments of glMultiDrawElementsIndirect, in the layout that OpenGL defines.
struct DrawCommand {
    std::uint32_t index_count;
    std::uint32_t instance_count;
    std::uint32_t first_index;
    std::int32_t base_vertex;
    std::uint32_t base_instance;
    bool operator==(const DrawCommand&) const = default;
};

/// Whether shaders can fetch a buffer of these structs as so many texels each: BufferTexels.
template <class T>
constexpr bool has_texels(std::size_t count) {
    return sizeof(T) == count * sizeof(glm::uvec4);
}
static_assert(has_texels<WideNode>(4) && has_texels<TraceTriangle>(6) && has_texels<TracedVpl>(5) &&
              has_texels<LitSurfel>(5) && has_texels<LitPoint>(3));

static_assert(BVH_STACK_SIZE >= wide_stack_size && INSTANCE_CHILD == instance_child);

}  // namespace candela::gpu
