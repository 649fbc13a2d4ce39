#pragma once

#include <cstdint>
#include <memory>

#include <candela/scene/components.hpp>
#include "engine/bvh/box.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/scene/buffer_ranges.hpp"
#include "renderer/passes/scene/use_cache.hpp"

namespace candela {

/// A primitive in the vertex and index buffers.
struct UploadedPrimitive {
    std::shared_ptr<const Mesh> mesh;  ///< keeps the primitive alive
    const Primitive* primitive = nullptr;
    Box bounds;                   ///< local space
    glm::vec3 mean_colour{0.0F};  ///< of its vertices, linear
    BufferRange vertices;
    BufferRange indices;
};

/// The distinct primitives of the scenes, one after the other, in the vertex and index buffers. What two
/// successive scenes share is uploaded once.
class MeshTable {
 public:
    /// Starts another scene. After that, `add` its primitives and `upload` them.
    void begin() { primitives_.begin(); }
    /// Adds a primitive of the scene; returns its number.
    std::uint32_t add(const std::shared_ptr<const Mesh>& mesh, const Primitive& primitive);
    /// Uploads what is new, and forgets what is no longer used.
    void upload(const Gpu& gpu, Execution& run, BufferHandle<Vertex> vertices,
                BufferHandle<std::uint32_t> indices);

    /// A primitive by its number.
    [[nodiscard]] const UploadedPrimitive& operator[](std::uint32_t number) const {
        return primitives_[number];
    }
    /// Draws one instance of a primitive that is uploaded.
    [[nodiscard]] gpu::DrawCommand draw(std::uint32_t number, std::uint32_t instance) const;

 private:
    UseCache<Primitive, UploadedPrimitive> primitives_;
    std::uint32_t vertices_end_ = 0;  // see place_ranges
    std::uint32_t indices_end_ = 0;
};

}  // namespace candela
