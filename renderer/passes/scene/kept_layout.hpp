#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "renderer/passes/scene/draw_order.hpp"
#include "renderer/passes/scene/material_upload.hpp"
#include "renderer/passes/scene/mesh_upload.hpp"
#include "renderer/passes/scene/scene_layout.hpp"

namespace candela {

/// The layout of the scene with its meshes and materials on the GPU, kept from frame to frame: an update
/// takes time in proportion to what comes and goes.
class KeptLayout {
 public:
    struct Buffers {
        BufferHandle<Vertex> vertices;
        BufferHandle<std::uint32_t> indices;
        BufferHandle<gpu::Material> materials;
        BufferHandle<std::uint32_t> texels;
    };

    explicit KeptLayout(Gpu& gpu) : gpu_(&gpu), materials_(gpu) {}

    /// Makes the layout that of the items, and uploads what it needs. Returns whether the layout has changed.
    [[nodiscard]] bool update(Execution& run, const Buffers& buffers, const SceneGeometry& geometry,
                              const Deformations& deformed);

    [[nodiscard]] const SceneLayout& layout() const { return layout_; }

 private:
    using Drawable = SceneLayout::Drawable;

    /// What determines the drawing order besides the entities. One call draws all drawables with equal keys,
    /// unless they are blended.
    struct GroupKey {
        AlphaMode alpha;
        bool double_sided;
        bool mirrored;
        bool emits;
        MaterialImages images;

        [[nodiscard]] auto order() const { return std::tie(alpha, double_sided, mirrored, emits, images); }
        [[nodiscard]] bool operator<(const GroupKey& other) const { return order() < other.order(); }
    };
    struct Group {
        DrawOrder::Group places;
        std::shared_ptr<const MaterialBinding> material;
    };
    using Groups = std::map<GroupKey, Group>;

    void follow(const SceneGeometry& geometry);
    void add(const SceneGeometry& geometry, std::uint32_t item);
    void remove(const SceneGeometry::Item& item, std::uint32_t first);
    void move(std::uint32_t first, std::uint32_t item);
    [[nodiscard]] std::uint32_t take_number();
    [[nodiscard]] Groups::iterator group_of(const DrawnPrimitive& drawn, bool mirrored);
    void drop_unused();
    void set_draws(bool all);
    void list_groups();

    Gpu* gpu_;
    SceneLayout layout_;
    MaterialTable materials_;
    MeshTable meshes_;
    DrawOrder order_;
    Groups groups_;
    std::vector<std::uint32_t> free_;  // numbers of drawables
};

}  // namespace candela
