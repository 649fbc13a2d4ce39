#include "renderer/passes/surfels/surfel_light.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/loop_parts.hpp"
#include "renderer/passes/scene/traced_content.hpp"

namespace candela {
namespace {

/// Light of the real lights at the points of the cells, and summed over each cell.
struct DirectLight {
    BufferHandle<gpu::DirectPoint> points;
    BufferHandle<gpu::CellLight> cells;
};

/// What the visibility of surfels was found for.
struct VisibilityKey {
    std::uint64_t set = 0;    // of surfels
    float ray_offset = 0.0F;  // metres
    bool operator==(const VisibilityKey&) const = default;
};

/// `surfel_count` and the uniforms that follow from it: shaders/surfels/surfel.glsl.
gl::Uniforms count_uniforms(std::uint32_t count) {
    const SurfelColumns columns = surfel_columns(count);
    return {{"surfel_count", count}, {"columns", columns.count}, {"column_stride", columns.stride}};
}

struct VisibilityPrograms {
    const gl::Program& factors;
    const gl::Program& cover;
    const gl::Program& rows;
};

/// Last round of scaling. Even, so that its results are in the first half of the rows.
constexpr std::uint32_t last_round = 4;

/// Numbers of surfels and of the points of their cells.
struct SurfelNumbers {
    std::uint32_t surfels = 0;
    std::uint32_t points = 0;
};

SurfelNumbers numbers_of(const Execution& run, const Surfels& surfels) {
    return {run.value(surfels.counts).all_surfels(), run.value(surfels.point_count)};
}

void find_visibility(const Gpu& gpu, const VisibilityPrograms& programs, std::uint32_t count,
                     float ray_offset, const std::optional<std::vector<Box>>& changed) {
    constexpr std::uint32_t most_a_line = 32768;  // work groups
    const gl::Uniforms common = count_uniforms(count);
    const gl::Uniforms traced = common + changed_box_uniforms(changed, 4.0F * ray_offset);
    const gl::Uniforms offset{{"ray_offset", ray_offset}};
    const std::uint32_t surfel_groups = groups(count, SURFEL_GROUP);
    ComputeSteps steps(gpu);
    steps.run(programs.factors, {surfel_groups, surfel_columns(count).count / 2}, traced + offset);
    steps.run(programs.cover, {std::min(count, most_a_line), groups(count, most_a_line)}, traced + offset);
    for (std::uint32_t round = 0; round <= last_round; ++round) {
        steps.run(programs.rows, {surfel_groups}, common + gl::Uniforms{{"round", round}});
    }
}

struct BouncePrograms {
    const gl::Program& first;
    const gl::Program& further;
    const gl::Program& account;
    const gl::Program& writer;
};

/// Gathers up to bounce `bounces`. Every few bounces, the account finds out how much light is left; once it
/// is little, the remaining dispatches return at once.
void gather_bounces(ComputeSteps& steps, const BouncePrograms& programs, std::uint32_t count,
                    std::uint32_t bounces) {
    constexpr std::uint32_t bounces_an_account = 4;
    const auto uniforms = [&](std::uint32_t bounce) {
        return count_uniforms(count) + gl::Uniforms{{"bounce", bounce}};
    };
    steps.run(programs.account, {}, uniforms(1));
    for (std::uint32_t bounce = 2; bounce <= bounces; ++bounce) {
        steps.run(bounce == 2 ? programs.first : programs.further, {groups(count, SURFEL_GROUP)},
                  uniforms(bounce));
        if (bounce % bounces_an_account == 0 || bounce == bounces) {
            steps.run(programs.account, {}, uniforms(bounce));
        }
    }
}

/// Most shadow rays of an invocation in one dispatch. Each ray loops over nodes of the BVH, and software
/// drivers stop all loops of an invocation after 65,535 iterations in total.
constexpr std::uint32_t most_shadow_rays = 64;

/// The points of a cell share the sources of one kind, so that each traces a few rays to them:
/// `most_shadow_rays` at most.
std::uint32_t shares_of(std::uint32_t sources) {
    return std::max(points_a_surfel, groups(sources, most_shadow_rays));
}

/// Light is evaluated at the cells' points only. A spot that is narrower than they are apart, even where it
/// is widest, may fall between them.
void warn_of_narrow_spots(Log& log, const LightTable& lights, const SceneMetrics& metrics,
                          std::uint32_t points) {
    const float apart = std::sqrt(metrics.area / static_cast<float>(std::max(points, 1U)));
    const auto is_narrow = [&](const LightTable::Entry& entry) {
        const gpu::Light& light = entry.light;
        const float farthest = std::min(light.range, 2.0F * metrics.radius());
        const float tangent = std::sqrt(1.0F - light.cos_outer * light.cos_outer) / light.cos_outer;
        return light.kind == LIGHT_SPOT && light.cos_outer > 0.0F && 2.0F * farthest * tangent < apart;
    };
    const auto narrow = std::ranges::count_if(lights.entries, is_narrow);
    if (narrow > 0) {
        log.warn(
            fmt::format("spot lights whose light falls between the points of surfels: {}; their indirect "
                        "light is wrong or missing, use \"vpls\": {{\"placement\": \"paths\"}}",
                        narrow));
    }
}

/// For a pass that reads the sky, if there is one. Returns the names to define in its shader.
std::vector<std::string> read_sky(Pass& pass, const std::optional<SkyPatches>& sky) {
    if (!sky) return {};
    pass.read(sky->count);
    pass.read(sky->patches, {Usage::uniform, UNIFORMS_SKY});
    return {"SKY"};
}

DirectLight add_direct_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                             const SurfelVisibility& visibility, const SurfelSources& sources) {
    const Surfels& surfels = visibility.surfels;
    const SceneLights& lights = sources.lights;
    return graph.add("surfel-light", [&](Pass& pass) {
        pass.read(surfels.counts);
        pass.read(surfels.point_count);
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(lights.table);
        pass.read(lights.buffer, {Usage::storage, BINDING_LIGHTS});
        read_tracing(pass, tracing);
        const std::vector<std::string> defined = read_sky(pass, sources.sky);
        const gl::Program& lighter = gpu.program({"surfels/surfel_light.comp"}, defined);
        const gl::Program& adder = gpu.program({"surfels/surfel_cells.comp"});
        const DirectLight out{
            .points = pass.write(growing_buffer<gpu::DirectPoint>(graph, "directly lit points"),
                                 {Usage::storage, BINDING_DIRECT_POINTS}),
            .cells = pass.write(growing_buffer<gpu::CellLight>(graph, "directly lit cells"),
                                {Usage::storage, BINDING_CELL_LIGHT})};
        pass.run([=, &gpu, &lighter, &adder, sky = sources.sky](Execution& run) {
            const auto [count, points] = numbers_of(run, surfels);
            run.reserve(out.points, points);
            run.reserve(out.cells, count);
            if (count == 0) return;
            const std::uint32_t emitters = run.value(surfels.counts).emitters;
            const SceneMetrics& metrics = run.value(tracing.metrics);
            const LightTable& table = run.value(lights.table);
            warn_of_narrow_spots(gpu.log(), table, metrics, points);
            const auto light_count = static_cast<std::uint32_t>(table.entries.size());
            const std::uint32_t patches = sky ? run.value(sky->count) : 0;
            const gl::Uniforms uniforms{{"point_count", points},
                                        {"light_count", light_count},
                                        {"ray_offset", metrics.ray_offset()},
                                        {"surfel_count", count},
                                        {"emitting_count", emitters},
                                        {"emitter_shares", shares_of(emitters)},
                                        {"sky_patch_count", patches},
                                        {"sky_shares", shares_of(patches)}};
            ComputeSteps steps(gpu);
            for (const gl::Uniforms& part : loop_parts(light_count, most_shadow_rays)) {
                steps.run(lighter, {groups(points, SURFEL_GROUP)}, uniforms + part);
            }
            steps.run(adder, {groups(count, SURFEL_GROUP)}, count_uniforms(count));
        });
        return out;
    });
}

/// Names to define in surfel_write.comp.
std::vector<std::string> writer_variant(const SurfelSources& sources) {
    return sources.emitters ? std::vector<std::string>{"EMITTERS"} : std::vector<std::string>{};
}

/// Declares the surfels as VPLs. The light of the sky is emitted light.
LitSurfels write_lit_surfels(FrameGraph& graph, Pass& pass, const SurfelSources& sources, ShownLight shown) {
    LitSurfels lit{.surfels = pass.write(growing_buffer<gpu::LitSurfel>(graph, "lit surfels"),
                                         {Usage::storage, BINDING_LIT_SURFELS}),
                   .emitters = {},
                   .points = pass.write(growing_buffer<gpu::LitPoint>(graph, "lit points"),
                                        {Usage::storage, BINDING_LIT_POINTS}),
                   .sky = shown.emitted ? sources.sky : std::nullopt};
    if (sources.emitters) {
        lit.emitters = pass.write(growing_buffer<gpu::LitEmitter>(graph, "lit emitters"),
                                  {Usage::storage, BINDING_LIT_EMITTERS});
    }
    return lit;
}

gl::Uniforms share_uniforms(ShownLight shown) {
    return {{"emitted_share", shown.emitted ? 1.0F : 0.0F},
            {"reflected_share", shown.reflected ? 1.0F : 0.0F}};
}

}  // namespace

