#include "renderer/frame/build_frame.hpp"

#include <algorithm>

#include <candela/extension.hpp>
#include <candela/scene/hierarchy.hpp>
#include "renderer/frame/build_view.hpp"
#include "renderer/passes/indirect/vpl_gather.hpp"
#include "renderer/passes/sky/sky_vpls.hpp"
#include "renderer/passes/surfels/surfel_guide.hpp"
#include "renderer/passes/surfels/surfel_light.hpp"
#include "renderer/passes/surfels/surfel_visibility.hpp"
#include "renderer/passes/vpls/vpl_maps.hpp"
#include "renderer/passes/vpls/vpl_trace.hpp"

namespace candela {
namespace {

LitScene add_scene(FrameGraph& graph, Gpu& gpu, const Configuration& configuration, const FrameShape& shape,
                   FrameHandles& frame) {
    const FrameContents& contents = shape.contents;
    SceneData scene = add_scene_upload(graph, gpu, contents.second_uvs);
    scene.kinds = contents.surfaces;
    const Tracing tracing = add_bvh(graph, gpu, scene);
    frame.metrics = tracing.metrics;
    std::optional<Sky> sky;
    if (contents.sky) sky = add_sky(graph, gpu.scene_check(), sky_patches(configuration.vpls.count));
    frame.lights =
        add_lights(graph, gpu, scene, tracing.metrics, sky, configuration.shadows, shape.quality.scale);
    return {.scene = scene, .tracing = tracing, .lights = frame.lights, .sky = sky};
}

/// For the part of the graph that belongs to one view.
Scope view_scope(FrameGraph& graph, std::size_t index) {
    return graph.scope({.name_ending = view_ending(index)});
}

ViewHandles import_view(FrameGraph& graph, const ViewShape& shape) {
    ViewHandles view;
    view.request = graph.import_value<ViewRequest>("view request");
    view.target = graph.import_value<Target>("target");
    view.picture = graph.texture("target", {shape.target, Format::rgba8}, Lifetime::imported);
    if (shape.host_surfaces) view.host = import_host_surfaces(graph, shape.host_material);
    return view;
}

/// Adds the cameras of the views, and the refinement, if it is on, with whose samples they are seen.
std::optional<ValueHandle<Refinement>> add_cameras(FrameGraph& graph, const Configuration& configuration,
                                                   const LitScene& lit, FrameHandles& frame) {
    std::vector<ValueHandle<CameraView>> requested;
    for (std::size_t i = 0; i < frame.views.size(); ++i) {
        const Scope scope = view_scope(graph, i);
        frame.views[i].camera = add_view(graph, frame.views[i].request);
        requested.push_back(frame.views[i].camera);
    }
    if (!configuration.refinement.enabled) return std::nullopt;
    const auto environment = lit.sky ? std::optional(lit.sky->environment) : std::nullopt;
    frame.refinement_clock = graph.import_value<RefinementClock>("refinement clock");
    const Refined refined = add_refinement(graph, *frame.refinement_clock, lit.scene,
                                           {frame.lights.table, environment}, requested);
    for (std::size_t i = 0; i < frame.views.size(); ++i) {
        const Scope scope = view_scope(graph, i);
        ViewHandles& view = frame.views[i];
        view.averaged = refined.averaged[i];
        if (!view.host) {  // whose samples stay where they are
            view.camera = add_refined_view(graph, view.request, refined.averaged[i]);
        }
    }
    frame.refinement = refined.refinement;
    return refined.refinement;
}

/// The configured VPLs, if any is needed. VPLs also carry the light of the sky and of surfaces that emit
/// light, although it is direct light. A world with such light has the same VPLs for every Show; only their
/// flux differs. Which VPLs a pixel evaluates depends on their number, so that pictures of the direct and of
/// the indirect light add up to the one of the total only if they have all VPLs in common.
struct WantedVpls {
    VplSettings settings;
    float bound = 1.0F;  ///< Configuration::geometry_bound
    ShownLight shown;
    bool emitters = false;    ///< some surfaces emit light
    bool balanced = false;    ///< LitSurfels::balanced
    bool guided = false;      ///< surfels are placed by what lights the picture
    std::uint32_t count = 0;  ///< about how many there will be

