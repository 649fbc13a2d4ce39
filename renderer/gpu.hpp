#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/gl/device.hpp"
#include "renderer/gl/objects.hpp"
#include "renderer/gl/program.hpp"
#include "renderer/gl/shader_source.hpp"
#include "renderer/gl/texture.hpp"

namespace candela {

/// What the passes of one renderer share: the device, and what they would otherwise make twice. Passes refer
/// to it while they live.
class Gpu {
 public:
    Gpu(const gl::GetProc& get_proc, gl::ShaderLibrary shaders);

    [[nodiscard]] gl::Device& device() { return device_; }
    [[nodiscard]] const gl::Device& device() const { return device_; }
    [[nodiscard]] const gl::Functions& gl() const { return device_.gl(); }

    /// The program of these stage files with these words defined, compiled when first asked for and kept.
    /// Throws gl::ProgramError.
    [[nodiscard]] const gl::Program& program(const std::vector<std::string>& stages,
                                             const std::vector<std::string>& defined = {});

    /// A vertex array for candela::Vertex and instance indices: see draw_scene.hpp.
    [[nodiscard]] gl::VertexArray& mesh_vertices() { return mesh_vertices_; }
    /// A vertex array without attributes, for triangles that shaders make up.
    [[nodiscard]] const gl::VertexArray& no_vertices() const { return no_vertices_; }
    /// One white texel, where a material has no image.
    [[nodiscard]] const gl::Texture& white() const { return white_; }
    /// A framebuffer for passes that draw into single layers; they attach what they need and detach it again.
    [[nodiscard]] gl::Framebuffer& layer_target() { return layer_target_; }
    /// Bilinear comparison of reversed depth: lit where the reference is greater or equal.
    [[nodiscard]] const gl::Sampler& shadow_sampler() const { return shadow_sampler_; }

    void bind_storage(GLuint binding, GLuint buffer) const;
    void bind_uniforms(GLuint binding, GLuint buffer) const;
    void draw_fullscreen(const gl::Program& program) const;

 private:
    gl::Device device_;
    gl::ShaderLibrary shaders_;
    using ProgramKey = std::pair<std::vector<std::string>, std::vector<std::string>>;
    std::map<ProgramKey, gl::Program> programs_;
    gl::VertexArray mesh_vertices_;
    gl::VertexArray no_vertices_;
    gl::Texture white_;
    gl::Framebuffer layer_target_;
    gl::Sampler shadow_sampler_;
};

}  // namespace candela
