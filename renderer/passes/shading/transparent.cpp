#include "renderer/passes/shading/transparent.hpp"

#include <fmt/format.h>
#include <algorithm>

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/gpu/loop_parts.hpp"
#include "renderer/passes/surfaces/draw_scene.hpp"

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

/// Most lights of a scene with blended surfaces. These cannot be shaded in several draws, because each draw
/// would cover what the draws before it have added.
constexpr std::uint32_t most_lights = 16384;

void check_lights(std::size_t lights) {
    if (lights > most_lights) {
        throw gl::GlError(
            fmt::format("{} lights: where there are blended surfaces, {} are possible", lights, most_lights));
    }
}

void draw_blended(Gpu& gpu, const SortedDraw& next) {
    if (next.group->material->double_sided) {
        gl::RasterState backs = covering;
        backs.culling = gl::Culling::front;
        draw_in_group(gpu, *next.group, next.draw, 1, backs);
    }
    draw_in_group(gpu, *next.group, next.draw, 1, covering);
}

}  // namespace

TextureHandle add_transparent(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const Lighting& lighting,
                              const ViewData& view, const Surfaces& surfaces, TextureHandle radiance,
                              const TransparentParts& parts) {
    return graph.add("transparent", [&](Pass& pass) {
        pass.tag(Workload::pixels);
        read_meshes(pass, scene);
        read_lighting(pass, lighting);
        pass.read(scene.placement);
        pass.read(view.camera);
        read_view(pass, view);
        test_depth(pass, surfaces);
        std::vector<std::string> variant = mesh_variant(scene, lighting_variant(lighting));
        variant.emplace_back("BLENDED");
        if (parts.emission) variant.emplace_back("EMISSION");
        if (parts.glass) variant.emplace_back("GLASS");
        const gl::Program* const program =
            scene.kinds.blended
                ? &gpu.program({"surfaces/mesh_surface.vert", "shading/forward.frag"}, variant)
                : nullptr;
        const TextureHandle out = pass.write(radiance, Usage::colour_target);
        pass.run([=, &gpu](Execution& run) {
            const std::vector<SortedDraw> sorted =
                back_to_front(run.value(scene.layout), run.value(scene.placement), run.value(view.camera));
            if (sorted.empty()) return;
            check_lights(run.value(lighting.lights.table).entries.size());
            bind_lighting(gpu, lighting);
            bind_meshes(gpu, run, scene);
            program->use(loop_parts(most_lights, most_lights).front());
            for (const SortedDraw& next : sorted) {
                draw_blended(gpu, next);
            }
        });
        return out;
    });
}

}  // namespace candela
