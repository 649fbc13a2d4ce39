#include "renderer/passes/surfaces/host_surfaces_check.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <candela/graph/execute.hpp>
#include <candela/scene/scene_error.hpp>
#include "renderer/gl/texture.hpp"
#include "renderer/passes/scene/traced_scene.hpp"

namespace candela {
namespace {

constexpr std::uint32_t rows = 16;     // of pixels that are looked at
constexpr std::uint32_t columns = 16;  // in each row
/// With fewer surfaces, nothing is said.
constexpr std::uint32_t enough = 16;
/// How far a surface of the scene may be from the host's, as a share of its distance from the eye. A wrong
/// convention of depth moves surfaces by more; levels of detail by less.
constexpr float nearness = 0.02F;
/// Cosine of the largest angle between a face and the host's normal, 30 degrees: most of those of smooth and
/// bumpy surfaces are within it. Normals of unit axes that are stored without a sign and read as if they had
/// one are turned by at least 35 degrees.
constexpr float same_way = 0.866F;

/// A pixel of the host's at which there is a surface.
struct Seen {
    glm::vec3 place;    // view space
    glm::vec3 towards;  // from the eye, or along an orthographic view: as far as the surface
    glm::vec3 normal;   // world space
};

/// How the host's surfaces and the scene's agree.
struct Agreement {
    std::uint32_t surfaces = 0;
    std::uint32_t near = 0;    // of these, with a surface of the scene nearby
    std::uint32_t facing = 0;  // of the near ones, those that face the same way
};

float sign_not_0(float x) {
    return x < 0.0F ? -1.0F : 1.0F;
}

glm::vec3 decoded_normal(NormalEncoding encoding, glm::vec3 stored) {
    switch (encoding) {
        case NormalEncoding::signed_xyz:
            break;
        case NormalEncoding::unsigned_xyz:
            return glm::normalize(2.0F * stored - 1.0F);
        case NormalEncoding::octahedral: {
            const float z = 1.0F - std::abs(stored.x) - std::abs(stored.y);
            if (z >= 0.0F) return glm::normalize(glm::vec3(stored.x, stored.y, z));
            return glm::normalize(glm::vec3((1.0F - std::abs(stored.y)) * sign_not_0(stored.x),
                                            (1.0F - std::abs(stored.x)) * sign_not_0(stored.y), z));
        }
    }
    return glm::normalize(stored);
}

/// The point of the view's ray through `ndc` whose view-space z is `z`, as
/// shaders/surfaces/host_surfaces.frag finds it.
Seen seen_at(const CameraView& view, glm::vec2 ndc, float z) {
    const glm::mat4 view_from_clip = glm::inverse(view.clip_from_view);
    const auto unproject = [&](float depth) {
        const glm::vec4 point = view_from_clip * glm::vec4(ndc, depth, 1.0F);
        return glm::vec3(point) / point.w;
    };
    const glm::vec3 first = unproject(1.0F);
    const glm::vec3 step = unproject(0.5F) - first;
    return {.place = first + step * ((z - first.z) / step.z), .towards = step * (z / step.z), .normal = {}};
}

/// One row of the host's textures.
struct Row {
    std::vector<float> depth;
    std::vector<glm::vec4> normal;
};

/// None if there is no surface.
std::optional<Seen> surface_at(const HostSurfaces& host, const CameraView& view, const Row& row,
                               std::uint32_t x, glm::vec2 ndc) {
    const float depth = row.depth[x];
    if (depth == host.empty_depth) return std::nullopt;
    const float clip_depth = host.clip_depth_from_0 ? depth : 2.0F * depth - 1.0F;
    const glm::vec4 on_view = glm::inverse(host.clip_from_view) * glm::vec4(ndc, clip_depth, 1.0F);
    Seen seen = seen_at(view, ndc, on_view.z / on_view.w);
    seen.normal = host.world_from_normal * decoded_normal(host.normal_encoding, glm::vec3(row.normal[x]));
    return seen;
}

/// The surface of the scene that is near the one that the host sees.
std::optional<SurfaceHit> surface_near(const TracedScene& scene, const CameraView& view, const Seen& seen) {
    if (!(seen.place.z < 0.0F) || !std::isfinite(seen.place.z)) return std::nullopt;
    const glm::mat4 world_from_view = glm::inverse(view.view_from_world);
    const auto place = glm::vec3(world_from_view * glm::vec4(seen.place, 1.0F));
    const glm::vec3 direction = glm::mat3(world_from_view) * seen.towards;
    return nearest_surface(scene, {.origin = place - nearness * direction,
                                   .direction = direction,
                                   .t_min = 0.0F,
                                   .t_max = 2.0F * nearness});
}

void count(const TracedScene& scene, const CameraView& view, const Seen& seen, Agreement& agreement) {
    ++agreement.surfaces;
    const std::optional<SurfaceHit> hit = surface_near(scene, view, seen);
    if (!hit) return;
    ++agreement.near;
    if (glm::dot(hit->normal, seen.normal) > same_way) ++agreement.facing;
}

Agreement compare(const gl::Functions& gl, const HostSurfaces& host, const CameraView& view,
                  const TracedScene& scene) {
    const glm::uvec2 size = gl::texture_size(gl, host.depth);
    const glm::uvec2 one_row(size.x, 1);
    Agreement agreement;
    for (std::uint32_t i = 0; i < rows; ++i) {
        const glm::uvec2 first(0, (2 * i + 1) * size.y / (2 * rows));
        const Row row{gl::read_depths(gl, host.depth, one_row, first),
                      gl::read_texels(gl, host.normal, one_row, first)};
        for (std::uint32_t j = 0; j < columns; ++j) {
            const glm::uvec2 at((2 * j + 1) * size.x / (2 * columns), first.y);
            const glm::vec2 ndc = 2.0F * (glm::vec2(at) + 0.5F) / glm::vec2(size) - 1.0F;
            const std::optional<Seen> seen = surface_at(host, view, row, at.x, ndc);
            if (seen) count(scene, view, *seen, agreement);
        }
    }
    return agreement;
}

void require_agreement(const Agreement& found) {
    if (found.surfaces < enough) return;
    if (4 * found.near < found.surfaces) {
        throw SceneError(fmt::format(
            "host surfaces: at {} of {} pixels, the world has no surface near the one that the host's depth "
            "tells; is it of the world's meshes and camera, and of HostSurfaces::clip_from_view, "
            "clip_depth_from_0 and empty_depth?",
            found.surfaces - found.near, found.surfaces));
    }
    if (2 * found.facing < found.near) {
        throw SceneError(fmt::format(
            "host surfaces: at {} of {} pixels, the host's normal is not that of the surface; is it as "
            "HostSurfaces::normal_encoding and world_from_normal say?",
            found.near - found.facing, found.near));
    }
}

}  // namespace

ValueHandle<CheckedSurfaces> add_host_surfaces_check(FrameGraph& graph, Gpu& gpu,
                                                     const HostSurfaceInputs& inputs,
                                                     ValueHandle<CameraView> camera, const SceneData& scene,
                                                     const Tracing& tracing) {
    return graph.add("host-surfaces-check", [&](Pass& pass) {
        pass.read(inputs.depth, Usage::copy);
        pass.read(inputs.normal, Usage::copy);
        pass.read(inputs.description);
        pass.read(camera);
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(tracing.hierarchy);
        const auto checked = pass.write(graph.value<CheckedSurfaces>("checked surfaces"));
        pass.run([=, &gpu](Execution& run) {
            const HostSurfaces& host = run.value(inputs.description);
            const CameraView& view = run.value(camera);
            const TracedScene traced{*run.value(tracing.hierarchy), run.value(scene.layout),
                                     run.value(scene.placement)};
            require_agreement(compare(gpu.gl(), host, view, traced));
            run.set(checked, {});
        });
        return checked;
    });
}

}  // namespace candela
