#include "renderer/passes/vpls/vpl_trace.hpp"

#include <cmath>
#include <numbers>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"

namespace candela {
namespace {

constexpr std::uint32_t paths_a_group = 32;  // as in shaders/vpls/vpl_trace.comp and vpl_write.comp
constexpr std::uint32_t vpls_a_group = 16;   // as in shaders/vpls/vpl_edges.comp

/// Input and intermediate result of the path tracer.
struct PathBuffers {
    BufferHandle<gpu::Path> paths;
    BufferHandle<float> weights;
    BufferHandle<gpu::VplRecord> records;  ///< hits of the paths, without flux
};

/// Distance in metres within which the edges of a VPL's surface are searched: four times the mean spacing of
/// VPLs. For receivers farther away, the disc of the VPL is hardly displaced behind its surface
/// (shaders/vpls/disc.glsl), so that edges do not matter.
float edge_reach(float area, std::uint32_t vpl_count) {
    return 4.0F * std::sqrt(area / static_cast<float>(vpl_count));
}

struct PathPrograms {
    const gl::Program& tracer;
    const gl::Program& writer;
    const gl::Program& edges;
};

/// One segment is traced per dispatch. A longer loop would reach the number of iterations after which
/// software drivers silently stop all loops of an invocation.
void trace(const Gpu& gpu, const PathPrograms& programs, const SceneMetrics& metrics, const PathPlan& plan,
           float bound) {
    const auto path_count = static_cast<std::uint32_t>(plan.paths.size());
    const Groups path_groups{groups(path_count, paths_a_group)};
    ComputeSteps steps(gpu);
    for (std::uint32_t bounce = 1; bounce <= plan.max_bounces; ++bounce) {
        steps.run(programs.tracer, path_groups,
                  {{"path_count", path_count}, {"ray_offset", metrics.ray_offset()}, {"bounce", bounce}});
    }
    steps.run(programs.writer, path_groups,
              {{"path_count", path_count},
               {"max_bounces", plan.max_bounces},
               {"radius2", vpl_radius2(bound, plan.vpl_count, metrics.area)}});
    steps.run(programs.edges, {1, groups(plan.vpl_count, vpls_a_group)},
              {{"vpl_count", plan.vpl_count}, {"edge_reach", edge_reach(metrics.area, plan.vpl_count)}});
}

}  // namespace

float vpl_radius2(float bound, std::uint32_t vpl_count, float area) {
    return 4.0F * area / (std::numbers::pi_v<float> * static_cast<float>(vpl_count) * bound);
}

Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, ValueHandle<PathPlan> plan_handle,
                   BufferHandle<gpu::Light> lights, float bound) {
    return graph.add("vpl-trace", [&](Pass& pass) {
        pass.read(plan_handle);
        pass.read(lights, {Usage::storage, BINDING_LIGHTS});
        read_tracing(pass, tracing);
        pass.parameter(bound);
        const PathPrograms programs{.tracer = gpu.program({"vpls/vpl_trace.comp"}),
                                    .writer = gpu.program({"vpls/vpl_write.comp"}),
                                    .edges = gpu.program({"vpls/vpl_edges.comp"})};
        const PathBuffers buffers{
            .paths = pass.write(growing_buffer<gpu::Path>(graph, "paths"), {Usage::copy, BINDING_PATHS}),
            .weights =
                pass.write(growing_buffer<float>(graph, "path weights"), {Usage::copy, BINDING_PATH_WEIGHTS}),
            .records = pass.write(growing_buffer<gpu::VplRecord>(graph, "vpl records"),
                                  {Usage::storage, BINDING_VPL_RECORDS})};
        const TracedVpls traced{.plan = plan_handle,
                                .vpls = pass.write(growing_buffer<gpu::TracedVpl>(graph, "traced vpls"),
                                                   {Usage::storage, BINDING_TRACED_VPLS})};
        const Vpls out{.counts = pass.write(graph.value<VplCounts>("vpl counts")),
                       .flux = pass.write(growing_buffer<gpu::FluxAccount>(graph, "flux"),
                                          {Usage::storage, BINDING_FLUX}),
                       .records = traced};
        pass.run([=, &gpu](Execution& run) {
            const PathPlan& plan = run.value(plan_handle);
            const auto paths = static_cast<std::uint32_t>(plan.paths.size());
            run.set(out.counts, {.traced = plan.vpl_count, .accounts = paths});
            run.reserve(traced.vpls, plan.vpl_count);
            run.reserve(out.flux, plan.paths.size());
            run.reserve(buffers.records, plan.vpl_count);
            upload<gpu::Path>(gpu, run, buffers.paths, plan.paths);
            upload<float>(gpu, run, buffers.weights, plan.weights);
            if (!plan.paths.empty()) trace(gpu, programs, run.value(tracing.metrics), plan, bound);
        });
        return out;
    });
}

}  // namespace candela
