#include "renderer/passes/surfaces/draw_scene.hpp"

#include <utility>

#include <candela/graph/frame_graph.hpp>

namespace candela {
namespace {

void multi_draw(const gl::Functions& gl, std::size_t first, std::size_t count) {
    const auto offset = reinterpret_cast<const void*>(first * sizeof(gpu::DrawCommand));
    gl.MultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, offset, static_cast<GLsizei>(count), 0);
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
    std::vector<ResourceHandle> read{scene.layout, scene.vertices,  scene.instance_ids, scene.indices,
                                     scene.draws,  scene.instances, scene.materials};
    if (scene.second_uvs) {
        pass.read(*scene.second_uvs, Usage::vertex);
        read.emplace_back(*scene.second_uvs);
    }
    return read;
}

void bind_meshes(Gpu& gpu, Execution& run, const SceneData& scene) {
    gl::VertexArray& vertices = scene.second_uvs ? gpu.mesh_vertices_with_second_uvs() : gpu.mesh_vertices();
    if (scene.second_uvs) vertices.vertex_buffer(run.object(*scene.second_uvs), sizeof(glm::vec2), 0, 2);
    vertices.vertex_buffer(run.object(scene.vertices), sizeof(Vertex), 0, 0);
    vertices.vertex_buffer(run.object(scene.instance_ids), sizeof(std::uint32_t), 0, 1);
    vertices.index_buffer(run.object(scene.indices));
    vertices.bind();
}

void draw_commands(Gpu& gpu, std::size_t first, std::size_t count, const gl::RasterState& state) {
    gpu.device().set_raster_state(state);
    multi_draw(gpu.gl(), first, count);
}

void draw_in_group(Gpu& gpu, const SceneLayout::Group& group, std::size_t first, std::size_t count,
                   gl::RasterState state) {
    group.material->bind(gpu);
    state.clockwise_front = group.mirrored;
    draw_commands(gpu, first, count, state);
}

std::vector<std::string> mesh_variant(const SceneData& scene, std::vector<std::string> words) {
    if (scene.second_uvs) words.emplace_back("SECOND_UV");
    return words;
}

SurfacePrograms surface_programs(Gpu& gpu, const SceneData& scene, const std::string& fragment_stage,
                                 std::vector<std::string> defined) {
    defined = mesh_variant(scene, std::move(defined));
    const std::vector<std::string> stages{"surfaces/mesh_surface.vert", fragment_stage};
    SurfacePrograms programs{.opaque = nullptr, .masked = nullptr};
    if (scene.kinds.opaque) programs.opaque = &gpu.program(stages, defined);
    defined.emplace_back("MASKED");
    if (scene.kinds.masked) programs.masked = &gpu.program(stages, defined);
    return programs;
}

void draw_surfaces(Gpu& gpu, Execution& run, const SceneData& scene, const SurfacePrograms& programs,
                   gl::RasterState state, const gl::Uniforms& uniforms,
                   bool (*is_drawn)(const SceneLayout::Group&)) {
    bind_meshes(gpu, run, scene);
    const gl::Program* used = nullptr;
    for (const SceneLayout::Group& group : run.value(scene.layout).groups) {
        if (group.material->alpha == AlphaMode::blend || !is_drawn(group)) continue;
        const gl::Program* const program =
            group.material->alpha == AlphaMode::mask ? programs.masked : programs.opaque;
        if (std::exchange(used, program) != program) program->use(uniforms);
        state.culling = group.material->double_sided ? gl::Culling::off : gl::Culling::back;
        draw_in_group(gpu, group, group.first_draw, group.draw_count, state);
    }
}

}  // namespace candela
