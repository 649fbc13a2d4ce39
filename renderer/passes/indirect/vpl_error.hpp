#pragma once

#include <span>

#include <glm/vec4.hpp>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/indirect/vpl_light.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Light of all VPLs at SAMPLE_COLUMNS × SAMPLE_ROWS pixels, spread evenly over the picture, row by row: π
/// times the irradiance, in lux or W/m²; alpha is 1 where there is a surface, else 0.
using VplSamples = BufferHandle<glm::vec4>;

/// The light of the VPLs of a frame, and that of another set of as many VPLs, whose visibility is exact.
struct VplErrorSamples {
    VplSamples shown;
    VplSamples other;
};

/// Adds nodes `vpl-samples` and `vpl-samples-other` (compute). They depend on the VPLs, depth and normal of
/// the surfaces, and the view.
[[nodiscard]] VplErrorSamples add_vpl_error(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                            const VplLight& shown, const VplLight& other,
                                            const ViewData& view);

/// The relMSE of `shown`: VplReport::estimated_error. See shaders/README.md, "Error of a set of VPLs".
[[nodiscard]] double estimated_error(std::span<const glm::vec4> shown, std::span<const glm::vec4> other);

}  // namespace candela
