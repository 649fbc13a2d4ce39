#pragma once

#include <optional>
#include <string>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/view/view.hpp"

namespace candela {

/// The visible solid (opaque and masked) surfaces of a view: textures of its size. Depth gives their
/// positions. Parts that no pass needs are missing.
struct Surfaces {
    std::optional<TextureHandle> depth{};  ///< depth32f, reversed; 0 where there is no surface
    /// rg32f, octahedral encoding (Cigolle et al., "A Survey of Efficient Representations for Independent
    /// Unit Vectors", 2014), world space. It is the face normal: see surface.glsl.
    std::optional<TextureHandle> normal{};
    std::optional<TextureHandle> albedo{};  ///< the material's base colour: rgba16f, linear
    /// Of scenes with glossy surfaces: rgba16f, gpu::Material::mirror; and rg16f, roughness and metalness.
    std::optional<TextureHandle> mirror{};
    std::optional<TextureHandle> gloss{};
    /// Of scenes with bumpy surfaces: rgba32f, the shading normal, octahedral, and the share of indirect
    /// light that reaches the surface.
    std::optional<TextureHandle> bumps{};
    bool mirrored = false;  ///< those that glossy surfaces show: MirroredSurfaces
};

/// What shaders know about the materials of surfaces, besides the albedo.
struct MaterialParts {
    bool glossy = false;  ///< they reflect light in the mirror direction, too: shaders/shading/gloss.glsl
    bool bumpy = false;   ///< they have a shading normal, and occlusion
    bool operator==(const MaterialParts&) const = default;
};
/// What the textures of the surfaces contain.
[[nodiscard]] inline MaterialParts parts_of(const Surfaces& surfaces) {
    return {.glossy = surfaces.gloss.has_value(), .bumpy = surfaces.bumps.has_value()};
}
/// Names to define in those shaders.
[[nodiscard]] std::vector<std::string> material_variant(MaterialParts parts);

/// Names to define in shaders that include visible_surface.glsl.
[[nodiscard]] std::vector<std::string> surface_variant(const Surfaces& surfaces,
                                                       std::vector<std::string> others = {});
/// The same for compute shaders that also include shading/pixel_block.glsl.
[[nodiscard]] std::vector<std::string> block_variant(const gl::Limits& limits, const Surfaces& surfaces,
                                                     std::vector<std::string> others);

/// Declares the depth of the view as an attachment that `pass` writes.
[[nodiscard]] TextureHandle write_depth(FrameGraph& graph, Pass& pass, const ViewData& view);
/// Depth and normal. Shaders write the normal to location 0.
[[nodiscard]] Surfaces write_geometry(FrameGraph& graph, Pass& pass, const ViewData& view);
/// The same with the albedo, location 1, and what else the materials have, from location 2 on.
[[nodiscard]] Surfaces write_geometry_and_material(FrameGraph& graph, Pass& pass, const ViewData& view,
                                                   MaterialParts parts);

/// For a pass whose shader includes visible_surface.glsl: reads depth and normal.
void read_geometry(Pass& pass, const Surfaces& surfaces);
/// The same with the material, at UNIT_ALBEDO, UNIT_MIRROR, UNIT_GLOSS and UNIT_BUMPS.
void read_geometry_and_material(Pass& pass, const Surfaces& surfaces);

/// Reads the depth for the depth test; the pass does not write it.
void test_depth(Pass& pass, const Surfaces& surfaces);

}  // namespace candela
