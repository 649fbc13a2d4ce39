#pragma once

#include <optional>
#include <span>

#include <candela/extension.hpp>

#include "renderer/frame/build_frame.hpp"
#include "renderer/passes/indirect/vpl_light.hpp"
#include "renderer/passes/shading/lighting.hpp"
#include "renderer/passes/sky/sky.hpp"

namespace candela {

/// The scene and what lights it, independent of the view.
struct LitScene {
    SceneData scene;
    Tracing tracing;
    SceneLights lights;
    std::optional<Sky> sky;
};

/// The light of the VPLs, for all views.
struct SharedVpls {
    VplLight light;
    BufferHandle<std::uint32_t> order;  ///< see add_vpl_order
    std::uint32_t count = 0;            ///< about how many there are
    std::optional<VplLight> other{};    ///< of another set, to compare with; none if no view asks for it
};

/// What the views of a frame have in common.
struct SharedFrame {
    const Configuration& configuration;
    const FrameContents& contents;
    const Quality& quality;
    const LitScene& lit;
    const std::optional<SharedVpls>& vpls;
    std::span<const Extension> extensions;
};

/// What lights points that are no surfaces of a view.
[[nodiscard]] Lighting lighting_of_points(const Configuration& configuration, const LitScene& lit,
                                          const std::optional<SharedVpls>& vpls);

/// Declares the passes of view number `index`, from its camera to its target. Sets the results in `out`.
void build_view(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared, const ViewShape& shape,
                std::size_t index, ViewHandles& out);

/// Adds node `keep`, if anything is to be kept: it reads those parts, and does nothing with them, so that
/// their content stays until the end of the frame. To be declared after the passes of all views.
void keep_parts(FrameGraph& graph, const FrameParts& keep, const ViewHandles& view);

}  // namespace candela
