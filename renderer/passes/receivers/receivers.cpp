#include "renderer/passes/receivers/receivers.hpp"

#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/loop_parts.hpp"

namespace candela {
namespace {

BufferHandle<gpu::LightReceiver> add_upload(FrameGraph& graph, Gpu& gpu,
                                            ValueHandle<std::vector<Receiver>> receivers) {
    return graph.add("receivers", [&](Pass& pass) {
        pass.read(receivers);
        const auto uploaded = pass.write(growing_buffer<gpu::LightReceiver>(graph, "receivers"), Usage::copy);
        pass.run([=, &gpu](Execution& run) {
            std::vector<gpu::LightReceiver> elements;
            for (const Receiver& receiver : run.value(receivers)) {
                elements.push_back({.position = receiver.position, .normal = receiver.normal});
            }
            upload<gpu::LightReceiver>(gpu, run, uploaded, elements);
        });
        return uploaded;
    });
}

/// The dispatches that sum the lights, then those that add the VPLs.
std::vector<gl::Uniforms> parts_of(const gl::Limits& limits, const Execution& run, const Lighting& lighting) {
    std::vector<gl::Uniforms> parts;
    for (const gl::Uniforms& part : lighting_parts(limits, run, lighting, 1)) {
        parts.push_back(part + gl::Uniforms{{"adds_lights", true}});
    }
    if (!lighting.vpls) return parts;
    const VplCounts& vpls = run.value(lighting.vpls->vpls.counts);
    const std::uint32_t inner = iterations_a_vpl(*lighting.vpls, vpls);
    for (const gl::Uniforms& part : loop_parts(limits, vpls.sources(), inner)) {
        parts.push_back(part + gl::Uniforms{{"adds_lights", false}});
    }
    return parts;
}

}  // namespace

ReceivedLight add_receivers(FrameGraph& graph, Gpu& gpu, ValueHandle<std::vector<Receiver>> receivers,
                            const Lighting& lighting) {
    const BufferHandle<gpu::LightReceiver> uploaded = add_upload(graph, gpu, receivers);
    return graph.add("receiver-light", [&](Pass& pass) {
        pass.read(receivers);
        pass.read(uploaded, {Usage::storage, BINDING_RECEIVERS});
        read_lighting(pass, lighting);
        const auto received = pass.write(growing_buffer<glm::vec4>(graph, "received light"),
                                         {Usage::storage, BINDING_RECEIVED});
        const gl::Program& program =
            gpu.program({"receivers/receiver_light.comp"}, lighting_variant(gpu.device().limits(), lighting));
        pass.run([=, &gpu, &program](Execution& run) {
            const auto count = static_cast<std::uint32_t>(run.value(receivers).size());
            run.reserve(received, count);
            ComputeSteps steps(gpu);
            for (const gl::Uniforms& part : parts_of(gpu.device().limits(), run, lighting)) {
                steps.run(program, {groups(count, RECEIVER_GROUP)},
                          part + gl::Uniforms{{"receiver_count", count}});
            }
        });
        return received;
    });
}

}  // namespace candela
