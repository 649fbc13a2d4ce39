#include "renderer/passes/surfaces/surfaces.hpp"

#include "renderer/passes/inspect/depth_note.hpp"
#include "shaders/bindings.glsl"

namespace candela {

TextureHandle write_depth(FrameGraph& graph, Pass& pass, const ViewData& view) {
    const TextureHandle depth =
        pass.write(graph.texture("depth", {view.size, Format::depth32f}), Usage::depth_target);
    graph.note(depth, depth_note(view.camera, [](const CameraView& camera, std::uint32_t) {
                   const glm::mat4& clip = camera.clip_from_view;
                   return DepthTerms(clip[2][2], clip[3][2], clip[2][3], clip[3][3]);
               }));
    return depth;
}

Surfaces write_geometry(FrameGraph& graph, Pass& pass, const ViewData& view) {
    return {.depth = write_depth(graph, pass, view),
            .normal = pass.write(graph.texture("normal", {view.size, Format::rg32f}), Usage::colour_target)};
}

Surfaces write_geometry_and_material(FrameGraph& graph, Pass& pass, const ViewData& view,
                                     MaterialParts parts) {
    const auto write = [&](std::string_view name, Format format) {
        return pass.write(graph.texture(name, {view.size, format}), Usage::colour_target);
    };
    Surfaces out = write_geometry(graph, pass, view);
    out.albedo = write("albedo", Format::rgba16f);
    if (parts.glossy) {
        out.mirror = write("mirror", Format::rgba16f);
        out.gloss = write("gloss", Format::rg16f);
    }
    if (parts.bumpy) out.bumps = write("bumps", Format::rgba32f);
    return out;
}

std::vector<std::string> material_variant(MaterialParts parts) {
    std::vector<std::string> words;
    if (parts.glossy) words.emplace_back("GLOSSY");
    if (parts.bumpy) words.emplace_back("BUMPY");
    return words;
}

std::vector<std::string> surface_variant(const Surfaces& surfaces, std::vector<std::string> others) {
    if (surfaces.mirrored) others.emplace_back("MIRRORED");
    return others;
}

std::vector<std::string> block_variant(const gl::Limits& limits, const Surfaces& surfaces,
                                       std::vector<std::string> others) {
    if (!limits.software) others.emplace_back("ONE_SURFACE");
    return surface_variant(surfaces, std::move(others));
}

void read_geometry(Pass& pass, const Surfaces& surfaces) {
    pass.read(*surfaces.depth, {Usage::sampled, UNIT_DEPTH});
    pass.read(*surfaces.normal, {Usage::sampled, UNIT_NORMAL});
}

void read_geometry_and_material(Pass& pass, const Surfaces& surfaces) {
    read_geometry(pass, surfaces);
    pass.read(*surfaces.albedo, {Usage::sampled, UNIT_ALBEDO});
    if (surfaces.mirror) pass.read(*surfaces.mirror, {Usage::sampled, UNIT_MIRROR});
    if (surfaces.gloss) pass.read(*surfaces.gloss, {Usage::sampled, UNIT_GLOSS});
    if (surfaces.bumps) pass.read(*surfaces.bumps, {Usage::sampled, UNIT_BUMPS});
}

void test_depth(Pass& pass, const Surfaces& surfaces) {
    pass.read(*surfaces.depth, Usage::depth_target);
}

}  // namespace candela
