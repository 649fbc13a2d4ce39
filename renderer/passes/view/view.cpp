#include "renderer/passes/view/view.hpp"

#include <fmt/format.h>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <candela/graph/execute.hpp>
#include <candela/scene/hierarchy.hpp>
#include "engine/scene/check.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/view/r2_sequence.hpp"

namespace candela {
namespace {

/// How a projection maps view space to x and y of normalised device coordinates: scale · xy / depth + shift,
/// without the division if it is orthographic.
struct Lens {
    glm::vec2 scale;
    glm::vec2 shift{0.0F};
};

Lens lens_of(const Camera& camera, float aspect) {
    switch (camera.projection) {
        case Camera::Projection::orthographic:
            return {{1.0F / (camera.half_height * aspect), 1.0F / camera.half_height}};
        case Camera::Projection::custom: {
            const glm::mat4& m = camera.matrix;
            const glm::vec2 scale(m[0][0], m[1][1]);
            return is_orthographic(camera) ? Lens{scale / m[3][3], glm::vec2(m[3]) / m[3][3]}
                                           : Lens{scale / -m[2][3], glm::vec2(m[2]) / m[2][3]};
        }
        case Camera::Projection::perspective:
            break;
    }
    const float focal = 1.0F / std::tan(camera.vertical_fov * 0.5F);
    return {{focal / aspect, focal}};
}

/// Projection with reversed depth. Without a far plane it is near / z; otherwise depth falls from 1 at the
/// near plane to 0 at the far plane, by the usual rational function or, in orthographic projections,
/// linearly.
glm::mat4 projection(const Camera& camera, float aspect) {
    const float n = camera.near_plane;
    const float f = camera.far_plane;
    const Lens lens = lens_of(camera, aspect);
    glm::mat4 m(0.0F);
    m[0][0] = lens.scale.x;
    m[1][1] = lens.scale.y;
    if (is_orthographic(camera)) {
        m[2][2] = 1.0F / (f - n);
        m[3] = glm::vec4(lens.shift, f / (f - n), 1.0F);
        return m;
    }
    const bool infinite = std::isinf(f);
    m[2] = glm::vec4(-lens.shift, infinite ? 0.0F : n / (f - n), -1.0F);
    m[3][2] = infinite ? n : n * f / (f - n);
    return m;
}

/// The camera-to-world matrix without its scale.
glm::mat4 rigid(const glm::mat4& world_from_camera) {
    const glm::vec3 z = glm::normalize(glm::vec3(world_from_camera[2]));
    const glm::vec3 x = glm::normalize(glm::cross(glm::vec3(world_from_camera[1]), z));
    return {glm::vec4(x, 0.0F), glm::vec4(glm::cross(z, x), 0.0F), glm::vec4(z, 0.0F), world_from_camera[3]};
}

gpu::ViewConstants view_constants(const CameraView& view, glm::uvec2 size) {
    const glm::mat4& clip = view.clip_from_view;
    return {.clip_from_world = view.clip_from_world,
            .world_from_clip = view.world_from_clip,
            .view_from_world = view.view_from_world,
            .target_size = glm::vec2(size),
            .ray_scale = {1.0F / clip[0][0], 1.0F / clip[1][1]},
            .ray_shift = view.orthographic ? glm::vec2(clip[3]) : -glm::vec2(clip[2]),
            .depth_terms = {clip[2][2], clip[3][2]},
            .orthographic = view.orthographic ? 1U : 0U};
}

}  // namespace

std::string view_ending(std::size_t index) {
    return index == 0 ? "" : fmt::format(" {}", index + 1);
}

CameraView make_view(const Camera& camera, const glm::mat4& world_from_camera, glm::uvec2 size,
                     glm::vec2 jitter) {
    const glm::vec2 pixels(size);
    glm::mat4 jittered(1.0F);
    jittered[3] = glm::vec4(-2.0F * jitter / pixels, 0.0F, 1.0F);
    const glm::mat4 pose = rigid(world_from_camera);
    // In double precision: for a camera far from the origin, the inverse in floats would lose digits that
    // shading needs.
    const glm::dmat4 view_from_world = glm::inverse(glm::dmat4(pose));
    const glm::dmat4 clip_from_view =
        glm::dmat4(jittered) * glm::dmat4(projection(camera, pixels.x / pixels.y));
    const glm::dmat4 clip_from_world = clip_from_view * view_from_world;
    return {.clip_from_world = glm::mat4(clip_from_world),
            .world_from_clip = glm::mat4(glm::inverse(clip_from_world)),
            .view_from_world = glm::mat4(view_from_world),
            .clip_from_view = glm::mat4(clip_from_view),
            .eye = glm::vec3(pose[3]),
            .orthographic = is_orthographic(camera)};
}

CameraView requested_view(const WorldReader& world, const ViewRequest& request) {
    const auto& camera = world.get<Camera>(request.camera);
    const glm::mat4 matrix = world_matrix(world, request.camera);
    Fault fault = fault_of(camera);
    if (!fault) fault = fault_of(matrix);
    if (!fault && fault_of(rigid(matrix))) fault = "the world matrix has no direction";
    if (fault) throw SceneError(fmt::format("{}, Camera: {}", describe(world, request.camera), *fault));
    return make_view(camera, matrix, request.size, request.jitter);
}

void read_request(Pass& pass, ValueHandle<ViewRequest> request) {
    pass.read(request);
    pass.read<Camera>();
    pass.read<Transform>();
}

std::vector<CameraView> requested_views(const WorldReader& world, const std::vector<ViewRequest>& requests) {
    std::vector<CameraView> views;
    views.reserve(requests.size());
    for (const ViewRequest& request : requests) views.push_back(requested_view(world, request));
    return views;
}

void read_requests(Pass& pass, ValueHandle<std::vector<ViewRequest>> requests) {
    pass.read(requests);
    pass.read<Camera>();
    pass.read<Transform>();
}

glm::vec2 pixel_sample(std::uint32_t i) {
    if (i == 0) return glm::vec2(0.0F);
    const std::uint32_t pair = (i + 1) / 2;
    const glm::dvec2 point = r2_point(pair, glm::dvec2(0.5)) - 0.5;
    return glm::vec2(i % 2 == 1 ? point : -point);
}

ValueHandle<CameraView> add_view(FrameGraph& graph, ValueHandle<ViewRequest> request) {
    return graph.add("view", [&](Pass& pass) {
        read_request(pass, request);
        const auto view = pass.write(graph.value<CameraView>("view"));
        pass.run([=](Execution& run) { run.set(view, requested_view(run.world(), run.value(request))); });
        return view;
    });
}

ViewData add_view_upload(FrameGraph& graph, const Gpu& gpu, ValueHandle<CameraView> camera, glm::uvec2 size) {
    return graph.add("view-upload", [&](Pass& pass) {
        pass.read(camera);
        pass.parameter(size);
        const auto constants =
            pass.write(growing_buffer<gpu::ViewConstants>(graph, "view constants"), Usage::copy);
        pass.run([=, &gpu](Execution& run) {
            upload_one(gpu, run, constants, view_constants(run.value(camera), size));
        });
        return ViewData{.camera = camera, .constants = constants, .size = size};
    });
}

void read_view(Pass& pass, const ViewData& view) {
    pass.read(view.constants, {Usage::uniform, UNIFORMS_VIEW});
}

}  // namespace candela
