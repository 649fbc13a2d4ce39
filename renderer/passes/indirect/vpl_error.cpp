#include "renderer/passes/indirect/vpl_error.hpp"

#include <cstddef>
#include <string_view>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/loop_parts.hpp"

namespace candela {
namespace {

/// Mean squared difference of two sets at a pixel over the mean squared error of one. It would be 2 if they
/// were independent and without bias; measured as shaders/README.md describes.
constexpr double difference_over_error = 2.5;

VplSamples add_samples(FrameGraph& graph, Gpu& gpu, std::string_view name, std::string_view result,
                       const Surfaces& surfaces, const VplLight& light, const ViewData& view) {
    return graph.add(name, [&](Pass& pass) {
        read_geometry(pass, surfaces);
        read_vpl_light(pass, light);
        read_view(pass, view);
        const gl::Program& program = gpu.program({"indirect/vpl_samples.comp"}, vpl_light_variant(light));
        const auto samples =
            pass.write(graph.buffer<glm::vec4>(result, SAMPLE_COLUMNS * SAMPLE_ROWS, Lifetime::persistent),
                       {Usage::storage, BINDING_VPL_SAMPLES});
        pass.run([=, &gpu, &program](Execution& run) {
            ComputeSteps steps(gpu);
            const Groups all{groups(SAMPLE_COLUMNS * SAMPLE_ROWS, SAMPLE_GROUP)};
            const VplCounts& counts = run.value(light.vpls.counts);
            const std::uint32_t inner = iterations_a_vpl(light, counts);
            for (const gl::Uniforms& part : loop_parts(gpu.device().limits(), counts.sources(), inner)) {
                steps.run(program, all, part);
            }
        });
        return samples;
    });
}

}  // namespace

VplErrorSamples add_vpl_error(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces, const VplLight& shown,
                              const VplLight& other, const ViewData& view) {
    return {
        .shown = add_samples(graph, gpu, "vpl-samples", "vpl samples", surfaces, shown, view),
        .other = add_samples(graph, gpu, "vpl-samples-other", "vpl samples, other", surfaces, other, view)};
}

double estimated_error(std::span<const glm::vec4> shown, std::span<const glm::vec4> other) {
    glm::dvec3 sum(0.0);
    double surfaces = 0.0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        sum += 0.5 * glm::dvec3(shown[i] + other[i]);
        surfaces += static_cast<double>(shown[i].a);
    }
    if (sum == glm::dvec3(0.0)) return 0.0;
    const double least = 0.01 * glm::dot(sum, sum) / (surfaces * surfaces);
    double differences = 0.0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const glm::dvec3 mean = 0.5 * glm::dvec3(shown[i] + other[i]);
        const glm::dvec3 apart(shown[i] - other[i]);
        differences += glm::dot(apart, apart) / (glm::dot(mean, mean) + least);
    }
    return differences / surfaces / difference_over_error;
}

}  // namespace candela
