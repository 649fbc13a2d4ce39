#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <candela/scene/components.hpp>
#include "engine/bvh/box.hpp"
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/scene/use_cache.hpp"

namespace candela {

/// A primitive in the vertex and index buffers.
struct UploadedPrimitive {
    std::shared_ptr<const Mesh> mesh;  ///< keeps the primitive alive
    const Primitive* primitive = nullptr;
    Box bounds;                                       ///< local space
    std::shared_ptr<const std::vector<Box>> parts{};  ///< as in SceneLayout::Drawable
    glm::vec3 mean_colour{0.0F};                      ///< of its vertices, linear
    BufferRange vertices;
    BufferRange indices;
};

/// The box around the vertices; at the origin if there are none.
[[nodiscard]] Box box_around(std::span<const Vertex> vertices);

/// The distinct primitives of the scenes, one after the other, in the vertex and index buffers, and the
/// vertices of those that are deformed. What two successive scenes share is uploaded once.
class MeshTable {
 public:
    /// Starts another scene. After that, `add` its primitives and `upload` them.
    void begin();
    /// Adds a primitive of the scene.
    const UploadedPrimitive& add(const std::shared_ptr<const Mesh>& mesh, const Primitive& primitive);
    /// Adds vertices in place of those of the drawable's primitive. Call in the order of the drawables.
    void add_deformed(const SceneLayout::Drawable& drawable);
    /// Uploads what is new, and forgets what is no longer used. If only deformations have changed, this is
    /// the only call.
    void upload(const Gpu& gpu, Execution& run, BufferHandle<Vertex> vertices,
                BufferHandle<std::uint32_t> indices, const Deformations& deformations);

    /// Commands that draw one instance of each drawable, after `upload`.
    [[nodiscard]] std::vector<gpu::DrawCommand> draws(std::span<const SceneLayout::Drawable> drawables);

 private:
    /// The deformed vertices of a drawable.
    struct Deformed {
        SceneLayout::Drawable drawable;
        std::shared_ptr<const DeformedMesh::Vertices> vertices;  // that are uploaded
        BufferRange range;
    };

    UseCache<Primitive, UploadedPrimitive> primitives_;
    std::vector<Deformed> deformed_;
    std::uint32_t vertices_end_ = 0;  // see place_ranges
    std::uint32_t indices_end_ = 0;
};

}  // namespace candela
