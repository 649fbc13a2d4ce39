#include "renderer/passes/vpl_trace.hpp"

#include <algorithm>
#include <cmath>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

constexpr std::uint32_t paths_a_group = 32;  // as in shaders/vpl_trace.comp

/// What the shader is told of the paths.
struct PathBuffers {
    BufferHandle<gpu::Path> paths;
    BufferHandle<gpu::VplPlace> places;
};

/// Four times the mean distance between VPLs: farther off hardly any sinks, as shaders/lighting.glsl has it.
float edge_reach(float area, std::uint32_t vpl_count) {
    return 4.0F * std::sqrt(area / static_cast<float>(vpl_count));
}

void trace(const Gpu& gpu, Execution& run, const gl::Program& program, const Tracing& tracing,
           const Vpls& out) {
    const VplPaths& plan = run.value(out.paths);
    run.reserve(out.vpls, std::max(plan.vpl_count, 1U));
    run.reserve(out.flux, std::max<std::size_t>(plan.paths.size(), 1));
    if (plan.paths.empty()) {
        return;
    }

    const auto path_count = static_cast<std::uint32_t>(plan.paths.size());
    bind_tracing(gpu, run, program, tracing);
    gpu.bind_storage(BINDING_VPLS, run.object(out.vpls));
    gpu.bind_storage(BINDING_FLUX, run.object(out.flux));
    program.set("path_count", path_count);
    program.set("max_bounces", plan.max_bounces);
    program.set("ray_offset", run.value(tracing.metrics).ray_offset());
    program.set("edge_reach", edge_reach(run.value(tracing.metrics).area, plan.vpl_count));
    program.use();
    gpu.gl().DispatchCompute((path_count + paths_a_group - 1) / paths_a_group, 1, 1);
}

}  // namespace

BufferHandle<gpu::VplRecord> vpl_records(FrameGraph& graph) {
    return graph.buffer<gpu::VplRecord>("vpl records", 1, Lifetime::persistent);
}

Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const DueVpls& due,
                   BufferHandle<gpu::Light> lights) {
    return graph.add("vpl-trace", [&](Pass& pass) {
        pass.read(due.paths);
        pass.read(lights, Usage::storage);
        read_tracing(pass, tracing);
        const gl::Program& program = gpu.program({"vpl_trace.comp"});
        const PathBuffers buffers{
            .paths = pass.write(graph.buffer<gpu::Path>("paths", 1, Lifetime::persistent), Usage::copy),
            .places =
                pass.write(graph.buffer<gpu::VplPlace>("vpl places", 1, Lifetime::persistent), Usage::copy)};
        const bool first_writer = due.records.version == 0;
        const BufferHandle<gpu::VplRecord> traced = pass.write(due.records, Usage::storage);
        const Vpls out{
            .paths = due.paths,
            .vpls = pass.write(graph.buffer<gpu::Vpl>("vpls", 1, Lifetime::persistent), Usage::storage),
            .flux =
                pass.write(graph.buffer<gpu::FluxAccount>("flux", 1, Lifetime::persistent), Usage::storage)};
        pass.run([=, &gpu, &program](Execution& run) {
            const VplPaths& plan = run.value(out.paths);
            if (first_writer) {
                run.reserve(traced, std::max(plan.map_count, 1U));
            }
            upload<gpu::Path>(gpu, run, buffers.paths, plan.paths);
            upload<gpu::VplPlace>(gpu, run, buffers.places, plan.places);
            gpu.bind_storage(BINDING_LIGHTS, run.object(lights));
            gpu.bind_storage(BINDING_PATHS, run.object(buffers.paths));
            gpu.bind_storage(BINDING_VPL_PLACES, run.object(buffers.places));
            gpu.bind_storage(BINDING_VPL_RECORDS, run.object(traced));
            trace(gpu, run, program, tracing, out);
        });
        return out;
    });
}

}  // namespace candela
