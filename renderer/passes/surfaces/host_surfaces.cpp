#include "renderer/passes/surfaces/host_surfaces.hpp"

#include <array>
#include <glm/matrix.hpp>
#include <string>
#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/passes/surfaces/draw_scene.hpp"
#include "shaders/bindings.glsl"

namespace candela {

HostSurfaceInputs import_host_surfaces(FrameGraph& graph, bool material) {
    const TextureDesc any;  // the host's sizes and formats are known only to the shader
    HostSurfaceInputs inputs{.depth = graph.texture("host depth", any, Lifetime::imported),
                             .normal = graph.texture("host normal", any, Lifetime::imported),
                             .albedo = graph.texture("host albedo", any, Lifetime::imported),
                             .material = {},
                             .description = graph.import_value<HostSurfaces>("host surfaces")};
    if (material) inputs.material = graph.texture("host material", any, Lifetime::imported);
    return inputs;
}

Surfaces add_host_surfaces(FrameGraph& graph, Gpu& gpu, const HostSurfaceInputs& inputs, const ViewData& view,
                           bool glossy, std::optional<ValueHandle<CheckedSurfaces>> checked) {
    return graph.add("host-surfaces", [&](Pass& pass) {
        pass.note(view.workload);
        pass.read(inputs.albedo, {Usage::sampled, UNIT_ALBEDO});
        pass.read(inputs.normal, {Usage::sampled, UNIT_NORMAL});
        pass.read(inputs.depth, {Usage::sampled, UNIT_DEPTH});
        if (glossy) pass.read(inputs.material.value(), {Usage::sampled, UNIT_GLOSS});
        pass.read(inputs.description);
        if (checked) pass.read(*checked);
        read_view(pass, view);
        const MaterialParts parts{.glossy = glossy};
        const gl::Program& program =
            gpu.program({"output/fullscreen.vert", "surfaces/host_surfaces.frag"}, material_variant(parts));
        const Surfaces out = write_geometry_and_material(graph, pass, view, parts);
        pass.run([=, &gpu, &program, description = inputs.description](Execution& run) {
            const HostSurfaces& host = run.value(description);
            for (const GLuint unit : std::array<GLuint, 3>{UNIT_ALBEDO, UNIT_NORMAL, UNIT_DEPTH}) {
                gpu.nearest().bind(unit);
            }
            if (glossy) gpu.nearest().bind(UNIT_GLOSS);
            gpu.clear_colour_and_depth();
            gpu.draw_fullscreen(program,
                                {{"view_from_host_clip", glm::inverse(host.clip_from_view)},
                                 {"clip_depth_from_0", host.clip_depth_from_0},
                                 {"empty_depth", host.empty_depth},
                                 {"normal_encoding", static_cast<std::uint32_t>(host.normal_encoding)},
                                 {"world_from_normal", host.world_from_normal}},
                                nearest_surfaces);
        });
        return out;
    });
}

}  // namespace candela
