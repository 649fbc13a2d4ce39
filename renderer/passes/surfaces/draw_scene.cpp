#include "renderer/passes/surfaces/draw_scene.hpp"

#include <candela/graph/frame_graph.hpp>

namespace candela {
namespace {

void multi_draw(const gl::Functions& gl, std::size_t first, std::size_t count) {
    const auto offset = reinterpret_cast<const void*>(first * sizeof(gpu::DrawCommand));
    gl.MultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, offset, static_cast<GLsizei>(count), 0);
}

/// Binds an image of a material, or white if there is none.
void bind_image(const Gpu& gpu, GLuint unit, const MaterialTexture* image) {
    if (image != nullptr) {
        image->texture.bind(unit);
        image->sampler.bind(unit);
    } else {
        gpu.white().bind(unit);
        gpu.gl().BindSampler(unit, 0);
    }
}

}  // namespace

std::vector<ResourceHandle> read_meshes(Pass& pass, const SceneData& scene) {
    pass.read(scene.layout);
    pass.read(scene.vertices, Usage::vertex);
    pass.read(scene.instance_ids, Usage::vertex);
    pass.read(scene.indices, Usage::index);
    pass.read(scene.draws, Usage::indirect);
    pass.read(scene.instances, {Usage::storage, BINDING_INSTANCES});
    pass.read(scene.materials, {Usage::storage, BINDING_MATERIALS});
    return {scene.layout, scene.vertices,  scene.instance_ids, scene.indices,
            scene.draws,  scene.instances, scene.materials};
}

void bind_meshes(Gpu& gpu, Execution& run, const SceneData& scene) {
    gl::VertexArray& vertices = gpu.mesh_vertices();
    vertices.vertex_buffer(run.object(scene.vertices), sizeof(Vertex), 0, 0);
    vertices.vertex_buffer(run.object(scene.instance_ids), sizeof(std::uint32_t), 0, 1);
    vertices.index_buffer(run.object(scene.indices));
    vertices.bind();
}

void draw_depth(const Gpu& gpu, Execution& run, const SceneData& scene) {
    multi_draw(gpu.gl(), 0, run.value(scene.layout).opaque_count);
}

void draw_group(const Gpu& gpu, const SceneLayout::Group& group) {
    const gl::Functions& gl = gpu.gl();
    bind_image(gpu, UNIT_BASE_COLOUR, group.texture.get());
    if (group.emits) {
        bind_image(gpu, UNIT_EMISSION, group.emission.get());
    }
    gl.FrontFace(group.mirrored ? GL_CW : GL_CCW);
    multi_draw(gl, group.first_draw, group.draw_count);
}

void draw_masked_depth(const Gpu& gpu, Execution& run, const SceneData& scene) {
    for (const SceneLayout::Group& group : run.value(scene.layout).groups_of(AlphaMode::mask)) {
        draw_group(gpu, group);
    }
}

void begin_surfaces(const Gpu& gpu) {
    const gl::Functions& gl = gpu.gl();
    gl.ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl.ClearDepthf(0.0F);
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl.Enable(GL_DEPTH_TEST);
}

void begin_visible_surfaces(const Gpu& gpu) {
    const gl::Functions& gl = gpu.gl();
    gl.ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_EQUAL);
    gl.DepthMask(GL_FALSE);
}

void begin_adding(const Gpu& gpu) {
    const gl::Functions& gl = gpu.gl();
    gl.DepthFunc(GL_EQUAL);
    gl.DepthMask(GL_FALSE);
    gl.Enable(GL_BLEND);
    gl.BlendEquation(GL_FUNC_ADD);
    gl.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ZERO);
}

SurfacePrograms surface_programs(Gpu& gpu, const std::string& fragment_stage,
                                 std::vector<std::string> defined) {
    const std::vector<std::string> stages{"surfaces/mesh_surface.vert", fragment_stage};
    const gl::Program& opaque = gpu.program(stages, defined);
    defined.emplace_back("MASKED");
    return {&opaque, &gpu.program(stages, defined)};
}

void draw_surfaces(Gpu& gpu, Execution& run, const SceneData& scene, const SurfacePrograms& programs,
                   bool (*is_drawn)(const SceneLayout::Group&)) {
    const gl::Functions& gl = gpu.gl();
    bind_meshes(gpu, run, scene);
    for (const SceneLayout::Group& group : run.value(scene.layout).groups) {
        if (group.alpha == AlphaMode::blend || !is_drawn(group)) {
            continue;
        }
        if (group.double_sided) {
            gl.Disable(GL_CULL_FACE);
        } else {
            gl.Enable(GL_CULL_FACE);
        }
        (group.alpha == AlphaMode::mask ? programs.masked : programs.opaque)->use();
        draw_group(gpu, group);
    }
}

}  // namespace candela