    [[nodiscard]] bool any() const { return shown.emitted || shown.reflected; }
};

/// `extended`: there are passes of the host's.
WantedVpls wanted_vpls(const Configuration& configuration, const FrameShape& shape, bool extended) {
    const FrameContents& contents = shape.contents;
    const bool has_emission = contents.emitters || contents.sky;
    // Where there is no surface, none reflects light; but the sky may light what the host draws.
    const bool has_lit = contents.surfaces.any() || shape.receivers || extended ||
                         std::ranges::any_of(shape.views, &ViewShape::host_surfaces);
    WantedVpls wanted{.settings = configuration.vpls,
                      .bound = configuration.geometry_bound,
                      .shown = {.emitted = has_emission && has_lit && shows_direct(configuration.show),
                                .reflected = configuration.indirect && contents.surfaces.any() &&
                                             shows_indirect(configuration.show)},
                      .emitters = contents.emitters};
    if (has_emission) wanted.settings.placement = VplPlacement::surfels;
    if (!configuration.indirect) wanted.settings.bounces = 0;
    wanted.balanced = contents.shares_items && wanted.settings.placement == VplPlacement::surfels &&
                      configuration.visibility.method != VplVisibility::none;
    wanted.guided = wanted.settings.guided && !contents.shares_items && wanted.settings.bounces > 0;
    wanted.count = configuration.indirect ? wanted.settings.count : 0;
    wanted.count += contents.emitters ? emitting_surfels(wanted.settings.count) : 0;
    wanted.count += contents.sky ? sky_patches(wanted.settings.count) : 0;
    wanted.count += wanted.balanced ? COVER_DIRECTIONS : 0;
    return wanted;
}

/// What all sets of surfels have in common.
struct SurfelInputs {
    ValueHandle<SceneMotion> motion;
    SurfelFoci foci;
    SurfelSources sources;
    std::optional<ValueHandle<UpdateClock>> update_clock;  ///< none: all is traced at once
    std::optional<ValueHandle<UpdateClock>> map_clock;     ///< as FrameHandles::map_clock
    std::optional<ValueHandle<bool>> guide_waits;          ///< with a clock: the guide stays in this frame
    std::optional<ValueHandle<SurfelGuide>> guide{};       ///< none: surfels are placed by area alone
};

/// What guides where surfels are placed: the light of a coarse set, which is placed by area and has no depth
/// maps.
ValueHandle<SurfelGuide> add_guide(FrameGraph& graph, Gpu& gpu, const WantedVpls& wanted, const LitScene& lit,
                                   const SurfelInputs& inputs,
                                   ValueHandle<std::vector<ViewRequest>> requests) {
    const Scope scope = graph.scope({.name_ending = " (guide)", .held = inputs.guide_waits});
    VplSettings settings = wanted.settings;
    settings.count = guiding_surfels(settings.count);
    settings.seed = 0;  // all sets have the same guide
    const ValueHandle<SpreadSurfels> spread =
        add_surfel_spread(graph, lit.scene, {}, {.foci = inputs.foci.foci}, settings);
    const Surfels surfels = add_surfels(graph, gpu, lit.scene, lit.tracing, inputs.motion, spread,
                                        inputs.foci.of_maps, settings.count);
    const SurfelVisibility visibility =
        add_surfel_visibility(graph, gpu, lit.tracing, surfels, inputs.motion);
    SurfelSources sources{.lights = lit.lights, .emitters = wanted.emitters, .sky = {}};
    if (lit.sky) sources.sky = add_sky_patches(graph, gpu, *lit.sky, std::nullopt);
    const Vpls light = add_surfel_light(graph, gpu, lit.tracing, visibility, sources, settings.bounces, {});
    return add_surfel_guide(graph, gpu, lit.scene, lit.tracing, requests, spread, visibility, light);
}

SurfelInputs add_surfel_inputs(FrameGraph& graph, Gpu& gpu, const WantedVpls& wanted, const LitScene& lit,
                               std::optional<ValueHandle<Refinement>> refinement, FrameHandles& frame) {
    frame.epoch = graph.import_value<std::uint64_t>("scene epoch");
    frame.requests = graph.import_value<std::vector<ViewRequest>>("view requests");
    if (wanted.settings.updates > 0) {
        frame.update_clock = graph.import_value<UpdateClock>("update clock");
        frame.map_clock = graph.import_value<UpdateClock>("map clock");
        if (wanted.guided) frame.guide_waits = graph.import_value<bool>("whether the guide waits");
    }
    SurfelInputs inputs{
        .motion = add_scene_motion(graph, lit.scene, *frame.epoch),
        .foci = add_surfel_focus(graph, lit.scene, lit.tracing, *frame.requests, wanted.settings.count),
        .sources = {.lights = lit.lights,
                    .emitters = wanted.emitters,
                    .sky = {},
                    .balanced = wanted.balanced},
        .update_clock = frame.update_clock,
        .map_clock = frame.map_clock,
        .guide_waits = frame.guide_waits};
    if (lit.sky) inputs.sources.sky = add_sky_patches(graph, gpu, *lit.sky, refinement);
    if (wanted.guided) inputs.guide = add_guide(graph, gpu, wanted, lit, inputs, *frame.requests);
    return inputs;
}

/// What is traced of a set of surfels, independent of light, and what their depth maps are made of.
struct TracedSet {
    SurfelVisibility visibility;
    MappedVpls mapped;
    std::optional<ValueHandle<WaitingSurfels>> waiting;  ///< SurfelUpdates::waiting
};

/// For what belongs to the set in that place, also in graphs in which the set has another role.
Scope place_scope(FrameGraph& graph, std::optional<std::uint32_t> place) {
    if (!place) return graph.scope({});
    return graph.scope({.key_ending = *place == 0 ? "" : " (odd set)"});
}

TracedSet add_traced_set(FrameGraph& graph, Gpu& gpu, const WantedVpls& wanted, const LitScene& lit,
                         const SurfelSetChoice& set, const SurfelInputs& inputs) {
    const auto clock = wanted.settings.updates > 0 ? inputs.update_clock : std::nullopt;
    const Scope scope = place_scope(graph, set.place);
    const ValueHandle<SpreadSurfels> spread =
        add_surfel_spread(graph, lit.scene, set, {inputs.foci.foci, inputs.guide, clock}, wanted.settings);
    const Surfels surfels =
        add_surfels(graph, gpu, lit.scene, lit.tracing, inputs.motion, spread, inputs.foci.of_maps,
                    wanted.settings.count, clock ? inputs.map_clock : std::nullopt);
    std::optional<SurfelUpdates> updates;
    if (clock) {
        updates =
            add_surfel_updates(graph, spread, surfels, lit.tracing, inputs.motion, inputs.foci, set, *clock);
    }
    const auto tasks = updates ? std::optional(updates->tasks) : std::nullopt;
    const SurfelVisibility visibility =
        add_surfel_visibility(graph, gpu, lit.tracing, surfels, inputs.motion, wanted.balanced, tasks);
    return {.visibility = visibility,
            .mapped = {surfels.counts, MappedSurfels{surfels.surfels, surfels.maps, inputs.motion, tasks}},
            .waiting = updates ? std::optional(updates->waiting) : std::nullopt};
}

/// A set of VPLs with their light, and what their depth maps are made of.
struct VplSet {
    Vpls vpls;
    MappedVpls mapped;
    std::optional<ValueHandle<WaitingSurfels>> waiting;  ///< as in TracedSet
};

VplSet add_surfel_set(FrameGraph& graph, Gpu& gpu, const WantedVpls& wanted, const LitScene& lit,
                      const SurfelSetChoice& choice, const SurfelInputs& inputs) {
    const TracedSet set = add_traced_set(graph, gpu, wanted, lit, choice, inputs);
    return {.vpls = add_surfel_light(graph, gpu, lit.tracing, set.visibility, inputs.sources,
                                     wanted.settings.bounces, wanted.shown),
            .mapped = set.mapped,
            .waiting = set.waiting};
}

VplSet add_path_set(FrameGraph& graph, Gpu& gpu, const WantedVpls& wanted, const LitScene& lit,
                    std::optional<ValueHandle<Refinement>> refinement) {
    const ValueHandle<PathPlan> plan =
        add_vpl_paths(graph, lit.tracing.metrics, lit.lights.table, refinement, wanted.settings);
    const Vpls vpls = add_vpl_trace(graph, gpu, lit.tracing, plan, lit.lights.buffer, wanted.bound);
    return {vpls, {vpls.counts, std::get<TracedVpls>(vpls.records).vpls}, std::nullopt};
}

/// `inputs`: none for VPLs on paths.
VplSet add_vpl_set(FrameGraph& graph, Gpu& gpu, const WantedVpls& wanted, const LitScene& lit,
                   const SurfelSetChoice& choice, const std::optional<SurfelInputs>& inputs) {
    return inputs ? add_surfel_set(graph, gpu, wanted, lit, choice, *inputs)
                  : add_path_set(graph, gpu, wanted, lit, choice.refinement);
}

/// What all VPLs of a set have in common, and their depth maps.
struct MappedSet {
    VplCommon common;
    std::optional<VplMaps> maps;  ///< if visibility is found by maps
};

MappedSet add_mapped_set(FrameGraph& graph, Gpu& gpu, const LitScene& lit,
                         const VplVisibilitySettings& visibility, const MappedVpls& mapped,
                         ValueHandle<VplCounts> counts, std::optional<std::uint32_t> place) {
    const Scope scope = place_scope(graph, place);
    MappedSet set{add_vpl_constants(graph, gpu, lit.tracing.metrics, counts, surfel_maps(mapped), visibility),
                  {}};
    if (visibility.method == VplVisibility::maps) {
        set.maps = add_vpl_maps(graph, gpu, lit.tracing, mapped, set.common);
    }
    return set;
}

/// Makes a part of the next set of surfels. Nothing in the frame reads it.
ValueHandle<WaitingSurfels> prepare_next_set(FrameGraph& graph, Gpu& gpu, const WantedVpls& wanted,
                                             const LitScene& lit, const SurfelSetChoice& choice,
                                             const SurfelInputs& inputs,
                                             const VplVisibilitySettings& visibility) {
    const auto [set, mapped] = [&] {
        const Scope scope = graph.scope({.name_ending = " (next set)"});
        const TracedSet traced = add_traced_set(graph, gpu, wanted, lit, choice, inputs);
        return std::pair(traced, add_mapped_set(graph, gpu, lit, visibility, traced.mapped,
                                                traced.mapped.counts, choice.place));
    }();
    graph.add("keep-next-set", [&set = set, &mapped = mapped](Pass& pass) {
        pass.side_effect();
        pass.read(set.visibility.rows, Usage::storage);
        if (!mapped.maps) return;
        pass.read(mapped.maps->depth, Usage::sampled);
        pass.read(mapped.maps->slopes, Usage::sampled);
    });
    return *set.waiting;
}

/// The light of another set of as many VPLs, with rays instead of depth maps.
VplLight add_other_set(FrameGraph& graph, Gpu& gpu, WantedVpls wanted, const LitScene& lit,
                       const std::optional<SurfelInputs>& inputs, VplVisibilitySettings visibility) {
    wanted.settings.seed += 0x80000000U;  // far from those of refinement
    wanted.settings.updates = 0;
    const Scope scope = graph.scope({.name_ending = " (other set)"});
    const VplSet set = add_vpl_set(graph, gpu, wanted, lit, {}, inputs);
    const bool occluded = visibility.method != VplVisibility::none;
    if (occluded) visibility.method = VplVisibility::rays;
    return {.vpls = set.vpls,
            .common = add_vpl_constants(graph, gpu, lit.tracing.metrics, set.vpls.counts,
                                        surfel_maps(set.mapped), visibility),
            .rays = occluded ? std::optional(lit.tracing) : std::nullopt};
}

/// The light of the wanted VPLs, if any.
std::optional<SharedVpls> add_vpls(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                                   const FrameShape& shape, const LitScene& lit,
                                   std::optional<ValueHandle<Refinement>> refinement, bool extended,
                                   FrameHandles& frame) {
    const FrameContents& contents = shape.contents;
    const WantedVpls wanted = wanted_vpls(configuration, shape, extended);
    if (!wanted.any()) return std::nullopt;
    std::optional<SurfelInputs> inputs;
    SurfelSetChoice choice{.refinement = refinement};
    if (wanted.settings.placement == VplPlacement::surfels) {
        inputs = add_surfel_inputs(graph, gpu, wanted, lit, refinement, frame);
        if (takes_turns(configuration)) choice.place = shape.turn.place;
    }
    const VplSet set = add_vpl_set(graph, gpu, wanted, lit, choice, inputs);
    frame.vpls = set.vpls;
    frame.waiting = set.waiting;
    const VplVisibilitySettings& visibility = configuration.visibility;
    const MappedSet mapped =
        add_mapped_set(graph, gpu, lit, visibility, set.mapped, set.vpls.counts, choice.place);
    VplLight light{.vpls = set.vpls, .common = mapped.common, .maps = mapped.maps};
    const bool has_unmapped = contents.emitters || contents.sky || wanted.balanced;
    if (visibility.method == VplVisibility::rays || (light.maps && has_unmapped)) light.rays = lit.tracing;
    if (choice.place && shape.turn.prepares_next) {
        choice.place = 1 - *choice.place;
        frame.waiting_of_next = prepare_next_set(graph, gpu, wanted, lit, choice, *inputs, visibility);
    }
    SharedVpls shared{light, add_vpl_order(graph, gpu, set.vpls), wanted.count};
    if (std::ranges::any_of(shape.views, &ViewShape::estimate_error)) {
        shared.other = add_other_set(graph, gpu, wanted, lit, inputs, configuration.visibility);
    }
    return shared;
}

/// The light at the host's receivers, kept until the end of the frame.
void light_receivers(FrameGraph& graph, Gpu& gpu, const Configuration& configuration, const LitScene& lit,
                     const std::optional<SharedVpls>& vpls, FrameHandles& frame) {
    frame.receivers = graph.import_value<std::vector<Receiver>>("host's receivers");
    if (!shows_light(configuration.show)) return;
    frame.received =
        add_receivers(graph, gpu, *frame.receivers, lighting_of_points(configuration, lit, vpls));
    graph.add("keep-received-light", [&](Pass& pass) {
        pass.side_effect();
        pass.read(*frame.received, Usage::storage);
    });
}

}  // namespace

namespace {

/// Objects with surfaces that only reflect light.
std::size_t reflecting_items(const World& world, SceneCheck& check) {
    const auto reflects = [](const Primitive& primitive) {
        return !is_seen_through(*primitive.material) && !emits(*primitive.material);
    };
    std::size_t count = 0;
    for (const auto& [entity, instance] : world.view<MeshInstance>()) {
        const bool is_there = check.accepts(world, entity, instance);
        if (is_there && std::ranges::any_of(instance.mesh->primitives, reflects)) ++count;
    }
    return count;
}

}  // namespace

WorldContents contents_of(const World& world, SceneCheck& check, std::uint32_t vpls) {
    WorldContents contents;
    WorldMatrices world_matrices(world);
    const auto is_placed = [&](Entity entity) {
        contents.depend_on_transforms = true;
        return check.accepts_at(world, entity, world_matrices(entity));
    };
    FrameContents& of_frame = contents.of_frame;
    of_frame.surfaces = {};
    for (const auto& [entity, instance] : world.view<MeshInstance>()) {
        if (!check.accepts(world, entity, instance)) continue;
        for (const Primitive& primitive : instance.mesh->primitives) {
            of_frame.surfaces.add(drawn_alpha(*primitive.material));
        }
        const bool emitter = !of_frame.emitters && emits(*instance.mesh);
        const bool glossy = !of_frame.glossy && is_glossy(*instance.mesh);
        const bool bumpy = !of_frame.bumpy && is_bumpy(*instance.mesh);
        const bool second_uvs = !of_frame.second_uvs && uses_second_uvs(*instance.mesh);
        const bool glass = !of_frame.glass && is_glass(*instance.mesh);
        if (!emitter && !glossy && !bumpy && !second_uvs && !glass) continue;
        if (!is_placed(entity) || !check.accepts_at(world, entity, instance, world_matrices(entity)))
            continue;
        of_frame.emitters |= emitter;
        of_frame.glossy |= glossy;
        of_frame.bumpy |= bumpy;
        of_frame.second_uvs |= second_uvs;
        of_frame.glass |= glass;
    }
    of_frame.shares_items = shares_items(reflecting_items(world, check), vpls);
    const Environment environment = accepted_environment(world, check);
    of_frame.sky = environment.radiance != glm::vec3(0.0F);
    return contents;
}

bool takes_turns(const Configuration& configuration) {
    return configuration.refinement.enabled && configuration.vpls.updates > 0;
}

FrameHandles build_frame(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                         const FrameShape& shape, std::span<const Extension> extensions) {
    FrameHandles frame;
    for (std::size_t i = 0; i < shape.views.size(); ++i) {
        const Scope scope = view_scope(graph, i);
        frame.views.push_back(import_view(graph, shape.views[i]));
    }

    const LitScene lit = add_scene(graph, gpu, configuration, shape, frame);
    const std::optional<ValueHandle<Refinement>> refinement = add_cameras(graph, configuration, lit, frame);
    const std::optional<SharedVpls> vpls =
        add_vpls(graph, gpu, configuration, shape, lit, refinement, !extensions.empty(), frame);
    if (shape.receivers) light_receivers(graph, gpu, configuration, lit, vpls, frame);
    const SharedFrame shared{configuration, shape.contents, shape.quality, lit, vpls, extensions};
    for (std::size_t i = 0; i < frame.views.size(); ++i) {
        const Scope scope = view_scope(graph, i);
        build_view(graph, gpu, shared, shape.views[i], i, frame.views[i]);
    }
    for (std::size_t i = 0; i < frame.views.size(); ++i) {
        const Scope scope = view_scope(graph, i);
        keep_parts(graph, shape.views[i].keep, frame.views[i]);
    }
    return frame;
}

}  // namespace candela
