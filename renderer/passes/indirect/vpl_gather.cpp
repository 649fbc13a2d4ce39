#include "renderer/passes/indirect/vpl_gather.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <utility>

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/gpu/loop_parts.hpp"

namespace candela {
namespace {

// Least number of VPLs per class of pixels for Interleave::automatic. With fewer, pixels at edges would be
// noisy, because some of their classes have no neighbour on the same surface.
constexpr std::uint32_t least_share = 8;
// Least height of the picture in pixels, divided by n: across n pixels, the light near an edge should hardly
// change.
constexpr std::uint32_t least_rows = 60;

/// Gathers in the dispatches of loop_parts, with `inner` iterations a VPL. Each adds to the sum of the ones
/// before.
void gather(const Gpu& gpu, const Execution& run, const gl::Program& program, glm::uvec2 size,
            std::uint32_t interleave, std::uint32_t vpl_count, std::uint32_t inner) {
    const glm::uvec2 of_class = (size + interleave - 1U) / interleave;
    const std::uint32_t classes = interleave * interleave;
    const Groups blocks{groups(of_class.x, PIXEL_BLOCK), groups(of_class.y, PIXEL_BLOCK), classes};
    ComputeSteps steps(gpu);
    for (const gl::Uniforms& part : loop_parts(gpu.device().limits(), groups(vpl_count, classes), inner)) {
        steps.run_rows(run, program, blocks, part + gl::Uniforms{{"interleave", interleave}});
    }
}

}  // namespace

std::uint32_t interleaving(Interleave interleave, std::uint32_t vpl_count, glm::uvec2 size) {
    if (interleave != Interleave::automatic) return 1U << (static_cast<std::uint32_t>(interleave) - 1U);
    std::uint32_t n = 8;
    while (n > 1 && (vpl_count < least_share * n * n || size.y < least_rows * n)) {
        n /= 2;
    }
    return n;
}

namespace {

/// The order of surfels and patches of the sky. Surfels lie in the buffer surface by surface. In this order
/// each share contains surfels of all surfaces, and kinds of VPLs follow one another, as add_vpls of
/// vpl_light.glsl has a loop for each.
std::vector<std::uint32_t> order_surfels(std::uint32_t count) {
    constexpr std::uint32_t most_shares = 64;
    std::vector<std::uint32_t> order;
    for (std::uint32_t share = 0; share < most_shares; ++share) {
        for (std::uint32_t i = share; i < count; i += most_shares) {
            order.push_back(i);
        }
    }
    return order;
}

}  // namespace

std::vector<std::uint32_t> order_vpls(const PathPlan& plan) {
    using Group = std::pair<std::uint32_t, std::uint32_t>;  // light and bounce
    std::map<Group, std::uint32_t> sizes;
    for (const gpu::Path& path : plan.paths) {
        for (std::uint32_t bounce = 0; bounce < path.vpl_count; ++bounce) {
            ++sizes[{path.light, bounce}];
        }
    }
    // Relative position of the VPL in its group, from 0 to 1, and its index.
    std::vector<std::pair<double, std::uint32_t>> placed;
    placed.reserve(plan.vpl_count);
    std::map<Group, std::uint32_t> seen;
    for (const gpu::Path& path : plan.paths) {
        for (std::uint32_t bounce = 0; bounce < path.vpl_count; ++bounce) {
            const Group group{path.light, bounce};
            placed.emplace_back((seen[group]++ + 0.5) / sizes[group], path.first_vpl + bounce);
        }
    }
    std::ranges::stable_sort(placed, {}, &std::pair<double, std::uint32_t>::first);
    std::vector<std::uint32_t> order(placed.size());
    std::ranges::transform(placed, order.begin(), &std::pair<double, std::uint32_t>::second);
    return order;
}

BufferHandle<std::uint32_t> add_vpl_order(FrameGraph& graph, const Gpu& gpu, const Vpls& vpls) {
    return graph.add("vpl-order", [&](Pass& pass) {
        std::optional<ValueHandle<PathPlan>> plan;
        if (const auto* const traced = std::get_if<TracedVpls>(&vpls.records)) {
            plan = traced->plan;
            pass.read(*plan);
        } else {
            pass.read(vpls.counts);
        }
        const auto order = pass.write(growing_buffer<std::uint32_t>(graph, "vpl order"), Usage::copy);
        pass.run([=, &gpu, counts = vpls.counts](Execution& run) {
            upload<std::uint32_t>(
                gpu, run, order,
                plan ? order_vpls(run.value(*plan)) : order_surfels(run.value(counts).sources()));
        });
        return order;
    });
}

GatheredLight write_gathered(FrameGraph& graph, Pass& pass, std::string_view name, glm::uvec2 size,
                             bool directed) {
    const auto write = [&](std::string_view content, GLuint image) {
        const TextureHandle texture =
            graph.texture(fmt::format("{} {}", name, content), {size, Format::rgba32f});
        return pass.write(texture, {Usage::storage, image});
    };
    GatheredLight light{.irradiance = write("irradiance", IMAGE_INDIRECT)};
    if (directed) light.flow = write("flow", IMAGE_INDIRECT_DIRECTION);
    return light;
}

void read_gathered(Pass& pass, const GatheredLight& light) {
    pass.read(light.irradiance, {Usage::sampled, UNIT_INDIRECT});
    if (light.flow) pass.read(*light.flow, {Usage::sampled, UNIT_INDIRECT_DIRECTION});
}

std::vector<std::string> gathered_variant(const GatheredLight& light, std::vector<std::string> others) {
    if (light.flow) others.emplace_back("DIRECTED");
    return others;
}

GatheredVpls add_vpl_gather(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces, const VplLight& light,
                            BufferHandle<std::uint32_t> order, const ViewData& view, std::uint32_t interleave,
                            bool directed) {
    return graph.add("vpl-gather", [&](Pass& pass) {
        pass.note(Workload::pixels_vpls);
        read_geometry(pass, surfaces);
        pass.read(order, {Usage::storage, BINDING_VPL_ORDER});
        read_vpl_light(pass, light);
        read_view(pass, view);
        pass.parameter(interleave);
        const GatheredVpls out{.light = write_gathered(graph, pass, "gathered", view.size, directed),
                               .order = order,
                               .interleave = interleave};
        const gl::Program& program = gpu.program(
            {"indirect/vpl_gather.comp"},
            gathered_variant(out.light,
                             block_variant(gpu.device().limits(), surfaces, vpl_light_variant(light))));
        pass.run([=, &gpu, &program](Execution& run) {
            const VplCounts& counts = run.value(light.vpls.counts);
            gather(gpu, run, program, view.size, interleave, counts.sources(),
                   iterations_a_vpl(light, counts));
        });
        return out;
    });
}

}  // namespace candela
