#include "renderer/passes/vpls/vpl_trace.hpp"

#include <algorithm>
#include <cmath>

#include <candela/graph/execute.hpp>
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

/// Traces one segment per dispatch. A longer loop would reach the number of iterations after which software
/// drivers silently stop all loops of an invocation.
void trace_segments(const Gpu& gpu, Execution& run, const gl::Program& program, const Tracing& tracing,
                    const VplPlan& plan) {
    const auto path_count = static_cast<std::uint32_t>(plan.paths.size());
    program.set("path_count", path_count);
    program.set("ray_offset", run.value(tracing.metrics).ray_offset());
    program.use();
    for (std::uint32_t bounce = 1; bounce <= plan.max_bounces; ++bounce) {
        program.set("bounce", bounce);
        gpu.gl().DispatchCompute(groups(path_count, paths_a_group), 1, 1);
        gpu.gl().MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
}

void write_vpls(const Gpu& gpu, const gl::Program& program, const VplPlan& plan) {
    const auto path_count = static_cast<std::uint32_t>(plan.paths.size());
    program.set("path_count", path_count);
    program.set("max_bounces", plan.max_bounces);
    program.use();
    gpu.gl().DispatchCompute(groups(path_count, paths_a_group), 1, 1);
    gpu.gl().MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void find_edges(const Gpu& gpu, Execution& run, const gl::Program& program, const Tracing& tracing,
                const VplPlan& plan) {
    program.set("vpl_count", plan.vpl_count);
    program.set("edge_reach", edge_reach(run.value(tracing.metrics).area, plan.vpl_count));
    program.use();
    gpu.gl().DispatchCompute(1, groups(plan.vpl_count, vpls_a_group), 1);
}

}  // namespace

Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, ValueHandle<VplPlan> plan_handle,
                   BufferHandle<gpu::Light> lights) {
    return graph.add("vpl-trace", [&](Pass& pass) {
        pass.read(plan_handle);
        pass.read(lights, {Usage::storage, BINDING_LIGHTS});
        read_tracing(pass, tracing);
        const gl::Program& tracer = gpu.program({"vpls/vpl_trace.comp"});
        const gl::Program& writer = gpu.program({"vpls/vpl_write.comp"});
        const gl::Program& edges = gpu.program({"vpls/vpl_edges.comp"});
        const PathBuffers buffers{
            .paths = pass.write(graph.buffer<gpu::Path>("paths", 1, Lifetime::persistent),
                                {Usage::copy, BINDING_PATHS}),
            .weights = pass.write(graph.buffer<float>("path weights", 1, Lifetime::persistent),
                                  {Usage::copy, BINDING_PATH_WEIGHTS}),
            .records = pass.write(graph.buffer<gpu::VplRecord>("vpl records", 1, Lifetime::persistent),
                                  {Usage::storage, BINDING_VPL_RECORDS})};
        const Vpls out{.plan = plan_handle,
                       .vpls = pass.write(graph.buffer<gpu::Vpl>("vpls", 1, Lifetime::persistent),
                                          {Usage::storage, BINDING_VPLS}),
                       .flux = pass.write(graph.buffer<gpu::FluxAccount>("flux", 1, Lifetime::persistent),
                                          {Usage::storage, BINDING_FLUX})};
        pass.run([=, &gpu, &tracer, &writer, &edges](Execution& run) {
            const VplPlan& plan = run.value(out.plan);
            run.reserve(out.vpls, std::max(plan.vpl_count, 1U));
            run.reserve(out.flux, std::max<std::size_t>(plan.paths.size(), 1));
            run.reserve(buffers.records, std::max(plan.vpl_count, 1U));
            upload<gpu::Path>(gpu, run, buffers.paths, plan.paths);
            upload<float>(gpu, run, buffers.weights, plan.weights);
            if (plan.paths.empty()) {
                return;
            }
            trace_segments(gpu, run, tracer, tracing, plan);
            write_vpls(gpu, writer, plan);
            find_edges(gpu, run, edges, tracing, plan);
        });
        return out;
    });
}

}  // namespace candela
