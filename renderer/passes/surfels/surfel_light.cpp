#include "renderer/passes/surfels/surfel_light.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/loop_parts.hpp"

namespace candela {
namespace {

/// Cells whose light is known, by surfel. The light of a cell stays while nothing but the choice of surfels
/// changes.
struct LitCells {
    std::vector<std::uint64_t> ids;           // Surfels::ids
    std::vector<std::uint32_t> first_points;  // of the cell, among all points
    std::uint32_t emitters = 0;               // the last ones
    bool operator==(const LitCells&) const = default;

    [[nodiscard]] std::span<const std::uint64_t> emitting() const { return std::span(ids).last(emitters); }
};

LitCells cells_of(const Execution& run, const Surfels& surfels) {
    LitCells cells{run.value(surfels.ids), {}, run.value(surfels.counts).emitters};
    cells.first_points.resize(cells.ids.size());
    const std::vector<CellPlace>& points = run.value(surfels.cell_places);
    for (std::size_t i = points.size(); i-- > 0;) {
        cells.first_points[points[i].surfel] = static_cast<std::uint32_t>(i);
    }
    return cells;
}

/// By surfel: the first point of its cell before, NO_SURFEL for new ones. Light of emitting cells reaches all
/// others, so that nothing stays if these change.
std::vector<std::uint32_t> kept_points(const LitCells& before, const LitCells& now) {
    if (!std::ranges::equal(before.emitting(), now.emitting())) {
        return std::vector<std::uint32_t>(now.ids.size(), NO_SURFEL);
    }
    std::vector<std::uint32_t> kept = kept_surfels(before.ids, now.ids).last;
    for (std::uint32_t& surfel : kept) {
        if (surfel != NO_SURFEL) surfel = before.first_points[surfel];
    }
    return kept;
}

/// Resources by which the light at points stays from frame to frame.
struct KeptLight {
    ValueHandle<LitCells> cells;
    BufferHandle<gpu::DirectPoint> last_points;
    BufferHandle<std::uint32_t> kept;  // kept_points
};

/// Numbers of surfels and of the points of their cells.
struct SurfelNumbers {
    std::uint32_t surfels = 0;
    std::uint32_t points = 0;
};

SurfelNumbers numbers_of(const Execution& run, const Surfels& surfels) {
    return {run.value(surfels.counts).all_surfels(), run.value(surfels.point_count)};
}

struct BouncePrograms {
    const gl::Program& first;
    const gl::Program* further = nullptr;  // null: those after the first one are gathered in one dispatch
    const gl::Program& account;            // which gathers them, too, if they are
    const gl::Program& writer;
};

/// Gathers up to bounce `bounces`. After each, the account finds out how much light is left; once it is
/// little, the remaining dispatches have no work groups: where the CPU does their work, dispatches that only
/// return would take longer than what is gathered.
void gather_one_by_one(ComputeSteps& steps, const BouncePrograms& programs, std::uint32_t count,
                       std::uint32_t bounces) {
    const gl::Uniforms of_all = count_uniforms(count);
    const auto account = [&](std::uint32_t bounce) {
        return of_all + gl::Uniforms{{"bounce", bounce}, {"solves", bounces == all_bounces}};
    };
    steps.run(programs.account, {}, account(1));
    for (std::uint32_t bounce = 2; bounce <= bounces; ++bounce) {
        steps.run_indirect(bounce == 2 ? programs.first : *programs.further, of_all,
                           offsetof(gpu::FluxAccount, bounce_groups));
        steps.run_indirect(programs.account, account(bounce), offsetof(gpu::FluxAccount, account_groups));
    }
}

/// The same in few dispatches, since on a GPU each waits for the one before.
void gather_at_once(ComputeSteps& steps, const BouncePrograms& programs, std::uint32_t count,
                    std::uint32_t bounces) {
    const std::uint32_t apart = bounces > 1 ? 2 : 1;
    if (apart > 1) steps.run(programs.first, {groups(count, BOUNCE_GROUP)}, count_uniforms(count));
    steps.run(programs.account, {surfel_columns(count).stride},
              count_uniforms(count) + gl::Uniforms{{"bounces_before", apart},
                                                   {"last_bounce", std::max(bounces, apart)},
                                                   {"solves", bounces == all_bounces}});
}

BouncePrograms bounce_programs(Gpu& gpu) {
    const bool at_once = !gpu.device().limits().software;
    std::vector<std::string> first{"FIRST"};
    if (at_once) first.emplace_back("SLICED");
    return {.first = gpu.program({"surfels/surfel_bounce.comp"}, first),
            .further = at_once ? nullptr : &gpu.program({"surfels/surfel_bounce.comp"}),
            .account = gpu.program({at_once ? "surfels/surfel_bounces.comp" : "surfels/surfel_account.comp"}),
            .writer = gpu.program({"surfels/surfel_write.comp"})};
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

/// What the light at points depends on besides surfels.
std::vector<ResourceHandle> other_inputs(const Tracing& tracing, const SurfelSources& sources) {
    std::vector<ResourceHandle> inputs{tracing.nodes,        tracing.triangles, tracing.materials,
                                       tracing.texels,       tracing.metrics,   sources.lights.table,
                                       sources.lights.buffer};
    if (sources.sky) inputs.insert(inputs.end(), {sources.sky->count, sources.sky->patches});
    return inputs;
}

/// Brings what is known of the points' light to where the shader finds it. Returns whether any of it stays.
bool keep_light(const Gpu& gpu, Execution& run, const KeptLight& light, BufferHandle<gpu::DirectPoint> points,
                LitCells now, const std::vector<ResourceHandle>& others) {
    const LitCells* const before = run.previous(light.cells);
    const bool keeps = run.has_result() && before != nullptr && !run.changed(others);
    if (keeps) {
        upload<std::uint32_t>(gpu, run, light.kept, kept_points(*before, now));
        copy_content(gpu, run, points, light.last_points, run.count(points));
    }
    run.set(light.cells, std::move(now));
    return keeps;
}

BufferHandle<gpu::DirectPoint> add_direct_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                                const SurfelVisibility& visibility,
                                                const SurfelSources& sources) {
    const Surfels& surfels = visibility.surfels;
    const SceneLights& lights = sources.lights;
    return graph.add("surfel-light", [&](Pass& pass) {
        pass.read(surfels.counts);
        pass.read(surfels.point_count);
        pass.read(surfels.ids);
        pass.read(surfels.cell_places);
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(lights.table);
        pass.read(lights.buffer, {Usage::storage, BINDING_LIGHTS});
        read_tracing(pass, tracing);
        std::vector<std::string> defined = read_sky(pass, sources.sky);
        if (sources.emitters) defined.emplace_back("EMITTERS");
        const gl::Program& lighter = gpu.program({"surfels/surfel_light.comp"}, defined);
        const auto out = pass.update(growing_buffer<gpu::DirectPoint>(graph, "directly lit points"),
                                     {Usage::storage, BINDING_DIRECT_POINTS});
        const KeptLight kept{
            .cells = pass.update(graph.value<LitCells>("known lit cells")),
            .last_points = pass.write(growing_buffer<gpu::DirectPoint>(graph, "last directly lit points"),
                                      {Usage::copy, BINDING_LAST_POINTS}),
            .kept = pass.write(growing_buffer<std::uint32_t>(graph, "kept points"),
                               {Usage::copy, BINDING_KEPT_POINTS})};
        const std::vector<ResourceHandle> others = other_inputs(tracing, sources);
        pass.run([=, &gpu, &lighter, sky = sources.sky](Execution& run) {
            const auto [count, points] = numbers_of(run, surfels);
            const bool keeps = keep_light(gpu, run, kept, out, cells_of(run, surfels), others);
            run.reserve(out, points);
            if (count == 0) return;
            const std::uint32_t emitters = run.value(surfels.counts).emitters;
            const SceneMetrics& metrics = run.value(tracing.metrics);
            const LightTable& table = run.value(lights.table);
            warn_of_narrow_spots(gpu.log(), table, metrics, points);
            const auto light_count = static_cast<std::uint32_t>(table.entries.size());
            const std::uint32_t patches = sky ? run.value(sky->count) : 0;
            const gl::Uniforms uniforms{
                {"point_count", points}, {"light_count", light_count}, {"ray_offset", metrics.ray_offset()},
                {"surfel_count", count}, {"emitting_count", emitters}, {"sky_patch_count", patches},
                {"keeps", keeps}};
            ComputeSteps steps(gpu);
            for (const gl::Uniforms& part :
                 loop_parts(gpu.device().limits(), light_count, iterations_a_ray / 2)) {
                steps.run_rows(run, lighter, {1, groups(points, SURFEL_GROUP)}, uniforms + part);
            }
        });
        return out;
    });
}

/// The step that finds the mean light of items without surfels.
struct MeanStep {
    const gl::Program* program = nullptr;  // null: all items have some

