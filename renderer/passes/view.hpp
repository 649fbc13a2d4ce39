#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/ecs/world.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/scene/components.hpp"
#include "renderer/gpu.hpp"
#include "renderer/gpu_types.hpp"

namespace candela {

/// What the host asks of a frame.
struct ViewRequest {
    Entity camera;           ///< an entity with a Camera
    glm::uvec2 size{1};      ///< pixels
    glm::vec2 jitter{0.0F};  ///< pixels by which samples move off their pixels' centres, +x right, +y up
    bool operator==(const ViewRequest&) const = default;
};

/// Matrices of the viewpoint. Clip space is the GL's with depth in [0, 1], reversed: 1 at the near plane.
/// View space has the eye at its origin and looks along -z; "depth" in metres is -z there.
struct CameraView {
    glm::mat4 clip_from_world{1.0F};
    glm::mat4 world_from_clip{1.0F};
    glm::mat4 view_from_world{1.0F};
    glm::mat4 clip_from_view{1.0F};
    glm::vec3 eye{0.0F};  ///< world space, metres
    bool orthographic = false;
    bool operator==(const CameraView&) const = default;
};

/// View of the camera with this local-to-world matrix. An infinite far plane is one.
[[nodiscard]] CameraView make_view(const Camera& camera, const glm::mat4& world_from_camera,
                                   const ViewRequest& request);

/// View that the host asks for. Throws EntityError if the requested camera is none.
[[nodiscard]] CameraView requested_view(const World& world, const ViewRequest& request);
/// What a pass reads that calls it.
void read_request(Pass& pass, ValueHandle<ViewRequest> request);

/// Sample i within a pixel, in pixels from its centre, within [-0.5, 0.5]. Sample 0 is the centre; 2k - 1 and
/// 2k lie opposite each other, at point k of the sequence R2, so that a mean over samples does not shift the
/// picture.
[[nodiscard]] glm::vec2 pixel_sample(std::uint32_t i);

/// Node `view` (CPU).
[[nodiscard]] ValueHandle<CameraView> add_view(FrameGraph& graph, ValueHandle<ViewRequest> request);

/// The view that a frame is drawn for.
struct FrameView {
    ValueHandle<CameraView> camera;
    BufferHandle<gpu::ViewConstants> constants;
};

/// Node `view-upload`: the view for shaders, with a target of `size` pixels.
[[nodiscard]] FrameView add_view_upload(FrameGraph& graph, const Gpu& gpu, ValueHandle<CameraView> camera,
                                        glm::uvec2 size);

/// For a pass whose shader includes view.glsl: declares what that reads, and binds it when the pass runs.
void read_view(Pass& pass, const FrameView& view);
void bind_view(const Gpu& gpu, Execution& run, const FrameView& view);

}  // namespace candela