SurfelColumns surfel_columns(std::uint32_t surfels) {
    const std::uint32_t stride = std::max((surfels + MOST_COLUMNS - 1) / MOST_COLUMNS, 1U);
    const std::uint32_t count = (surfels + stride - 1) / stride;
    return {.count = count + count % 2, .stride = stride};
}

SurfelVisibility add_surfel_visibility(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                       const Surfels& surfels, ValueHandle<SceneMotion> motion) {
    return graph.add("surfel-visibility", [&](Pass& pass) {
        pass.read(surfels.counts);
        pass.read(surfels.set);
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(motion);
        read_tracing(pass, tracing);
        const VisibilityPrograms programs{.factors = gpu.program({"surfels/surfel_form_factors.comp"}),
                                          .cover = gpu.program({"surfels/surfel_cover.comp"}),
                                          .rows = gpu.program({"surfels/surfel_rows.comp"})};
        const SurfelVisibility out{
            .surfels = surfels,
            .form_factors = pass.update(growing_buffer<std::uint32_t>(graph, "form factors"),
                                        {Usage::storage, BINDING_FORM_FACTORS}),
            .rows = pass.write(growing_buffer<glm::vec2>(graph, "surfel rows"),
                               {Usage::storage, BINDING_SURFEL_ROWS})};
        const auto hits = pass.update(growing_buffer<std::uint32_t>(graph, "surfel cover"),
                                      {Usage::storage, BINDING_COVER});
        const TracedContent<VisibilityKey> known(graph, pass, "known visibility");
        pass.run([=, &gpu](Execution& run) {
            const std::uint32_t count = run.value(surfels.counts).all_surfels();
            run.reserve(out.form_factors, std::uint64_t{count} * surfel_columns(count).count / 2);
            run.reserve(out.rows, 2 * count);
            run.reserve(hits, count * COVER_PARTS);
            const float ray_offset = run.value(tracing.metrics).ray_offset();
            const auto changed = known.outdated(run, run.value(motion), {run.value(surfels.set), ray_offset},
                                                {run.object(out.form_factors), run.object(hits)});
            if (count > 0) find_visibility(gpu, programs, count, ray_offset, changed);
        });
        return out;
    });
}

