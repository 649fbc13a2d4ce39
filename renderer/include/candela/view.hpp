#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/api.hpp>
#include <candela/ecs/entity.hpp>

namespace candela {

struct Camera;

/// The part of a framebuffer of the host that a view is drawn into. Only colour is written, into the first
/// draw buffer, in any format but integers; with a floating-point format and the tone map off, radiance is
/// stored as it is, and alpha tells where there is a surface. The host keeps ownership.
struct Target {
    std::uint32_t framebuffer = 0;  ///< GL name; 0: the default framebuffer (the window)
    glm::uvec2 size{1};             ///< pixels
    glm::uvec2 origin{0};           ///< of the lower left corner, pixels from that of the framebuffer
    bool operator==(const Target&) const = default;
};

/// Matrices of a view. Clip space is that of OpenGL with reversed depth in [0, 1]: 1 at the near plane. View
/// space has the eye at its origin and looks along -z; a depth in metres is -z in view space.
struct CameraView {
    glm::mat4 clip_from_world{1.0F};
    glm::mat4 world_from_clip{1.0F};
    glm::mat4 view_from_world{1.0F};
    glm::mat4 clip_from_view{1.0F};
    glm::vec3 eye{0.0F};  ///< world space, metres
    bool orthographic = false;
    bool operator==(const CameraView&) const = default;
};

/// The view of a camera with this local-to-world matrix, whose scale is ignored, in a picture of `size`
/// pixels: for picking, and for what a host draws over the picture. `jitter`: see RenderView::jitter. If
/// Camera::far_plane is infinite, the projection has no far plane.
[[nodiscard]] CANDELA_API CameraView make_view(const Camera& camera, const glm::mat4& world_from_camera,
                                               glm::uvec2 size, glm::vec2 jitter = glm::vec2(0.0F));

/// Position of sample i, as an offset from the pixel centre in pixels, in [-0.5, 0.5]²: for
/// RenderView::jitter where a host averages frames. Sample 0 is the centre. Samples 2k - 1 and 2k are point k
/// of the R2 sequence (Roberts 2018) and its mirror image, so that a mean over samples does not shift the
/// picture.
[[nodiscard]] CANDELA_API glm::vec2 pixel_sample(std::uint32_t i);

/// How a normal (x, y, z) is stored in the channels of a texture.
enum class NormalEncoding : std::uint8_t {
    signed_xyz,    ///< as it is, in a format with a sign
    unsigned_xyz,  ///< 0.5 (x, y, z) + 0.5
    octahedral     ///< red and green, in [-1, 1]: Cigolle et al. (2014), as in Candela's own normals
};

/// The surfaces that are visible in a view, as drawn by the host: 2D textures of the same size, which should
/// be that of the target. Formats that cannot hold what is said here are errors; so is, with
/// RendererOptions::checked, content that does not fit to the world. Candela then draws no surfaces itself
/// and computes their light: the radiance that they reflect. It adds no emission, sky or blended surfaces,
/// which are the host's. The scene's meshes must still be in the world, where they cast shadows and reflect
/// light.
struct HostSurfaces {
    std::uint32_t depth = 0;   ///< GL name; window depth in [0, 1]: a depth format, or one with red alone
    std::uint32_t normal = 0;  ///< GL name
    std::uint32_t albedo = 0;  ///< GL name; sampled as linear RGB: the base colour, if there is a material
    /// GL name; red: roughness, green: metalness, as in Material, linear and in [0, 1]. What is not metal
    /// then reflects like glTF's materials by default: like an interface of index of refraction 1.5. 0: none,
    /// and the surfaces are Lambertian.
    std::uint32_t material = 0;
    /// The projection that `depth` was drawn with, of a camera as in CameraView. Its near and far planes need
    /// not be those of the Camera, but no surface may be nearer than Camera::near_plane.
    glm::mat4 clip_from_view{1.0F};
    bool clip_depth_from_0 = false;  ///< clip-space depth is in [0, 1], as set by glClipControl, not [-1, 1]
    float empty_depth = 1.0F;        ///< where there is no surface; 0 for reversed depth
    NormalEncoding normal_encoding = NormalEncoding::signed_xyz;
    glm::mat3 world_from_normal{1.0F};  ///< a rotation: the camera's if the normals are in view space
    /// Which content the textures have. If this and all else here are as in the last frame of the view, and
    /// the textures have the same size, their content counts as the same, and a still frame costs next to
    /// nothing; refinement starts over when the content changes. 0: the content counts as new in each frame,
    /// and refinement goes on. Renderer::verify finds a revision that should have changed.
    std::uint64_t revision = 0;
    bool operator==(const HostSurfaces&) const = default;
};

/// Parts of a frame, to ask for those that are to be there after it (RenderView::keep) or for an extension
/// (Extension::needs). FrameResults describes them.
struct FrameParts {
    bool depth = false;
    bool normal = false;
    bool albedo = false;
    bool indirect = false;
    bool radiance = false;
    bool vpls = false;
    bool operator==(const FrameParts&) const = default;
};

/// One of the views of a frame.
struct RenderView {
    Entity camera;  ///< an entity with a Camera
    Target target;
    glm::vec2 jitter{0.0F};  ///< moves the samples off the pixel centres, in rendered pixels, +x right, +y up
    FrameParts keep{};       ///< can be asked for with Renderer::results after the frame
    /// Renderer::report estimates the error of the VPLs' light: VplReport::estimated_error. This costs about
    /// as much as placing and lighting the VPLs, whenever these change, and 432 rays for each VPL, whenever
    /// anything in the view changes.
    bool estimate_error = false;
    std::optional<HostSurfaces> surfaces{};  ///< none: Candela draws the surfaces
};

/// Options of one frame.
struct FrameOptions {
    /// Asked before each pass that runs, and between parts of those that shade pixels; must not call the
    /// renderer. If it returns false, the frame is abandoned: for example because the user has moved
    /// something meanwhile. Empty: always wanted.
    std::function<bool()> wanted{};
};

/// A texture of a frame; name 0 if the configuration has no such texture, or if it was not asked for.
struct ResultTexture {
    std::uint32_t texture = 0;  ///< GL name of a 2D texture without mip levels
    glm::uvec2 size{0};         ///< pixels; less than the target's if a frame budget reduces the quality
};

/// A buffer of a frame; name 0 if the frame has no such content, or if it was not asked for.
struct ResultBuffer {
    std::uint32_t buffer = 0;  ///< GL name
    std::uint32_t count = 0;   ///< structs in it
};

/// What a view has left on the GPU, as far as its RenderView::keep asked for it. The objects belong to the
/// renderer, which may change or delete them in its next call; they may be read, not written.
struct FrameResults {
    CameraView view;       ///< the textures were rendered with it, refinement's offset in the pixels included
    ResultTexture depth;   ///< depth32f, reversed: 1 at the near plane, 0 where there is no surface
    ResultTexture normal;  ///< rg32f: octahedral encoding, world space
    ResultTexture albedo;  ///< rgba16f: linear base colour of the solid surfaces
    /// rgba32f: π times the irradiance from all VPLs, in lux or W/m², at the solid surfaces.
    ResultTexture indirect;
    /// rgba32f: linear radiance before exposure and tone mapping, the mean of all frames with refinement;
    /// alpha is 1 where there is a surface, else 0, and in between where blended surfaces cover the sky.
    ResultTexture radiance;
    ResultBuffer traced_vpls{};   ///< `TracedVpl` of glsl_types(); only with VplPlacement::paths
    ResultBuffer lit_surfels{};   ///< `LitSurfel` of glsl_types(): surfels that emit no light themselves
    ResultBuffer lit_emitters{};  ///< `LitEmitter` of glsl_types(): surfels on surfaces that emit light
    ResultBuffer sky_patches{};   ///< `SkyPatch` of glsl_types(); only if the light of the sky is shown
};

}  // namespace candela
