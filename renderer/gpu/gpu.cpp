#include "renderer/gpu/gpu.hpp"

#include <fmt/ranges.h>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <candela/scene/components.hpp>
#include "renderer/gpu/mirror_shares.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

gl::VertexArray make_mesh_vertices(gl::Device& device) {
    gl::VertexArray array(device, "mesh vertices");
    array.attribute(ATTRIBUTE_POSITION, 3, GL_FLOAT, offsetof(Vertex, position));
    array.attribute(ATTRIBUTE_NORMAL, 3, GL_FLOAT, offsetof(Vertex, normal));
    array.attribute(ATTRIBUTE_UV, 2, GL_FLOAT, offsetof(Vertex, uv));
    array.normalized_attribute(ATTRIBUTE_COLOUR, 4, GL_UNSIGNED_SHORT, offsetof(Vertex, colour));
    array.normalized_attribute(ATTRIBUTE_TANGENT, 4, GL_SHORT, offsetof(Vertex, tangent));
    array.integer_attribute(ATTRIBUTE_INSTANCE, 1, GL_UNSIGNED_INT, 0, 1);
    device.gl().VertexArrayBindingDivisor(array.name(), 1, 1);
    return array;
}

gl::VertexArray make_mesh_vertices_with_second_uvs(gl::Device& device) {
    gl::VertexArray array = make_mesh_vertices(device);
    array.attribute(ATTRIBUTE_SECOND_UV, 2, GL_FLOAT, 0, 2);
    return array;
}

gl::Texture make_white(gl::Device& device) {
    gl::Texture texture(device, "white", TextureDesc{});
    const std::array<std::byte, 4> texel{std::byte{255}, std::byte{255}, std::byte{255}, std::byte{255}};
    texture.upload(texel);
    return texture;
}

gl::Texture make_mirror_shares(gl::Device& device) {
    gl::Texture texture(device, "mirror shares",
                        {.size = glm::uvec2(mirror_table_size), .format = Format::rgba32f});
    std::vector<glm::vec4> texels;
    for (const glm::vec3& shares : mirror_table()) texels.emplace_back(shares, 0.0F);
    texture.upload(std::as_bytes(std::span(texels)));
    return texture;
}

/// By this label the context of a Gpu is known again: contexts do not share vertex arrays.
std::string label_of_vertices(const Gpu& gpu) {
    return fmt::format("no vertices of {}", static_cast<const void*>(&gpu));
}

}  // namespace

void require_limits(const gl::Limits& limits) {
    struct Need {
        std::string_view what;
        std::uint32_t offered;
        std::uint32_t needed;
    };
    const std::array<Need, 5> needs{
        {{"storage blocks a program", limits.storage_blocks, MOST_STORAGE_BLOCKS},
         {"storage blocks of a vertex or geometry shader", limits.drawing_storage_blocks, 1},
         {"binding points of storage blocks", limits.storage_bindings, BINDING_LAST + 1},
         {"binding points of uniform blocks", limits.uniform_bindings, UNIFORMS_LAST + 1},
         {"texture units", limits.texture_units, UNIT_LAST + 1}}};
    for (const Need& need : needs) {
        if (need.offered < need.needed) {
            throw gl::GlError(fmt::format("the driver offers {} {}; Candela needs {}", need.offered,
                                          need.what, need.needed));
        }
    }
}

Gpu::Gpu(const gl::GetProc& get_proc, gl::ShaderLibrary shaders, const RendererOptions& options)
    : log_(options.log),
      scene_check_(log_, options.checked),
      checked_(options.checked),
      keeps_gl_state_(options.keeps_gl_state),
      device_(get_proc, options.debug_output ? gl::DebugOutput::on : gl::DebugOutput::off,
              [this](const gl::DebugMessage& message) { log_.warn("OpenGL: " + message.text); }),
      programs_(device_, std::move(shaders), options.program_cache, log_),
      mesh_vertices_(make_mesh_vertices(device_)),
      mesh_vertices_with_second_uvs_(make_mesh_vertices_with_second_uvs(device_)),
      no_vertices_(device_, label_of_vertices(*this)),
      white_(make_white(device_)),
      nearest_(device_, "nearest", {.min_filter = GL_NEAREST, .mag_filter = GL_NEAREST}),
      layer_target_(device_, "layer target") {
    require_limits(device_.limits());
    layer_target_.draw_buffers(0);
}

void Gpu::require_context() const {
    const std::string expected = label_of_vertices(*this);
    std::array<char, 64> label{};
    if (gl().IsVertexArray(no_vertices_.name()) == GL_TRUE) {
        gl().GetObjectLabel(GL_VERTEX_ARRAY, no_vertices_.name(), static_cast<GLsizei>(label.size()), nullptr,
                            label.data());
        // Drivers need not keep labels.
        if (label[0] == '\0' || expected == label.data()) return;
    }
    throw gl::GlError("another OpenGL context is current than the renderer's, or none");
}

const gl::Texture& Gpu::mirror_shares() {
    if (!mirror_shares_) mirror_shares_ = make_mirror_shares(device_);
    return *mirror_shares_;
}

void Gpu::set_target(const Target& target) const {
    const glm::ivec2 origin(target.origin);
    const glm::ivec2 size(target.size);
    gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
    gl().Viewport(origin.x, origin.y, size.x, size.y);
}

void Gpu::clear_colour() const {
    gl().ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl().Clear(GL_COLOR_BUFFER_BIT);
}

void Gpu::clear_colour_and_depth() const {
    gl().ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl().ClearDepthf(0.0F);
    gl().Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Gpu::draw_fullscreen(const gl::Program& program, const gl::Uniforms& uniforms,
                          const gl::RasterState& state) {
    program.use(uniforms);
    device_.set_raster_state(state);
    no_vertices_.bind();
    gl().DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace candela