Vpls add_surfel_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const SurfelVisibility& visibility,
                      const SurfelSources& sources, std::uint32_t bounces, ShownLight shown) {
    const Surfels& surfels = visibility.surfels;
    const DirectLight direct = add_direct_light(graph, gpu, tracing, visibility, sources);
    return graph.add("surfel-bounce", [&](Pass& pass) {
        pass.read(surfels.counts);
        pass.read(surfels.point_count);
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(direct.points, {Usage::storage, BINDING_DIRECT_POINTS});
        pass.read(visibility.form_factors, {Usage::storage, BINDING_FORM_FACTORS});
        pass.read(visibility.rows, {Usage::storage, BINDING_SURFEL_ROWS});
        if (sources.sky) pass.read(sources.sky->count);
        pass.parameter(bounces);
        pass.parameter(shown);
        const BouncePrograms programs{
            .first = gpu.program({"surfels/surfel_bounce.comp"}, {"FIRST"}),
            .further = gpu.program({"surfels/surfel_bounce.comp"}),
            .account = gpu.program({"surfels/surfel_account.comp"}),
            .writer = gpu.program({"surfels/surfel_write.comp"}, writer_variant(sources))};
        [[maybe_unused]] const auto lit_cells =
            pass.write(direct.cells, {Usage::storage, BINDING_CELL_LIGHT});
        const auto bounced =
            pass.write(growing_buffer<glm::vec4>(graph, "bounced light"), {Usage::storage, BINDING_BOUNCE});
        const LitSurfels lit = write_lit_surfels(graph, pass, sources, shown);
        const Vpls out{.counts = pass.write(graph.value<VplCounts>("vpl counts")),
                       .flux = pass.write(growing_buffer<gpu::FluxAccount>(graph, "flux"),
                                          {Usage::storage, BINDING_FLUX_ACCOUNT}),
                       .records = lit};
        pass.run([=, &gpu, sky = sources.sky](Execution& run) {
            VplCounts counts = run.value(surfels.counts);
            counts.sky_patches = sky ? run.value(sky->count) : 0;
            run.set(out.counts, counts);
            const auto [count, points] = numbers_of(run, surfels);
            run.reserve(bounced, 2 * count);
            run.reserve(lit.surfels, count);
            run.reserve(lit.points, points);
            if (lit.emitters) run.reserve(*lit.emitters, counts.emitters);
            if (count == 0) return;
            ComputeSteps steps(gpu);
            gather_bounces(steps, programs, count, bounces);
            steps.run(programs.writer, {groups(count, SURFEL_GROUP)},
                      count_uniforms(count) + share_uniforms(shown) +
                          gl::Uniforms{{"emitting_count", counts.emitters}});
        });
        return out;
    });
}

}  // namespace candela
