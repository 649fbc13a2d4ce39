#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <candela/api.hpp>
#include <candela/graph/frame_graph.hpp>
#include <candela/point_lighting.hpp>
#include <candela/view.hpp>

namespace candela {

namespace gpu {
struct Light;
struct LitEmitter;
struct LitSurfel;
struct SkyPatch;
struct TracedVpl;
}  // namespace gpu

/// GLSL source of the structs in the buffers of a frame, such as Light and LitSurfel, for a host's own
/// shaders: layout std430. Static storage duration.
[[nodiscard]] CANDELA_API std::string_view glsl_types();

/// Where in a view's frame an extension adds its passes.
enum class ExtensionPlace : std::uint8_t {
    after_surfaces,   ///< before shading; there is no radiance yet
    after_shading,    ///< radiance of the solid surfaces and of the sky; blended surfaces follow
    before_tone_map,  ///< radiance of the whole picture, with refinement the mean of all frames
};

/// Handles of a view's frame at the place of an extension: inputs for its passes. An extension replaces the
/// handle of a texture by that of its own result, for example `radiance`; what follows in the frame then
/// reads that. The result must have the size and the format of what it replaces, which are those of
/// FrameResults; to return another, or a part that was not given, is an error. Parts that were not asked for
/// may be missing.
struct ViewFrame {
    std::size_t index = 0;  ///< of the view in the call of Renderer::render
    glm::uvec2 size{1};     ///< pixels of the textures
    ValueHandle<CameraView> view{};
    std::optional<TextureHandle> depth{};
    std::optional<TextureHandle> normal{};
    std::optional<TextureHandle> albedo{};  ///< base colour, as FrameResults::albedo
    /// Of scenes with glossy surfaces, where the albedo is. rgba16f: reflectance in the mirror direction of
    /// what is not metal, where the surface faces the viewer and (alpha) at grazing angles. rg16f: roughness
    /// and metalness.
    std::optional<TextureHandle> mirror{};
    std::optional<TextureHandle> gloss{};
    /// Of scenes with normal or occlusion textures, where the albedo is. rgba32f: the shading normal, as
    /// `normal`, and the share of indirect light that reaches the surface; alpha is not used.
    std::optional<TextureHandle> bumps{};
    std::optional<TextureHandle> indirect{};
    /// With `bumps`: how `indirect` is distributed over directions. rgba32f, sums over the VPLs, of π times
    /// what a surface that faces one receives from it, mean of the channels: times its direction, and (alpha)
    /// alone.
    std::optional<TextureHandle> indirect_flow{};
    std::optional<TextureHandle> radiance{};
    std::optional<PointLighting> lighting{};  ///< for the host's shaders; none if no light is shown
    BufferHandle<gpu::Light> lights{};        ///< the scene's lights: `Light` as in glsl_types()
    // The VPLs, as in glsl_types(): those on paths; or surfels, surfels that emit light, patches of the sky.
    std::optional<BufferHandle<gpu::TracedVpl>> traced_vpls{};
    std::optional<BufferHandle<gpu::LitSurfel>> lit_surfels{};
    std::optional<BufferHandle<gpu::LitEmitter>> lit_emitters{};
    std::optional<BufferHandle<gpu::SkyPatch>> sky_patches{};
    std::optional<BufferHandle<std::uint32_t>> list_first{};  ///< light lists, by cell: where its list begins
    std::optional<BufferHandle<std::uint32_t>> list_count{};  ///< by cell: the length of its list
    std::optional<BufferHandle<std::uint32_t>> list_entries{};  ///< indices of lights, list after list
};

/// Passes of a host in the frames of a renderer. They are declared like Candela's own: they run only when
/// what they read has changed, appear in Renderer::description and in the times, and are verified. Objects
/// are GL names (Execution::object). Before a pass runs, its attachments and bindings are bound, the viewport
/// covers the attachments, and depth test, culling and blending are off. A pass may leave any state behind,
/// such as the scissor test, blending, masks and bindings: the passes that follow set what they need. It must
/// end what it begins, such as queries, conditional rendering and transform feedback, and leave the
/// attachments of the framebuffer that is bound. State that Candela itself never changes, such as that of
/// pixel transfers, is not restored for the host.
struct Extension {
    std::string name;  ///< identifies the extension; in messages
    ExtensionPlace place = ExtensionPlace::before_tone_map;
    FrameParts needs{};  ///< parts that are to be there, even if the configuration alone would not make them
    /// Adds passes to the graph. Called for each view, each time that the graph is declared: after changes of
    /// the configuration, of sizes, of the number of views, and of what the world contains.
    std::function<void(FrameGraph& graph, ViewFrame& frame)> declare{};
};

}  // namespace candela
