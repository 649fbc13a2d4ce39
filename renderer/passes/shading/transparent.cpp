#include "renderer/passes/shading/transparent.hpp"

#include <algorithm>

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/passes/surfaces/draw_scene.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

struct SortedDraw {
    const SceneLayout::Group* group;
    std::uint32_t draw;
    float depth;  ///< metres in front of the viewer
};

std::vector<SortedDraw> back_to_front(const SceneLayout& layout, const ScenePlacement& placement,
                                      const CameraView& view) {
    std::vector<SortedDraw> sorted;
    layout.visit_blended([&](const SceneLayout::Group& group, std::uint32_t draw) {
        const SceneLayout::Drawable& drawable = layout.drawables[layout.draws[draw].base_instance];
        const Box& box = bounds_of(drawable, placement.deformed);
        const glm::vec4 middle((box.lower + box.upper) * 0.5F, 1.0F);
        const glm::vec4 centre = view.view_from_world * (placement.world[drawable.item] * middle);
        sorted.push_back({&group, draw, -centre.z});
    });
    std::ranges::stable_sort(sorted, std::greater{}, &SortedDraw::depth);
    return sorted;
}

/// The shader multiplies radiance by alpha. Its second output is the share of what is behind that the surface
/// covers.
constexpr gl::RasterState covering{.depth_test = gl::DepthTest::nearer,
                                   .writes_depth = false,
                                   .blending = gl::Blending::cover,
                                   .culling = gl::Culling::back};

void draw_blended(Gpu& gpu, const SortedDraw& next) {
    if (next.group->material->double_sided) {
        gl::RasterState backs = covering;
        backs.culling = gl::Culling::front;
        draw_in_group(gpu, *next.group, next.draw, 1, backs);
    }
    draw_in_group(gpu, *next.group, next.draw, 1, covering);
}

/// All that the passes here read and draw.
struct BlendedSurfaces {
    Gpu* gpu;
    SceneData scene;
    Lighting lighting;
    ViewData view;
    const gl::Program* program;  ///< null if the scene has none
};

BlendedSurfaces read_blended(Pass& pass, Gpu& gpu, const SceneData& scene, const Lighting& lighting,
                             const ViewData& view, const Surfaces& surfaces, const TransparentParts& parts) {
    pass.note(Workload::pixels);
    read_meshes(pass, scene);
    read_lighting(pass, lighting);
    pass.read(scene.placement);
    pass.read(view.camera);
    read_view(pass, view);
    test_depth(pass, surfaces);
    std::vector<std::string> variant = mesh_variant(scene, lighting_variant(gpu.device().limits(), lighting));
    variant.emplace_back("BLENDED");
    if (parts.emission) variant.emplace_back("EMISSION");
    if (parts.glass) variant.emplace_back("GLASS");
    const gl::Program* const program =
        scene.kinds.blended ? &gpu.program({"surfaces/mesh_surface.vert", "shading/forward.frag"}, variant)
                            : nullptr;
    return {&gpu, scene, lighting, view, program};
}

std::vector<SortedDraw> sorted_draws(const Execution& run, const BlendedSurfaces& blended) {
    return back_to_front(run.value(blended.scene.layout), run.value(blended.scene.placement),
                         run.value(blended.view.camera));
}

std::vector<gl::Uniforms> parts_of(const Execution& run, const BlendedSurfaces& blended) {
    return lighting_parts(blended.gpu->device().limits(), run, blended.lighting, 1);
}

void draw_part(Execution& run, const BlendedSurfaces& blended, const std::vector<SortedDraw>& sorted,
               const gl::Uniforms& part) {
    bind_lighting(*blended.gpu, blended.lighting);
    bind_meshes(*blended.gpu, run, blended.scene);
    blended.program->use(part);
    for (const SortedDraw& next : sorted) {
        draw_blended(*blended.gpu, next);
    }
}

/// Adds node `transparent-parts` (raster and compute), for drivers that stop long loops: draws the surfaces
/// again with each further part of the light lists, over black, and adds the pictures to `radiance`. That is
/// the same as drawing all light at once, because `over` is linear in what lies over and what lies below.
TextureHandle add_further_parts(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const Lighting& lighting,
                                const ViewData& view, const Surfaces& surfaces, TextureHandle radiance,
                                const TransparentParts& features) {
    return graph.add("transparent-parts", [&](Pass& pass) {
        const BlendedSurfaces blended = read_blended(pass, gpu, scene, lighting, view, surfaces, features);
        const gl::Program& adder = gpu.program({"shading/add_part.comp"});
        const TextureHandle part = pass.write(
            graph.texture("part of blended surfaces", {view.size, Format::rgba32f}), Usage::colour_target);
        const TextureHandle out = pass.write(radiance, {Usage::storage, IMAGE_RADIANCE});
        pass.run([=, &gpu, &adder](Execution& run) {
            const std::vector<SortedDraw> sorted = sorted_draws(run, blended);
            const std::vector<gl::Uniforms> parts = parts_of(run, blended);
            ComputeSteps steps(gpu);
            for (std::size_t i = 1; i < parts.size() && !sorted.empty(); ++i) {
                gpu.clear_colour();
                draw_part(run, blended, sorted, parts[i]);
                gpu.gl().BindTextureUnit(UNIT_PART, run.object(part));
                steps.run(adder, {groups(view.size.x, PIXEL_BLOCK), groups(view.size.y, PIXEL_BLOCK)});
            }
        });
        return out;
    });
}

}  // namespace

TextureHandle add_transparent(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const Lighting& lighting,
                              const ViewData& view, const Surfaces& surfaces, TextureHandle radiance,
                              const TransparentParts& features) {
    const TextureHandle out = graph.add("transparent", [&](Pass& pass) {
        const BlendedSurfaces blended = read_blended(pass, gpu, scene, lighting, view, surfaces, features);
        const TextureHandle covered = pass.write(radiance, Usage::colour_target);
        pass.run([=](Execution& run) {
            const std::vector<SortedDraw> sorted = sorted_draws(run, blended);
            if (!sorted.empty()) draw_part(run, blended, sorted, parts_of(run, blended).front());
        });
        return covered;
    });
    const bool in_parts =
        scene.kinds.blended && gpu.device().limits().loop_iterations != gl::Limits{}.loop_iterations;
    return in_parts ? add_further_parts(graph, gpu, scene, lighting, view, surfaces, out, features) : out;
}

}  // namespace candela
