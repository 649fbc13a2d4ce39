#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/ecs/world.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/scene/components.hpp"
#include "renderer/gl/program.hpp"

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
void read_view(Pass& pass, ValueHandle<ViewRequest> request);

/// Sets the uniforms by which shaders go between pixels and the world.
void bind_view(const gl::Program& program, const CameraView& view, glm::uvec2 size);

/// Sample i within a pixel, in pixels from its centre, within [-0.5, 0.5]. Sample 0 is the centre; 2k - 1 and
/// 2k lie opposite each other, at point k of the sequence R2 (Roberts, "The Unreasonable Effectiveness of
/// Quasirandom Sequences", 2018), so that a mean over samples does not shift the picture.
[[nodiscard]] glm::vec2 pixel_sample(std::uint32_t i);

/// Node `view` (CPU).
[[nodiscard]] ValueHandle<CameraView> add_view(FrameGraph& graph, ValueHandle<ViewRequest> request);

}  // namespace candela
