#include "renderer/passes/surfels/surfel_light.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <candela/graph/execute.hpp>

namespace candela {
namespace {

/// Light of the real lights at the points of the cells, and summed over each cell.
struct DirectLight {
    BufferHandle<gpu::DirectPoint> points;
    BufferHandle<gpu::CellLight> cells;
};

std::uint32_t count_of(const Execution& run, const Surfels& surfels) {
    return run.value(surfels.plan).vpl_count;
}

/// Identifies stored visibility: the set of surfels, the step of scene motion up to which it is current, the
/// ray offset in metres, and the GL names of the buffers that hold it.
struct KnownVisibility {
    std::uint64_t set = 0;
    std::uint64_t step = 0;
    float ray_offset = 0.0F;
    ObjectId form_factors = 0;
    ObjectId hits = 0;
    ObjectId seen = 0;
    bool operator==(const KnownVisibility&) const = default;

    [[nodiscard]] bool is_of(const KnownVisibility& other) const {
        return set == other.set && ray_offset == other.ray_offset && form_factors == other.form_factors &&
               hits == other.hits && seen == other.seen;
    }
};

/// Sets `surfel_count` and the uniforms that follow from it: shaders/surfels/surfel.glsl.
void set_count(const gl::Program& program, std::uint32_t count) {
    const SurfelColumns columns = surfel_columns(count);
    program.set("surfel_count", count);
    program.set("columns", columns.count);
    program.set("column_stride", columns.stride);
}

void dispatch_surfels(const gl::Functions& gl, const gl::Program& program, std::uint32_t count) {
    set_count(program, count);
    program.use();
    gl.DispatchCompute(groups(count, SURFEL_GROUP), 1, 1);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void find_form_factors(const gl::Functions& gl, const gl::Program& program, std::uint32_t count) {
    set_count(program, count);
    program.use();
    gl.DispatchCompute(groups(count, SURFEL_GROUP), surfel_columns(count).count / 2, 1);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void find_cover(const gl::Functions& gl, const gl::Program& program, std::uint32_t count) {
    constexpr std::uint32_t most_a_line = 32768;
    set_count(program, count);
    program.use();
    gl.DispatchCompute(std::min(count, most_a_line), (count + most_a_line - 1) / most_a_line, 1);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/// Last round of scaling. Even, so that its results are in the first half of the rows.
constexpr std::uint32_t last_round = 4;

void scale_rows(const gl::Functions& gl, const gl::Program& program, std::uint32_t count) {
    for (std::uint32_t round = 0; round <= last_round; ++round) {
        program.set("round", round);
        dispatch_surfels(gl, program, count);
    }
}

void add_up(const gl::Functions& gl, const gl::Program& program, std::uint32_t count, std::uint32_t bounce) {
    set_count(program, count);
    program.set("bounce", bounce);
    program.use();
    gl.DispatchCompute(1, 1, 1);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

struct BouncePrograms {
    const gl::Program* first;
    const gl::Program* further;
    const gl::Program* account;
};

/// Gathers up to bounce `bounces`. Every few bounces, the account finds out how much light is left; once it
/// is little, the remaining dispatches return at once.
void gather_bounces(const gl::Functions& gl, const BouncePrograms& programs, std::uint32_t count,
                    std::uint32_t bounces) {
    constexpr std::uint32_t bounces_an_account = 4;
    add_up(gl, *programs.account, count, 1);
    for (std::uint32_t bounce = 2; bounce <= bounces; ++bounce) {
        const gl::Program& program = bounce == 2 ? *programs.first : *programs.further;
        program.set("bounce", bounce);
        dispatch_surfels(gl, program, count);
        if (bounce % bounces_an_account == 0 || bounce == bounces) {
            add_up(gl, *programs.account, count, bounce);
        }
    }
}

/// Most shadow rays of an invocation in one dispatch. Each ray loops over nodes of the BVH, and software
/// drivers stop all loops of an invocation after 65,535 iterations in total.
constexpr std::uint32_t most_shadow_rays = 64;

/// The points of a cell share the emitting surfels, so that each traces a few rays to them:
/// `most_shadow_rays` at most.
void set_emitters(const gl::Program& program, const VplPlan& plan) {
    const std::uint32_t least = groups(plan.emitting_count, most_shadow_rays);
    program.set("surfel_count", plan.vpl_count);
    program.set("emitting_count", plan.emitting_count);
    program.set("emitter_shares", std::max(points_a_surfel, least));
}

void light_points(const gl::Functions& gl, const gl::Program& program, std::uint32_t points,
                  std::uint32_t lights) {
    program.set("point_count", points);
    program.set("light_count", lights);
    program.set("lights_now", most_shadow_rays);
    program.use();
    in_parts(gl, lights, most_shadow_rays, GL_SHADER_STORAGE_BARRIER_BIT, [&](std::uint32_t first) {
        program.set("lights_before", first);
        gl.DispatchCompute(groups(points, SURFEL_GROUP), 1, 1);
    });
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
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
    if (!sky) {
        return {};
    }
    pass.read(sky->count);
    pass.read(sky->vpls, {Usage::storage, BINDING_SKY_PATCHES});
    return {"SKY"};
}

/// The points of a cell share the patches of the sky.
void set_sky(const gl::Program& program, std::uint32_t patches) {
    program.set("sky_patch_count", patches);
    program.set("sky_shares", std::max(points_a_surfel, groups(patches, most_shadow_rays)));
}

DirectLight add_direct_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                             const SurfelVisibility& visibility, const SurfelSources& sources) {
    const Surfels& surfels = visibility.surfels;
    const SceneLights& lights = sources.lights;
    return graph.add("surfel-light", [&](Pass& pass) {
        pass.read(surfels.plan);
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(visibility.seen_points, {Usage::storage, BINDING_SEEN_POINTS});
        pass.read(lights.table);
        pass.read(lights.buffer, {Usage::storage, BINDING_LIGHTS});
        read_tracing(pass, tracing);
        const std::vector<std::string> defined = read_sky(pass, sources.sky);
        const gl::Program& lighter = gpu.program({"surfels/surfel_light.comp"}, defined);
        const gl::Program& adder = gpu.program({"surfels/surfel_cells.comp"});
        const DirectLight out{
            .points =
                pass.write(graph.buffer<gpu::DirectPoint>("directly lit points", 1, Lifetime::persistent),
                           {Usage::storage, BINDING_DIRECT_POINTS}),
            .cells = pass.write(graph.buffer<gpu::CellLight>("directly lit cells", 1, Lifetime::persistent),
                                {Usage::storage, BINDING_CELL_LIGHT})};
        pass.run([=, &gpu, &lighter, &adder, sky = sources.sky](Execution& run) {
            const std::uint32_t count = count_of(run, surfels);
            const std::uint32_t points = run.value(surfels.plan).point_count;
            run.reserve(out.points, std::max(points, 1U));
            run.reserve(out.cells, std::max(count, 1U));
            if (count == 0) {
                return;
            }
            lighter.set("ray_offset", run.value(tracing.metrics).ray_offset());
            const LightTable& table = run.value(lights.table);
            warn_of_narrow_spots(gpu.log(), table, run.value(tracing.metrics), points);
            const auto light_count = static_cast<std::uint32_t>(table.entries.size());
            set_emitters(lighter, run.value(surfels.plan));
            if (sky) {
                set_sky(lighter, run.value(sky->count));
            }
            light_points(gpu.gl(), lighter, points, light_count);
            dispatch_surfels(gpu.gl(), adder, count);
        });
        return out;
    });
}

/// Numbers of what becomes VPLs.
struct VplSources {
    std::uint32_t surfels = 0;
    std::uint32_t sky = 0;
};

void write_vpls(const gl::Functions& gl, const gl::Program& program, const VplSources& count,
                ShownLight shown) {
    set_count(program, count.surfels);
    if (count.sky > 0) {
        program.set("sky_patch_count", count.sky);
    }
    program.set("emitted_share", shown.emitted ? 1.0F : 0.0F);
    program.set("reflected_share", shown.reflected ? 1.0F : 0.0F);
    program.use();
    gl.DispatchCompute(groups(count.surfels + count.sky, SURFEL_GROUP), 1, 1);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

VplPlan with_sky(VplPlan plan, std::uint32_t patches) {
    plan.vpl_count += patches;
    plan.sky_count = patches;
    return plan;
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
        pass.read(surfels.plan);
        pass.read(surfels.set);
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(motion);
        read_tracing(pass, tracing);
        const gl::Program& factors = gpu.program({"surfels/surfel_form_factors.comp"});
        const gl::Program& cover = gpu.program({"surfels/surfel_cover.comp"});
        const gl::Program& rows = gpu.program({"surfels/surfel_rows.comp"});
        const gl::Program& seer = gpu.program({"surfels/surfel_points.comp"});
        const SurfelVisibility out{
            .surfels = surfels,
            .form_factors = pass.update(graph.buffer<std::uint32_t>("form factors", 1, Lifetime::persistent),
                                        {Usage::storage, BINDING_FORM_FACTORS}),
            .rows = pass.write(graph.buffer<glm::vec2>("surfel rows", 1, Lifetime::persistent),
                               {Usage::storage, BINDING_SURFEL_ROWS}),
            .seen_points = pass.update(graph.buffer<std::uint32_t>("seen points", 1, Lifetime::persistent),
                                       {Usage::storage, BINDING_SEEN_POINTS})};
        const auto hits = pass.update(graph.buffer<std::uint32_t>("surfel cover", 1, Lifetime::persistent),
                                      {Usage::storage, BINDING_COVER});
        const auto known = pass.update(graph.value<KnownVisibility>("known visibility"));
        pass.run([=, &gpu, &factors, &cover, &rows, &seer](Execution& run) {
            const std::uint32_t count = count_of(run, surfels);
            run.reserve(out.form_factors,
                        std::max<std::uint64_t>(std::uint64_t{count} * surfel_columns(count).count / 2, 1));
            run.reserve(out.rows, std::max(2 * count, 1U));
            const std::uint32_t points = run.value(surfels.plan).point_count;
            run.reserve(hits, std::max(count * COVER_PARTS, 1U));
            run.reserve(out.seen_points, std::max(points, 1U));
            const KnownVisibility now{.set = run.value(surfels.set),
                                      .step = run.value(motion).step,
                                      .ray_offset = run.value(tracing.metrics).ray_offset(),
                                      .form_factors = run.object(out.form_factors),
                                      .hits = run.object(hits),
                                      .seen = run.object(out.seen_points)};
            const KnownVisibility* const before = run.previous(known);
            std::optional<std::vector<Box>> changed;
            if (before != nullptr && before->is_of(now)) {
                changed = changed_boxes(run.value(motion), before->step);
            }
            run.set(known, now);
            if (count == 0) {
                return;
            }
            for (const gl::Program* tracer : {&factors, &cover, &seer}) {
                set_changed_boxes(*tracer, changed, 4.0F * now.ray_offset);
            }
            factors.set("ray_offset", now.ray_offset);
            cover.set("ray_offset", now.ray_offset);
            find_form_factors(gpu.gl(), factors, count);
            find_cover(gpu.gl(), cover, count);
            scale_rows(gpu.gl(), rows, count);
            seer.set("point_count", points);
            seer.use();
            gpu.gl().DispatchCompute(groups(points, SURFEL_GROUP), 1, 1);
        });
        return out;
    });
}

Vpls add_surfel_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const SurfelVisibility& visibility,
                      const SurfelSources& sources, std::uint32_t bounces, ShownLight shown) {
    const Surfels& surfels = visibility.surfels;
    const DirectLight direct = add_direct_light(graph, gpu, tracing, visibility, sources);
    return graph.add("surfel-bounce", [&](Pass& pass) {
        pass.read(surfels.plan);
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(direct.points, {Usage::storage, BINDING_DIRECT_POINTS});
        pass.read(visibility.form_factors, {Usage::storage, BINDING_FORM_FACTORS});
        pass.read(visibility.rows, {Usage::storage, BINDING_SURFEL_ROWS});
        const std::vector<std::string> defined = read_sky(pass, sources.sky);
        pass.parameter(bounces);
        pass.parameter(shown);
        const BouncePrograms programs{.first = &gpu.program({"surfels/surfel_bounce.comp"}, {"FIRST"}),
                                      .further = &gpu.program({"surfels/surfel_bounce.comp"}),
                                      .account = &gpu.program({"surfels/surfel_account.comp"})};
        const gl::Program& writer = gpu.program({"surfels/surfel_write.comp"}, defined);
        [[maybe_unused]] const auto lit_cells =
            pass.write(direct.cells, {Usage::storage, BINDING_CELL_LIGHT});
        const auto bounced = pass.write(graph.buffer<glm::vec4>("bounced light", 1, Lifetime::persistent),
                                        {Usage::storage, BINDING_BOUNCE});
        const Vpls out{
            .plan = pass.write(graph.value<VplPlan>("vpl plan")),
            .vpls = pass.write(graph.buffer<gpu::Vpl>("vpls", 1, Lifetime::persistent),
                               {Usage::storage, BINDING_VPLS}),
            .flux = pass.write(graph.buffer<gpu::FluxAccount>("flux", 1, Lifetime::persistent),
                               {Usage::storage, BINDING_FLUX_ACCOUNT}),
            .points = pass.write(graph.buffer<gpu::LitPoint>("lit points", 1, Lifetime::persistent),
                                 {Usage::storage, BINDING_LIT_POINTS})};
        pass.run([=, &gpu, &writer, sky = sources.sky](Execution& run) {
            const std::uint32_t count = count_of(run, surfels);
            const std::uint32_t sky_count = sky ? run.value(sky->count) : 0;
            run.reserve(bounced, std::max(2 * count, 1U));
            run.reserve(out.vpls, std::max(count + sky_count, 1U));
            run.reserve(*out.points, std::max(run.value(surfels.plan).point_count, 1U));
            run.set(out.plan, with_sky(run.value(surfels.plan), sky_count));
            if (count > 0) {
                gather_bounces(gpu.gl(), programs, count, bounces);
            }
            if (count + sky_count > 0) {
                write_vpls(gpu.gl(), writer, {count, sky_count}, shown);
            }
        });
        return out;
    });
}

}  // namespace candela
