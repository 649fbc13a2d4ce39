#include "renderer/passes/surfaces/surfaces.hpp"

#include "shaders/bindings.glsl"

namespace candela {

Surfaces write_geometry(FrameGraph& graph, Pass& pass, glm::uvec2 size) {
    return {.depth = pass.write(graph.texture("depth", {size, Format::depth32f}), Usage::depth_target),
            .normal = pass.write(graph.texture("normal", {size, Format::rg32f}), Usage::colour_target)};
}

Surfaces write_geometry_and_material(FrameGraph& graph, Pass& pass, glm::uvec2 size) {
    Surfaces out = write_geometry(graph, pass, size);
    out.albedo = pass.write(graph.texture("albedo", {size, Format::rgba16f}), Usage::colour_target);
    return out;
}

void read_geometry(Pass& pass, const Surfaces& surfaces) {
    pass.read(*surfaces.depth, {Usage::sampled, UNIT_DEPTH});
    pass.read(*surfaces.normal, {Usage::sampled, UNIT_NORMAL});
}

void read_geometry_and_material(Pass& pass, const Surfaces& surfaces) {
    read_geometry(pass, surfaces);
    pass.read(*surfaces.albedo, {Usage::sampled, UNIT_ALBEDO});
}

void test_depth(Pass& pass, const Surfaces& surfaces) {
    pass.read(*surfaces.depth, Usage::depth_target);
}

}  // namespace candela
