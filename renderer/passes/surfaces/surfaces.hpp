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
    /// Unit Vectors", 2014), world space. It is the face normal and the shading normal: see surface.glsl.
    std::optional<TextureHandle> normal{};
    std::optional<TextureHandle> albedo{};  ///< the material's base colour: rgba16f, linear
    /// Of scenes with glossy surfaces: rgba16f, gpu::Material::mirror; and rg16f, roughness and metalness.
    std::optional<TextureHandle> mirror{};
    std::optional<TextureHandle> gloss{};
    bool mirrored = false;  ///< those that glossy surfaces show: MirroredSurfaces
};

/// Names to define in shaders that include visible_surface.glsl.
[[nodiscard]] std::vector<std::string> surface_variant(const Surfaces& surfaces,
                                                       std::vector<std::string> others = {});

/// Declares the depth of the view as an attachment that `pass` writes.
[[nodiscard]] TextureHandle write_depth(FrameGraph& graph, Pass& pass, const ViewData& view);
/// Depth and normal. Shaders write the normal to location 0.
[[nodiscard]] Surfaces write_geometry(FrameGraph& graph, Pass& pass, const ViewData& view);
/// The same with the albedo, location 1, and if the surfaces may be glossy, with that at 2 and 3.
[[nodiscard]] Surfaces write_geometry_and_material(FrameGraph& graph, Pass& pass, const ViewData& view,
                                                   bool glossy);

/// For a pass whose shader includes visible_surface.glsl: reads depth and normal.
void read_geometry(Pass& pass, const Surfaces& surfaces);
/// The same with the material, at UNIT_ALBEDO, UNIT_MIRROR and UNIT_GLOSS.
void read_geometry_and_material(Pass& pass, const Surfaces& surfaces);

/// Reads the depth for the depth test; the pass does not write it.
void test_depth(Pass& pass, const Surfaces& surfaces);

}  // namespace candela
