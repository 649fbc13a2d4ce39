#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include <candela/ecs/world_reader.hpp>
#include <candela/graph/frame_graph.hpp>
#include <candela/scene/components.hpp>
#include <candela/view.hpp>
#include <candela/workload.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/gpu/gpu_types.hpp"

namespace candela {

/// What the names of the passes and resources of view number `index` of a frame end with: nothing, " 2", ...
[[nodiscard]] std::string view_ending(std::size_t index);

/// The view that the host asks for.
struct ViewRequest {
    Entity camera;           ///< an entity with a Camera
    glm::uvec2 size{1};      ///< of the rendered picture, pixels
    glm::vec2 jitter{0.0F};  ///< pixels by which samples move off the pixel centres, +x right, +y up
    bool operator==(const ViewRequest&) const = default;
};

/// The view that the host asks for. Throws EntityError if `request.camera` is not alive or has no Camera, and
/// SceneError if its parents form a cycle or were destroyed, or if the camera or its matrix has a fault.
[[nodiscard]] CameraView requested_view(const WorldReader& world, const ViewRequest& request);
/// Declares the reads of a pass that calls requested_view.
void read_request(Pass& pass, ValueHandle<ViewRequest> request);

/// The same for all views.
[[nodiscard]] std::vector<CameraView> requested_views(const WorldReader& world,
                                                      const std::vector<ViewRequest>& requests);
void read_requests(Pass& pass, ValueHandle<std::vector<ViewRequest>> requests);

/// Adds node `view` (CPU): the requested view. Depends on the request, Camera and Transform.
[[nodiscard]] ValueHandle<CameraView> add_view(FrameGraph& graph, ValueHandle<ViewRequest> request);

/// What passes read of the view that they render, on the CPU and in shaders.
struct ViewData {
    ValueHandle<CameraView> camera;
    BufferHandle<gpu::ViewConstants> constants;
    glm::uvec2 size{1};                    ///< of the rendered picture, pixels
    Workload workload = Workload::pixels;  ///< of passes that find its surfaces
};

/// Adds node `view-upload` (CPU, then upload): the constants in shaders/view/view.glsl, for a picture of
/// `size` pixels. Depends on `camera`.
[[nodiscard]] ViewData add_view_upload(FrameGraph& graph, const Gpu& gpu, ValueHandle<CameraView> camera,
                                       glm::uvec2 size);

/// For a pass whose shader includes view.glsl.
void read_view(Pass& pass, const ViewData& view);

}  // namespace candela
