#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <candela/scene/components.hpp>
#include "engine/bvh/box.hpp"
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/material_upload.hpp"
#include "renderer/passes/scene/scene_layout.hpp"
#include "renderer/passes/scene/use_cache.hpp"

namespace candela {

/// The box around the vertices; at the origin if there are none.
[[nodiscard]] Box box_around(std::span<const Vertex> vertices);

/// The meshes in use, in the vertex and index buffers, and the vertices of drawables that are deformed.
class MeshTable {
 public:
    using Primitives = std::vector<std::shared_ptr<const DrawnPrimitive>>;

    /// Counts one more use of a mesh. Returns its primitives; their materials are in the table from then on.
    const Primitives& take(const std::shared_ptr<const Mesh>& mesh, MaterialTable& materials);
    /// Ends one use. Without any, the mesh and its materials are forgotten by drop_unused.
    void release(const Mesh& mesh) { meshes_.release(&mesh); }
    void drop_unused(MaterialTable& materials);

    /// Adds vertices in place of those of a drawable's primitive.
    void add_deformed(std::uint32_t drawable, const DrawnPrimitive& drawn);
    void remove_deformed(std::uint32_t drawable);

    /// Uploads what is new, and deformed vertices that have changed. Returns whether anything has got another
    /// place than before.
    bool upload(const Gpu& gpu, Execution& run, BufferHandle<Vertex> vertices,
                BufferHandle<std::uint32_t> indices, const SceneLayout& layout,
                const Deformations& deformations);

    /// The command that draws one instance of a drawable with this number, after `upload`.
    [[nodiscard]] gpu::DrawCommand draw(std::uint32_t number, const DrawnPrimitive& drawn) const;

 private:
    struct Ranges {
        BufferRange vertices;
        BufferRange indices;
    };
    struct Uploaded {
        std::shared_ptr<const Mesh> mesh;
        Primitives primitives;
        std::vector<Ranges> ranges{};  // by primitive
    };
    /// The deformed vertices of a drawable.
    struct Deformed {
        std::shared_ptr<const DeformedMesh::Vertices> vertices;  // that are uploaded
        BufferRange range;
    };

    UseCache<const Mesh*, Uploaded> meshes_;
    std::map<std::uint32_t, Deformed> deformed_;  // by drawable
    RangePlaces vertex_places_;
    RangePlaces index_places_;
};

}  // namespace candela
