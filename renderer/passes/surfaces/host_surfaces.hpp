#pragma once

#include <optional>

#include <candela/graph/frame_graph.hpp>
#include <candela/view.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// The host's textures in the frame graph, and how to read them.
struct HostSurfaceInputs {
    TextureHandle depth;  ///< imported, as are the others
    TextureHandle normal;
    TextureHandle albedo;
    std::optional<TextureHandle> material;  ///< none: the surfaces are Lambertian
    ValueHandle<HostSurfaces> description;  ///< imported
};
[[nodiscard]] HostSurfaceInputs import_host_surfaces(FrameGraph& graph, bool material);

/// What the surfaces are once they are checked: see add_host_surfaces_check.
struct CheckedSurfaces {
    bool operator==(const CheckedSurfaces&) const = default;
};

/// Adds node `host-surfaces` (raster): all parts of the surfaces that the host has drawn. Each pixel takes
/// the texel of the host's at its centre. Depends on the host's textures and the view. `glossy`: also what
/// makes them so; the host must have a material. `checked`: none if nothing is checked.
[[nodiscard]] Surfaces add_host_surfaces(FrameGraph& graph, Gpu& gpu, const HostSurfaceInputs& inputs,
                                         const ViewData& view, bool glossy,
                                         std::optional<ValueHandle<CheckedSurfaces>> checked);

}  // namespace candela
