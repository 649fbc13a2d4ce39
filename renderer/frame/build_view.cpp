#include "renderer/frame/build_view.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <candela/extension.hpp>
#include <candela/graph/errors.hpp>
#include "renderer/frame/frame_budget.hpp"
#include "renderer/passes/indirect/vpl_gather.hpp"
#include "renderer/passes/mirror/mirror_rays.hpp"
#include "renderer/passes/output/accumulate.hpp"
#include "renderer/passes/output/enlarge.hpp"
#include "renderer/passes/output/tone_map.hpp"
#include "renderer/passes/receivers/point_lighting.hpp"
#include "renderer/passes/shading/deferred.hpp"
#include "renderer/passes/shading/emission.hpp"
#include "renderer/passes/shading/forward.hpp"
#include "renderer/passes/shading/transparent.hpp"
#include "renderer/passes/sky/background.hpp"
#include "renderer/passes/surfaces/depth_prepass.hpp"
#include "renderer/passes/surfaces/gbuffer.hpp"
#include "renderer/passes/surfaces/host_surfaces_check.hpp"
#include "renderer/passes/view/view_cull.hpp"

namespace candela {
namespace {

/// Most VPLs that a blended surface evaluates where solid surfaces are interleaved. With fewer, the pattern
/// of which pixel evaluates which VPLs would be visible.
constexpr std::uint32_t most_vpls_of_blended = 1024;

/// Parts that the host asks for, of a view or for its extensions.
FrameParts asked_parts(FrameParts keep, std::span<const Extension> extensions) {
    for (const Extension& extension : extensions) {
        keep.depth |= extension.needs.depth;
        keep.normal |= extension.needs.normal;
        keep.albedo |= extension.needs.albedo;
        keep.indirect |= extension.needs.indirect;
    }
    return keep;
}

bool shows_emitters(const SharedFrame& shared) {
    return shared.contents.emitters && shows_sources(shared.configuration.show);
}

/// Whether the surfaces of a view may be glossy.
bool has_gloss(const SharedFrame& shared, const ViewHandles& view) {
    return view.host ? view.host->material.has_value() : shared.contents.glossy;
}

/// Whether light is shown that glossy surfaces reflect in the mirror direction. The irradiance is shown as if
/// they were white.
bool shows_mirrors(const SharedFrame& shared, const ViewHandles& view) {
    const Show show = shared.configuration.show;
    return has_gloss(shared, view) && shows_light(show) && show != Show::irradiance;
}

/// What is used of the materials of a view's surfaces.
MaterialParts shaded_parts(const SharedFrame& shared, const ViewHandles& view) {
    const Show show = shared.configuration.show;
    const bool shows_gloss = show == Show::roughness || show == Show::metalness;
    const bool shows_bumps = shows_light(show) || show == Show::normals;
    return {.glossy = shows_mirrors(shared, view) || (has_gloss(shared, view) && shows_gloss),
            .bumpy = shared.contents.bumpy && !view.host && shows_bumps};
}

/// That of the shading path. Where there are no surfaces, nothing is found before shading, which then clears
/// the picture.
SurfaceStage surface_stage(const SharedFrame& shared) {
    return shared.contents.surfaces.any() ? info_of(shared.configuration.path).surfaces
                                          : SurfaceStage::forward;
}

/// The surfaces as far as they are found before they are shaded. `asked`: parts that passes other than that
/// which shades need.
Surfaces find_surfaces(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared, const SceneData& seen,
                       const ViewData& view, const ViewHandles& out, const FrameParts& asked) {
    const SurfaceStage stage = surface_stage(shared);
    if (stage == SurfaceStage::gbuffer || asked.albedo) {
        return add_gbuffer(graph, gpu, seen, view, shaded_parts(shared, out));
    }
    if (stage == SurfaceStage::forward_after_prepass || asked.depth || asked.normal) {
        return add_depth_prepass(graph, gpu, seen, view);
    }
    return {};
}

/// The surfaces that the host has drawn.
Surfaces read_surfaces(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared, const ViewData& view,
                       const ViewHandles& out) {
    std::optional<ValueHandle<CheckedSurfaces>> checked;
    if (gpu.checked()) {
        checked =
            add_host_surfaces_check(graph, gpu, *out.host, view.camera, shared.lit.scene, shared.lit.tracing);
    }
    return add_host_surfaces(graph, gpu, *out.host, view, shaded_parts(shared, out).glossy, checked);
}

/// The light lists of the shading path; none if each surface evaluates all lights. `depth` bounds tiles.
std::optional<LightLists> add_lists(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                                    const LitScene& lit, const ViewData& view,
                                    std::optional<TextureHandle> depth) {
    const LightList list = info_of(configuration.path).lights;
    switch (shows_light(configuration.show) ? list : LightList::all) {
        case LightList::all:
            break;
        case LightList::tile: {
            const LightGrid grid = add_tile_grid(graph, gpu, view.size, configuration.lists);
            return add_light_tiles(graph, gpu, {lit.lights, view, grid}, depth);
        }
        case LightList::cluster: {
            const LightGrid grid = add_cluster_grid(graph, gpu, view.camera, lit.tracing.metrics, view.size,
                                                    configuration.lists);
            return add_light_clusters(graph, gpu, {lit.lights, view, grid});
        }
    }
    return std::nullopt;
}

/// Irradiance that is gathered from the VPLs before surfaces are shaded.
GatheredLight gather_vpls(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces, const SharedFrame& shared,
                          const ViewData& view, ViewHandles& out) {
    const SharedVpls& vpls = *shared.vpls;
    const bool directed = shaded_parts(shared, out).bumpy;
    const GatheredVpls gathered =
        add_vpl_gather(graph, gpu, surfaces, vpls.light, vpls.order, view, out.interleave, directed);
    if (out.interleave == 1) return gathered.light;
    const std::uint32_t filled_from = shared.quality.scale < 1.0F ? 4 : 2;
    out.indirect = add_vpl_reconstruct(graph, gpu, surfaces, gathered, vpls.light, view, filled_from);
    return out.indirect->light;
}

/// What the passes that shade read, all but gathered light.
Lighting lighting_of(const SharedFrame& shared, const ViewHandles& view) {
    Lighting lighting{.lights = shared.lit.lights,
                      .lists = view.lists,
                      .show = shared.configuration.show,
                      .materials = shaded_parts(shared, view),
                      .mirror_rays = shows_mirrors(shared, view)};
    if (shared.configuration.shadows.enabled && shows_direct(lighting.show)) {
        lighting.shadow_rays = shared.lit.tracing;
    }
    if (shared.vpls) lighting.vpls = shared.vpls->light;
    return lighting;
}

/// Lighting of blended surfaces. They evaluate VPLs while they are shaded, because the gathered irradiance is
/// that of the solid surface at the pixel. They lie in front of the depths that bound the light lists, so
/// they get lists without depth bounds.
Lighting lighting_of_blended(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared, const ViewHandles& out) {
    const ShadingPathInfo& path = info_of(shared.configuration.path);
    Lighting lighting = lighting_of(shared, out);
    lighting.mirror_rays = false;
    if (out.interleave > 1) lighting.most_vpls = most_vpls_of_blended;
    if (out.lists && path.lights == LightList::tile && path.surfaces != SurfaceStage::forward) {
        lighting.lists = add_blended_light_tiles(graph, gpu, out.lists->inputs, shared.lit.scene.layout);
    }
    return lighting;
}

/// A texture of a view's frame that extensions may replace.
struct ReplaceablePart {
    std::string_view name;
    std::optional<TextureHandle> ViewFrame::*texture;
};
constexpr std::array<ReplaceablePart, 9> replaceable_parts{{{"depth", &ViewFrame::depth},
                                                            {"normal", &ViewFrame::normal},
                                                            {"albedo", &ViewFrame::albedo},
                                                            {"mirror", &ViewFrame::mirror},
                                                            {"gloss", &ViewFrame::gloss},
                                                            {"bumps", &ViewFrame::bumps},
                                                            {"indirect", &ViewFrame::indirect},
                                                            {"indirect_flow", &ViewFrame::indirect_flow},
                                                            {"radiance", &ViewFrame::radiance}}};

std::string text_of(const TextureDesc& desc) {
    std::string text = fmt::format("{}x{} texels of {}", desc.size.x, desc.size.y, to_string(desc.format));
    if (desc.shape != TextureShape::flat) {
        text += fmt::format(", {} of {} layers", to_string(desc.shape), desc.layers);
    }
    if (desc.mips > 1) text += fmt::format(", {} mip levels", desc.mips);
    return text;
}

/// Throws GraphError if an extension has replaced a part by one that what follows could not read as the part.
void require_alike(const FrameGraph& graph, const Extension& extension, const ViewFrame& given,
                   const ViewFrame& returned) {
    for (const auto& [name, texture] : replaceable_parts) {
        const std::optional<TextureHandle>& before = given.*texture;
        const std::optional<TextureHandle>& after = returned.*texture;
        if (before == after) continue;
        const auto refuse = [&, part = name](std::string_view what) {
            throw GraphError(fmt::format("the extension '{}' {} '{}'{}", extension.name,
                                         after ? "returns a part" : "removes the part", part, what));
        };
        if (!after) refuse("");
        if (!before) refuse(", which it was not given");
        const std::optional<TextureDesc> found = graph.desc(*after);
        const std::optional<TextureDesc> expected = graph.desc(*before);
        if (found && found != expected) {
            refuse(fmt::format(" of {} instead of {}", text_of(*found), text_of(*expected)));
        }
    }
}

/// Adds the passes of the extensions at this place; appends their names to `out`.
void extend(FrameGraph& graph, const SharedFrame& shared, ExtensionPlace place, ViewFrame& parts,
            ViewHandles& out) {
    for (const Extension& extension : shared.extensions) {
        if (extension.place != place) continue;
        const ViewFrame given = parts;
        const std::size_t others = graph.pass_names().size();
        extension.declare(graph, parts);
        require_alike(graph, extension, given, parts);
        const std::vector<std::string_view> names = graph.pass_names();
        out.host_passes.insert(out.host_passes.end(), names.begin() + static_cast<std::ptrdiff_t>(others),
                               names.end());
    }
}

void set_vpls(ViewFrame& parts, const Vpls& vpls) {
    if (const auto* const traced = std::get_if<TracedVpls>(&vpls.records)) {
        parts.traced_vpls = traced->vpls;
        return;
    }
    const auto& lit = std::get<LitSurfels>(vpls.records);
    parts.lit_surfels = lit.surfels;
    parts.lit_emitters = lit.emitters;
    if (lit.sky) parts.sky_patches = lit.sky->patches;
}

ViewFrame first_parts(const Gpu& gpu, const SharedFrame& shared, std::size_t index, const ViewData& view,
                      const Surfaces& surfaces) {
    ViewFrame parts{.index = index,
                    .size = view.size,
                    .view = view.camera,
                    .depth = surfaces.depth,
                    .normal = surfaces.normal,
                    .albedo = surfaces.albedo,
                    .mirror = surfaces.mirror,
                    .gloss = surfaces.gloss,
                    .bumps = surfaces.bumps,
                    .lights = shared.lit.lights.buffer};
    if (shows_light(shared.configuration.show)) {
        parts.lighting =
            make_point_lighting(gpu, lighting_of_points(shared.configuration, shared.lit, shared.vpls));
    }
    if (shared.vpls) set_vpls(parts, shared.vpls->light.vpls);
    return parts;
}

/// The surfaces, of which extensions may have replaced parts.
Surfaces surfaces_of(const ViewFrame& parts) {
    return {.depth = parts.depth,
            .normal = parts.normal,
            .albedo = parts.albedo,
            .mirror = parts.mirror,
            .gloss = parts.gloss,
            .bumps = parts.bumps};
}

/// The light that solid surfaces reflect: sets the parts `radiance` and `depth`.
void shade(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared, const SceneData& seen,
           const ViewData& view, const ViewHandles& out, ViewFrame& parts) {
    Lighting lighting = lighting_of(shared, out);
    if (parts.indirect) {
        lighting.indirect = {*parts.indirect, parts.indirect_flow};
        lighting.vpls.reset();
    }
    if (out.host || surface_stage(shared) == SurfaceStage::gbuffer) {
        parts.radiance = add_deferred(graph, gpu, surfaces_of(parts), lighting, view);
        return;
    }
    const ForwardResults shaded = add_forward(graph, gpu, seen, lighting, view, surfaces_of(parts));
    parts.radiance = shaded.radiance;
    parts.depth = shaded.surfaces.depth;
}

/// The radiance that mirrored surfaces reflect. None: only sources are shown in mirrors. `gathers`: as the
/// view gathers the light of VPLs.
std::optional<TextureHandle> shade_mirrored(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared,
                                            const ViewData& view, const ViewHandles& out,
                                            const Surfaces& mirrored, bool gathers) {
    if (!shows_indirect(shared.configuration.show)) return std::nullopt;
    Lighting lighting = lighting_of(shared, out);
    lighting.show = Show::total;
    lighting.lists.reset();  // they are of what the view sees
    lighting.materials = parts_of(mirrored);
    lighting.mirror_rays = false;
    if (shared.configuration.shadows.enabled) lighting.shadow_rays = shared.lit.tracing;
    if (gathers) {
        const GatheredVpls gathered = add_vpl_gather(graph, gpu, mirrored, shared.vpls->light,
                                                     shared.vpls->order, view, out.interleave, false);
        lighting.indirect = out.interleave == 1 ? gathered.light
                                                : add_rough_reconstruct(graph, gpu, mirrored, gathered, view);
        lighting.vpls.reset();
    }
    return add_deferred(graph, gpu, mirrored, lighting, view);
}

/// What glossy surfaces show in the mirror direction.
void add_mirrored(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared, const ViewData& view,
                  const ViewHandles& out, std::optional<TextureHandle> sky_picture, ViewFrame& parts) {
    MirroredSources sources{.emitters = shows_emitters(shared), .bumpy = shared.contents.bumpy};
    if (shared.vpls) sources.vpls = shared.vpls->light;
    if (sky_picture) {
        const Sky& sky = *shared.lit.sky;
        sources.sky = {.sky = sky, .picture = *sky_picture, .tree = add_sky_tree(graph, gpu, sky)};
    }
    const Scope scope = graph.scope({.name_ending = " (mirrored)"});
    const Surfaces surfaces = surfaces_of(parts);
    const MirroredSurfaces mirrored =
        add_mirror_rays(graph, gpu, surfaces, shared.lit.tracing, sources, view, out.averaged);
    const auto reflected =
        shade_mirrored(graph, gpu, shared, view, out, mirrored.surfaces, parts.indirect.has_value());
    parts.radiance =
        add_mirror_resolve(graph, gpu, surfaces, sources, mirrored, reflected, view, *parts.radiance);
}

/// What the surfaces and the sky emit.
void add_sources(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared, const SceneData& seen,
                 const ViewData& view, std::optional<TextureHandle> sky_picture, ViewFrame& parts) {
    if (shows_emitters(shared)) {
        parts.radiance = add_emission(graph, gpu, seen, view, surfaces_of(parts), *parts.radiance);
    }
    if (sky_picture) {
        parts.radiance = add_background(graph, gpu, *shared.lit.sky, *sky_picture, view, surfaces_of(parts),
                                        *parts.radiance);
    }
}

/// The surfaces in the size of the target, and the view of that size.
std::pair<Surfaces, ViewData> add_target_surfaces(FrameGraph& graph, Gpu& gpu, const SceneData& seen,
                                                  glm::uvec2 target, const ViewData& view,
                                                  const ViewHandles& out) {
    const Scope scope = graph.scope({.name_ending = " (target's size)"});
    ViewData in_target = add_view_upload(graph, gpu, view.camera, target);
    in_target.workload = Workload::other;  // the same for every size of the picture
    if (out.host) {
        return {add_host_surfaces(graph, gpu, *out.host, in_target, false, std::nullopt), in_target};
    }
    return {add_depth_prepass(graph, gpu, seen, in_target), in_target};
}

/// Draws the picture to the target. If it has fewer pixels, the surfaces are found once more in the size of
/// the target.
void show(FrameGraph& graph, Gpu& gpu, const SceneData& seen, const Display& display, glm::uvec2 target,
          const ViewData& view, const ViewHandles& out, const ViewFrame& parts) {
    if (view.size == target) {
        return add_tone_map(graph, gpu, *parts.radiance, out.target, out.picture, display);
    }
    const TextureHandle colours = add_tone_map(graph, gpu, *parts.radiance, view.size, display);
    const auto [in_target, target_view] = add_target_surfaces(graph, gpu, seen, target, view, out);
    add_enlarge(graph, gpu, {colours, *parts.depth, in_target, target_view}, out.target, out.picture);
}

}  // namespace

Lighting lighting_of_points(const Configuration& configuration, const LitScene& lit,
                            const std::optional<SharedVpls>& vpls) {
    Lighting lighting{.lights = lit.lights, .show = configuration.show};
    if (configuration.shadows.enabled) lighting.shadow_rays = lit.tracing;
    if (vpls) lighting.vpls = vpls->light;
    return lighting;
}

void build_view(FrameGraph& graph, Gpu& gpu, const SharedFrame& shared, const ViewShape& shape,
                std::size_t index, ViewHandles& out) {
    const Configuration& configuration = shared.configuration;
    const ViewData view =
        add_view_upload(graph, gpu, out.camera, rendered_size(shape.target, shared.quality));
    const SceneData seen = add_view_cull(graph, gpu, shared.lit.scene, shared.lit.tracing, out.camera);

    FrameParts asked = asked_parts(shape.keep, shared.extensions);
    if (shared.vpls) {
        out.interleave = std::max(interleaving(configuration.interleave, shared.vpls->count, shape.target),
                                  shared.quality.interleave);
    }
    // VPLs are also gathered without interleaving if they may be too many for one loop of the shading pass:
    // cells that walls cut have several surfels, so that there may be more than were asked for.
    const bool gathers =
        shared.vpls && (out.interleave > 1 || asked.indirect ||
                        2 * shared.vpls->count > vpls_a_loop(gpu.device().limits(), shared.vpls->light));
    const bool estimates = shape.estimate_error && shared.vpls && shared.vpls->other;
    asked.depth |= gathers || estimates;
    const bool mirrors = shows_mirrors(shared, out);
    asked.albedo |= mirrors;  // the passes of mirrors read all of the G-buffer

    const Surfaces found = out.host ? read_surfaces(graph, gpu, shared, view, out)
                                    : find_surfaces(graph, gpu, shared, seen, view, out, asked);
    ViewFrame parts = first_parts(gpu, shared, index, view, found);
    extend(graph, shared, ExtensionPlace::after_surfaces, parts, out);

    if (out.host || shared.contents.surfaces.any()) {
        const bool bounds_lists = out.host || info_of(configuration.path).surfaces != SurfaceStage::forward;
        out.lists =
            add_lists(graph, gpu, configuration, shared.lit, view, bounds_lists ? parts.depth : std::nullopt);
    }
    if (out.lists) {
        parts.list_first = out.lists->first;
        parts.list_count = out.lists->count;
        parts.list_entries = out.lists->entries;
    }
    if (gathers) {
        const GatheredLight gathered = gather_vpls(graph, gpu, surfaces_of(parts), shared, view, out);
        parts.indirect = gathered.irradiance;
        parts.indirect_flow = gathered.flow;
    }
    if (estimates) {
        out.samples =
            add_vpl_error(graph, gpu, surfaces_of(parts), shared.vpls->light, *shared.vpls->other, view);
    }

    shade(graph, gpu, shared, seen, view, out, parts);
    std::optional<TextureHandle> sky_picture;
    if ((!out.host || mirrors) && shared.lit.sky && shows_sources(configuration.show)) {
        sky_picture = add_sky_picture(graph, gpu, *shared.lit.sky);
    }
    if (mirrors) add_mirrored(graph, gpu, shared, view, out, sky_picture, parts);
    if (!out.host) add_sources(graph, gpu, shared, seen, view, sky_picture, parts);
    extend(graph, shared, ExtensionPlace::after_shading, parts, out);
    if (!out.host) {
        const Lighting lighting = lighting_of_blended(graph, gpu, shared, out);
        parts.radiance =
            add_transparent(graph, gpu, seen, lighting, view, surfaces_of(parts), *parts.radiance,
                            {.emission = shows_emitters(shared), .glass = shared.contents.glass});
    }
    if (out.averaged) parts.radiance = add_accumulate(graph, gpu, *parts.radiance, *out.averaged, view.size);
    extend(graph, shared, ExtensionPlace::before_tone_map, parts, out);
    show(graph, gpu, seen, display_of(configuration), shape.target, view, out, parts);
    out.parts = parts;
}

void keep_parts(FrameGraph& graph, const FrameParts& keep, const ViewHandles& view) {
    if (keep == FrameParts{} && !view.samples) return;
    const ViewFrame& parts = view.parts;
    graph.add("keep", [&](Pass& pass) {
        pass.side_effect();
        const auto read = [&](bool wanted, const std::optional<TextureHandle>& texture) {
            if (wanted && texture) pass.read(*texture, Usage::sampled);
        };
        const auto read_vpls = [&](const auto& buffer) {
            if (keep.vpls && buffer) pass.read(*buffer, Usage::storage);
        };
        read(keep.depth, parts.depth);
        read(keep.normal, parts.normal);
        read(keep.albedo, parts.albedo);
        read(keep.indirect, parts.indirect);
        read(keep.radiance, parts.radiance);
        read_vpls(parts.traced_vpls);
        read_vpls(parts.lit_surfels);
        read_vpls(parts.lit_emitters);
        read_vpls(parts.sky_patches);
        if (view.samples) {
            pass.read(view.samples->shown, Usage::storage);
            pass.read(view.samples->other, Usage::storage);
        }
    });
}

}  // namespace candela
