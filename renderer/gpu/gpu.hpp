#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <candela/renderer_options.hpp>
#include <candela/view.hpp>
#include "renderer/gl/device.hpp"
#include "renderer/gl/objects.hpp"
#include "renderer/gl/program.hpp"
#include "renderer/gl/shader_source.hpp"
#include "renderer/gl/texture.hpp"
#include "renderer/gpu/log.hpp"
#include "renderer/gpu/programs.hpp"
#include "renderer/passes/scene/scene_check.hpp"

namespace candela {

/// Number of work groups of `a_group` invocations that cover `count`.
[[nodiscard]] constexpr std::uint32_t groups(std::uint32_t count, std::uint32_t a_group) {
    return (count + a_group - 1) / a_group;
}

/// Throws gl::GlError that names the first limit that is too low for the renderer's shaders.
void require_limits(const gl::Limits& limits);

/// The GL device of one renderer, with the objects that its passes share. Passes keep references to it; it
/// must outlive them.
class Gpu {
 public:
    /// Throws gl::GlError if the context does not offer what the renderer needs.
    Gpu(const gl::GetProc& get_proc, gl::ShaderLibrary shaders, const RendererOptions& options);
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;
    ~Gpu() = default;

    [[nodiscard]] gl::Device& device() { return device_; }
    [[nodiscard]] const gl::Device& device() const { return device_; }
    [[nodiscard]] const gl::Functions& gl() const { return device_.gl(); }

    /// Throws gl::GlError if the current context is not that of construction.
    void require_context() const;

    /// For a pass that is being declared: see Programs::request. Ready when the pass runs.
    [[nodiscard]] const gl::Program& program(const std::vector<std::string>& stages,
                                             const std::vector<std::string>& defined = {}) {
        return programs_.request(stages, defined);
    }
    [[nodiscard]] Programs& programs() { return programs_; }
    [[nodiscard]] const Programs& programs() const { return programs_; }

    /// A vertex array for candela::Vertex (binding 0) and instance indices (binding 1): see draw_scene.hpp.
    [[nodiscard]] gl::VertexArray& mesh_vertices() { return mesh_vertices_; }
    /// The same with second texture coordinates (binding 2).
    [[nodiscard]] gl::VertexArray& mesh_vertices_with_second_uvs() { return mesh_vertices_with_second_uvs_; }
    /// A 1 × 1 white texture, for materials without an image.
    [[nodiscard]] const gl::Texture& white() const { return white_; }
    /// mirror_table as a texture, for scenes with glossy surfaces; made at the first request.
    [[nodiscard]] const gl::Texture& mirror_shares();
    /// For textures of the host's, which may have any parameters: no filtering, mip level 0, no comparison.
    [[nodiscard]] const gl::Sampler& nearest() const { return nearest_; }
    /// A framebuffer for passes that draw into single layers. They attach a layer and detach it again.
    [[nodiscard]] gl::Framebuffer& layer_target() { return layer_target_; }

    /// Warnings to the host.
    [[nodiscard]] Log& log() { return log_; }
    /// What of a world is rendered.
    [[nodiscard]] SceneCheck& scene_check() { return scene_check_; }
    /// See RendererOptions::checked.
    [[nodiscard]] bool checked() const { return checked_; }
    /// See RendererOptions::keeps_gl_state.
    [[nodiscard]] bool keeps_gl_state() const { return keeps_gl_state_; }

    /// Draws to a target of the host's.
    void set_target(const Target& target) const;
    /// Clears the colours of the bound targets to 0.
    void clear_colour() const;
    /// Clears them, and depth to 0: infinitely far.
    void clear_colour_and_depth() const;

    /// Draws one triangle that covers the viewport; the vertex stage is fullscreen.vert.
    void draw_fullscreen(const gl::Program& program, const gl::Uniforms& uniforms = {},
                         const gl::RasterState& state = {});

 private:
    Log log_;
    SceneCheck scene_check_;
    bool checked_;
    bool keeps_gl_state_;
    gl::Device device_;
    Programs programs_;
    gl::VertexArray mesh_vertices_;
    gl::VertexArray mesh_vertices_with_second_uvs_;
    gl::VertexArray no_vertices_;  // for geometry that shaders generate
    gl::Texture white_;
    std::optional<gl::Texture> mirror_shares_;
    gl::Sampler nearest_;
    gl::Framebuffer layer_target_;
};

}  // namespace candela