    void run(ComputeSteps& steps, const VplCounts& counts, ShownLight shown) const {
        if (program == nullptr) return;
        steps.run(*program, {},
                  {{"reflecting_count", counts.surfels},
                   {"mean_record", counts.surfels},
                   {"reflected_share", shown.reflected ? 1.0F : 0.0F}});
    }
};

/// Declares the surfels as VPLs. The light of the sky is emitted light.
LitSurfels write_lit_surfels(FrameGraph& graph, Pass& pass, const SurfelSources& sources, ShownLight shown) {
    LitSurfels lit{.surfels = pass.write(growing_buffer<gpu::LitSurfel>(graph, "lit surfels"),
                                         {Usage::storage, BINDING_LIT_SURFELS}),
                   .emitters = {},
                   .points = pass.write(growing_buffer<gpu::LitPoint>(graph, "lit points"),
                                        {Usage::storage, BINDING_LIT_POINTS}),
                   .sky = shown.emitted ? sources.sky : std::nullopt,
                   .balanced = sources.balanced};
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

Vpls add_surfel_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const SurfelVisibility& visibility,
                      const SurfelSources& sources, std::uint32_t bounces, ShownLight shown) {
    const Surfels& surfels = visibility.surfels;
    const auto direct = add_direct_light(graph, gpu, tracing, visibility, sources);
    return graph.add("surfel-bounce", [&](Pass& pass) {
        pass.read(surfels.counts);
        pass.read(surfels.point_count);
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(direct, {Usage::storage, BINDING_DIRECT_POINTS});
        pass.read(visibility.form_factors, {Usage::storage, BINDING_FORM_FACTORS});
        pass.read(visibility.rows, {Usage::storage, BINDING_SURFEL_ROWS});
        if (sources.sky) pass.read(sources.sky->count);
        pass.parameter(bounces);
        pass.parameter(shown);
        const BouncePrograms programs = bounce_programs(gpu);
        const MeanStep mean_step{sources.balanced ? &gpu.program({"surfels/surfel_mean.comp"}) : nullptr};
        const gl::Program& adder = gpu.program({"surfels/surfel_cells.comp"});
        const auto cells = pass.write(growing_buffer<gpu::CellLight>(graph, "lit cells"),
                                      {Usage::storage, BINDING_CELL_LIGHT});
        const auto bounced =
            pass.write(growing_buffer<glm::vec4>(graph, "bounced light"), {Usage::storage, BINDING_BOUNCE});
        const LitSurfels lit = write_lit_surfels(graph, pass, sources, shown);
        const Vpls out{.counts = pass.write(graph.value<VplCounts>("vpl counts")),
                       .flux = pass.write(growing_buffer<gpu::FluxAccount>(graph, "flux"),
                                          {Usage::storage, BINDING_FLUX_ACCOUNT}),
                       .records = lit};
        pass.run([=, &gpu, &adder, sky = sources.sky](Execution& run) {
            VplCounts counts = run.value(surfels.counts);
            counts.sky_patches = sky ? run.value(sky->count) : 0;
            counts.accounts =
                std::min(counts.all_surfels(),
                         programs.further == nullptr ? surfel_columns(counts.all_surfels()).stride : 1U);
            counts.directions = lit.balanced && counts.surfels > 0 ? COVER_DIRECTIONS : 0;
            run.set(out.counts, counts);
            const auto [count, points] = numbers_of(run, surfels);
            run.reserve(cells, count);
            run.reserve(bounced, 4 * count);
            run.reserve(lit.surfels, count + (lit.balanced ? 1 : 0));
            run.reserve(lit.points, points);
            if (lit.emitters) run.reserve(*lit.emitters, counts.emitters);
            if (count == 0) return;
            run.reserve(out.flux, counts.accounts);
            ComputeSteps steps(gpu);
            steps.run(adder, {groups(count, SURFEL_GROUP)}, count_uniforms(count));
            gpu.gl().BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, run.object(out.flux));
            (programs.further == nullptr ? gather_at_once : gather_one_by_one)(steps, programs, count,
                                                                               bounces);
            mean_step.run(steps, counts, shown);
            steps.run(programs.writer, {groups(count, SURFEL_GROUP)},
                      count_uniforms(count) + share_uniforms(shown) +
                          gl::Uniforms{{"emitting_count", counts.emitters},
                                       {"balanced", lit.balanced},
                                       {"mean_record", counts.surfels}});
        });
        return out;
    });
}

}  // namespace candela
