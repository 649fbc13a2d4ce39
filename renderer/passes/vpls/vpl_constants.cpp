#include "renderer/passes/vpls/vpl_constants.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <type_traits>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"

namespace candela {
namespace {

// Least size of an atlas layer, in texels and in slots along a side. Layers then hold many small slots or a
// few large ones: little of the last layer is wasted, and the layers are few enough for any driver.
constexpr std::uint32_t least_side = 512;
constexpr std::uint32_t least_tiles = 4;

VplAtlas atlas_of_scene(const VplVisibilitySettings& settings, std::uint32_t maps,
                        const SceneMetrics& metrics, const gl::Limits& limits) {
    if (settings.method != VplVisibility::maps) return {};
    VplAtlas atlas = plan_vpl_atlas(settings.map_resolution, maps, limits);
    atlas.near = metrics.scale() > 0.0F ? 0x1p-18F * metrics.scale() : 1.0F;
    return atlas;
}

gpu::VplConstants constants_of(const VplCounts& counts, const SceneMetrics& metrics, const VplAtlas& atlas) {
    return {.count = counts.sources(),
            .first_emitter = counts.mapped(),
            .first_sky_patch = counts.mapped() + counts.emitters,
            .ray_offset = metrics.ray_offset(),
            .map_resolution = atlas.resolution,
            .map_tiles = atlas.tiles,
            .map_side = static_cast<float>(atlas.side),
            .map_near = atlas.near,
            .foci = {},
            .mapped = counts.mapped(),
            .first_direction = counts.sources() - counts.directions,
            .mean_record = counts.surfels};
}

static_assert(std::extent_v<decltype(gpu::VplConstants::foci)> == SURFEL_MAP_FOCI);

void write_foci(gpu::VplConstants& constants, const SurfelMaps& maps) {
    for (std::size_t i = 0; i < maps.foci.size(); ++i) {
        constants.foci[i] = glm::vec4(maps.foci[i].centre, maps.foci[i].radius);
    }
}

}  // namespace

VplAtlas plan_vpl_atlas(std::uint32_t resolution, std::uint32_t maps, const gl::Limits& limits) {
    VplAtlas atlas{.resolution = resolution};
    atlas.side = std::min(std::bit_ceil(std::max(least_side, least_tiles * resolution)), limits.texture_size);
    atlas.tiles = atlas.side / resolution;
    if (atlas.tiles == 0) {
        throw gl::GlError(fmt::format("depth maps of VPLs of {} texels a side: the driver allows {}",
                                      resolution, limits.texture_size));
    }
    const std::uint32_t of_layer = atlas.tiles * atlas.tiles;
    atlas.layers = std::max((maps + of_layer - 1) / of_layer, 1U);
    if (atlas.layers > limits.texture_layers) {
        throw gl::GlError(
            fmt::format("depth maps of {} VPLs, {} texels a side, fill {} layers; the driver allows {}", maps,
                        resolution, atlas.layers, limits.texture_layers));
    }
    return atlas;
}

VplCommon add_vpl_constants(FrameGraph& graph, const Gpu& gpu, ValueHandle<SceneMetrics> metrics,
                            ValueHandle<VplCounts> counts, std::optional<ValueHandle<SurfelMaps>> maps,
                            const VplVisibilitySettings& settings) {
    return graph.add("vpl-constants", [&](Pass& pass) {
        pass.read(metrics);
        pass.read(counts);
        if (maps) pass.read(*maps);
        pass.parameter(settings);
        const VplCommon out{
            .atlas = pass.write(graph.value<VplAtlas>("vpl atlas")),
            .constants = pass.write(growing_buffer<gpu::VplConstants>(graph, "vpl constants"), Usage::copy)};
        pass.run([=, &gpu](Execution& run) {
            const SceneMetrics& scene = run.value(metrics);
            const VplCounts& vpls = run.value(counts);
            const VplAtlas atlas = atlas_of_scene(settings, vpls.mapped(), scene, gpu.device().limits());
            gpu::VplConstants constants = constants_of(vpls, scene, atlas);
            if (maps) write_foci(constants, run.value(*maps));
            upload_one(gpu, run, out.constants, constants);
            run.set(out.atlas, atlas);
        });
        return out;
    });
}

void read_vpl_constants(Pass& pass, const VplCommon& common) {
    pass.read(common.constants, {Usage::uniform, UNIFORMS_VPLS});
}

}  // namespace candela
