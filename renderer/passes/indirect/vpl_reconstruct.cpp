#include "renderer/passes/indirect/vpl_reconstruct.hpp"

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/loop_parts.hpp"

namespace candela {
namespace {

/// Inputs of all nodes.
struct Pixels {
    Surfaces surfaces;
    ViewData view;
    std::uint32_t interleave;
    glm::uvec2 size;
};

void read_pixels(Pass& pass, const Pixels& pixels) {
    read_geometry(pass, pixels.surfaces);
    read_view(pass, pixels.view);
    pass.parameter(pixels.interleave);
}

std::uint32_t groups_of_row(glm::uvec2 size) {
    return groups(size.x, RECONSTRUCT_GROUP);
}

/// The program of both steps. `before` is what it reads.
const gl::Program& program_of(Gpu& gpu, const Pixels& pixels, const GatheredLight& before) {
    return gpu.program({"indirect/vpl_reconstruct.comp"},
                       gathered_variant(before, surface_variant(pixels.surfaces)));
}

void reconstruct(const Gpu& gpu, const gl::Program& program, const Pixels& pixels, bool columns) {
    ComputeSteps(gpu).run(program, {groups_of_row(pixels.size), pixels.size.y},
                          {{"interleave", pixels.interleave}, {"columns", columns}});
}

GatheredLight add_rows(FrameGraph& graph, Gpu& gpu, const Pixels& pixels, const GatheredLight& gathered) {
    return graph.add("vpl-reconstruct-rows", [&](Pass& pass) {
        pass.note(Workload::pixels);
        read_pixels(pass, pixels);
        read_gathered(pass, gathered);
        const gl::Program& program = program_of(gpu, pixels, gathered);
        const GatheredLight out = write_gathered(graph, pass, "row", pixels.size, gathered.flow.has_value());
        pass.run([=, &gpu, &program](Execution&) { reconstruct(gpu, program, pixels, false); });
        return out;
    });
}

struct Columns {
    GatheredLight light;
    BufferHandle<std::uint32_t> fill_mask;  ///< one bit per pixel, `row_words` words per row
};

/// Words of the fill mask per row of pixels: 32 pixels per word, rounded up to whole work groups.
std::uint32_t row_words(glm::uvec2 size) {
    return groups_of_row(size) * (RECONSTRUCT_GROUP / 32);
}

Columns add_columns(FrameGraph& graph, Gpu& gpu, const Pixels& pixels, const GatheredLight& rows) {
    return graph.add("vpl-reconstruct", [&](Pass& pass) {
        pass.note(Workload::pixels);
        read_pixels(pass, pixels);
        read_gathered(pass, rows);
        const gl::Program& program = program_of(gpu, pixels, rows);
        const Columns out{
            .light = write_gathered(graph, pass, "indirect", pixels.size, rows.flow.has_value()),
            .fill_mask = pass.write(graph.buffer<std::uint32_t>(
                                        "fill mask", std::uint64_t{row_words(pixels.size)} * pixels.size.y),
                                    {Usage::storage, BINDING_FILL_MASK})};
        pass.run([=, &gpu, &program](Execution&) { reconstruct(gpu, program, pixels, true); });
        return out;
    });
}

BufferHandle<std::uint32_t> add_list(FrameGraph& graph, Gpu& gpu, const Columns& columns, glm::uvec2 size) {
    return graph.add("vpl-fill-list", [&](Pass& pass) {
        pass.note(Workload::pixels);
        pass.read(columns.fill_mask, {Usage::storage, BINDING_FILL_MASK});
        const gl::Program& program = gpu.program({"indirect/vpl_fill_list.comp"});
        const auto list =
            pass.write(graph.buffer<std::uint32_t>("fill list", 4 + std::uint64_t{size.x} * size.y,
                                                   Lifetime::persistent),
                       {Usage::storage, BINDING_FILL_LIST});
        pass.run([=, &gpu, &program](Execution&) {
            const std::uint32_t mask_words = row_words(size) * size.y;
            ComputeSteps(gpu).run(program, {groups(mask_words, LIST_GROUP * LIST_WORDS)},
                                  {{"row_words", row_words(size)}, {"mask_words", mask_words}});
        });
        return list;
    });
}

/// Evaluates VPLs in the dispatches of loop_parts, with `inner` iterations a VPL. Each adds to the sum of the
/// ones before.
void fill(const Gpu& gpu, const gl::Program& program, std::uint32_t vpl_count, std::uint32_t one_in,
          std::uint32_t inner) {
    ComputeSteps steps(gpu);
    for (const gl::Uniforms& part :
         loop_parts(gpu.device().limits(), (vpl_count + one_in - 1) / one_in, inner)) {
        steps.run_indirect(program, part + gl::Uniforms{{"one_in", one_in}});
    }
}

GatheredLight add_fill(FrameGraph& graph, Gpu& gpu, const Pixels& pixels, const IndirectLight& found,
                       BufferHandle<std::uint32_t> order, const VplLight& light, std::uint32_t one_in) {
    return graph.add("vpl-fill", [&](Pass& pass) {
        pass.note(Workload::pixels);
        pass.parameter(one_in);
        read_pixels(pass, pixels);
        pass.read(order, {Usage::storage, BINDING_VPL_ORDER});
        pass.read(found.fill_list, {Usage::storage, BINDING_FILL_LIST});
        pass.read(found.fill_list, Usage::indirect);
        read_vpl_light(pass, light);
        const gl::Program& program = gpu.program(
            {"indirect/vpl_fill.comp"},
            gathered_variant(found.light, surface_variant(pixels.surfaces, vpl_light_variant(light))));
        GatheredLight out{pass.write(found.light.irradiance, {Usage::storage, IMAGE_INDIRECT})};
        if (found.light.flow) {
            out.flow = pass.write(*found.light.flow, {Usage::storage, IMAGE_INDIRECT_DIRECTION});
        }
        pass.run([=, &gpu, &program](Execution& run) {
            const VplCounts& counts = run.value(light.vpls.counts);
            fill(gpu, program, counts.sources(), one_in, iterations_a_vpl(light, counts));
        });
        return out;
    });
}

}  // namespace

GatheredLight add_rough_reconstruct(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                    const GatheredVpls& gathered, const ViewData& view) {
    const Pixels pixels{surfaces, view, gathered.interleave, view.size};
    return add_columns(graph, gpu, pixels, add_rows(graph, gpu, pixels, gathered.light)).light;
}

IndirectLight add_vpl_reconstruct(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                  const GatheredVpls& gathered, const VplLight& light, const ViewData& view,
                                  std::uint32_t filled_from) {
    const Pixels pixels{surfaces, view, gathered.interleave, view.size};
    const GatheredLight rows = add_rows(graph, gpu, pixels, gathered.light);
    const Columns columns = add_columns(graph, gpu, pixels, rows);
    IndirectLight found{columns.light, add_list(graph, gpu, columns, view.size)};
    found.light = add_fill(graph, gpu, pixels, found, gathered.order, light, filled_from);
    return found;
}

}  // namespace candela
