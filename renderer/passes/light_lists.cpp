#include "renderer/passes/light_lists.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

constexpr std::uint32_t cells_a_group = 64;  // as in shaders/light_cells.glsl

void set_grid(const gl::Program& program, const CellGrid& grid) {
    program.set("grid_tiles", grid.tiles);
    program.set("grid_slices", grid.slices);
    program.set("tile_size", grid.tile_size);
    program.set("first_depth", grid.first_depth);
    program.set("depth_ratio", grid.depth_ratio);
    program.set("target_pixels", grid.size);
}

/// What turns pixels and depths into view space: see shaders/light_cells.glsl.
void set_rays(const gl::Program& program, const CameraView& view) {
    const glm::mat4& clip = view.clip_from_view;
    const glm::vec2 scale(1.0F / clip[0][0], 1.0F / clip[1][1]);
    const glm::vec2 shift = view.orthographic ? glm::vec2(clip[3]) : -glm::vec2(clip[2]);
    program.set("view_from_world", view.view_from_world);
    program.set("ray_scale", scale);
    program.set("ray_shift", shift);
    program.set("orthographic", view.orthographic);
    program.set("depth_terms", glm::vec2(clip[2][2], clip[3][2]));
}

/// Node that sorts the lights into cells on the CPU and uploads them. `declare(Pass&)` states what the other
/// two read; `make_grid(Execution&)` gives the cells, `is_wanted(Execution&)` whether anybody will look at
/// the lists.
template <class Declare, class MakeGrid, class IsWanted>
BinBuffers add_light_bins(FrameGraph& graph, const Gpu& gpu, std::string_view name,
                          ValueHandle<LightTable> lights, ValueHandle<CameraView> view,
                          const ListSettings& settings, Declare declare, MakeGrid make_grid,
                          IsWanted is_wanted) {
    return graph.add(fmt::format("{}-bins", name), [&](Pass& pass) {
        pass.read(lights);
        pass.read(view);
        pass.parameter(settings);
        declare(pass);
        const auto buffer = [&](std::string_view what) {
            return pass.write(
                graph.buffer<std::uint32_t>(fmt::format("{} {}", name, what), 1, Lifetime::persistent),
                Usage::copy);
        };
        const BinBuffers out{.bins = pass.write(graph.value<LightBins>(fmt::format("{} bins", name))),
                             .first = buffer("first"),
                             .entries = buffer("entries")};
        pass.run([=, &gpu](Execution& run) {
            const LightTable nothing;
            const LightTable& table = is_wanted(run) ? run.value(lights) : nothing;
            LightBins bins = bin_lights(table, run.value(view), make_grid(run));
            upload<std::uint32_t>(gpu, run, out.first, bins.first);
            upload<std::uint32_t>(gpu, run, out.entries, bins.entries);
            run.set(out.bins, std::move(bins));
        });
        return out;
    });
}

/// As many dispatches as it takes for none to walk through too much of a list: see `most_asked`.
void dispatch_culling(const gl::Functions& gl, const gl::Program& program, const LightBins& bins) {
    constexpr std::uint32_t most = 32768;
    std::uint32_t longest = 0;
    for (std::size_t cell = 0; cell + 1 < bins.first.size(); ++cell) {
        longest = std::max(longest, bins.first[cell + 1] - bins.first[cell]);
    }
    program.set("culled_now", most);
    program.use();
    for (std::uint32_t culled = 0; culled == 0 || culled < longest; culled += most) {
        if (culled > 0) {
            gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        }
        program.set("culled_before", culled);
        gl.DispatchCompute((bins.grid.cells() + cells_a_group - 1) / cells_a_group, 1, 1);
    }
}

/// Node that culls the bins in place: each cell keeps, in order, the lights that reach it.
LightLists add_culling(FrameGraph& graph, Gpu& gpu, std::string_view name, const std::string& shader,
                       LightList kind, const BinBuffers& bins, BufferHandle<gpu::Light> lights,
                       ValueHandle<CameraView> view, std::optional<BufferHandle<gpu::TileDepth>> depths) {
    return graph.add(name, [&](Pass& pass) {
        pass.read(bins.bins);
        pass.read(view);
        pass.read(lights, Usage::storage);
        pass.read(bins.first, Usage::storage);
        if (depths) {
            pass.read(*depths, Usage::storage);
        }
        const gl::Program& program = gpu.program({shader});
        const LightLists out{.kind = kind,
                             .bins = bins.bins,
                             .view = view,
                             .first = bins.first,
                             .count = pass.write(graph.buffer<std::uint32_t>(fmt::format("{} count", name), 1,
                                                                             Lifetime::persistent),
                                                 Usage::storage),
                             .entries = pass.write(bins.entries, Usage::storage)};
        pass.run([=, &gpu, &program](Execution& run) {
            const CellGrid& grid = run.value(bins.bins).grid;
            run.reserve(out.count, grid.cells());
            gpu.bind_storage(BINDING_LIGHTS, run.object(lights));
            gpu.bind_storage(BINDING_LIST_FIRST, run.object(out.first));
            gpu.bind_storage(BINDING_LIST_COUNT, run.object(out.count));
            gpu.bind_storage(BINDING_LIST_ENTRIES, run.object(out.entries));
            program.set("has_depth", depths.has_value());
            if (depths) {
                gpu.bind_storage(BINDING_TILE_DEPTHS, run.object(*depths));
            }
            set_grid(program, grid);
            set_rays(program, run.value(view));
            dispatch_culling(gpu.gl(), program, run.value(bins.bins));
        });
        return out;
    });
}

BufferHandle<gpu::TileDepth> add_tile_depths(FrameGraph& graph, Gpu& gpu, TextureHandle depth,
                                             ValueHandle<CameraView> view, const CellGrid& grid) {
    return graph.add("tile-depths", [&](Pass& pass) {
        pass.read(depth, Usage::sampled);
        pass.read(view);
        const gl::Program& program = gpu.program({"tile_depths.comp"});
        const auto depths = pass.write(
            graph.buffer<gpu::TileDepth>("tile depths", grid.cells(), Lifetime::persistent), Usage::storage);
        pass.run([=, &gpu, &program](Execution& run) {
            gpu.gl().BindTextureUnit(UNIT_DEPTH, run.object(depth));
            gpu.bind_storage(BINDING_TILE_DEPTHS, run.object(depths));
            set_grid(program, grid);
            set_rays(program, run.value(view));
            program.use();
            gpu.gl().DispatchCompute(grid.tiles.x, grid.tiles.y, 1);
        });
        return depths;
    });
}

}  // namespace

LightLists add_light_tiles(FrameGraph& graph, Gpu& gpu, ValueHandle<LightTable> lights,
                           BufferHandle<gpu::Light> light_buffer, ValueHandle<CameraView> view,
                           std::optional<TextureHandle> depth, glm::uvec2 size,
                           const ListSettings& settings) {
    const BinBuffers bins = add_light_bins(
        graph, gpu, "light-tiles", lights, view, settings, [&](Pass& pass) { pass.parameter(size); },
        [=](Execution&) { return tile_grid(size, settings); }, [](Execution&) { return true; });
    std::optional<BufferHandle<gpu::TileDepth>> depths;
    if (depth) {
        depths = add_tile_depths(graph, gpu, *depth, view, tile_grid(size, settings));
    }
    return add_culling(graph, gpu, "light-tiles", "light_tiles.comp", LightList::tile, bins, light_buffer,
                       view, depths);
}

LightLists add_blended_light_tiles(FrameGraph& graph, Gpu& gpu, ValueHandle<LightTable> lights,
                                   BufferHandle<gpu::Light> light_buffer, ValueHandle<CameraView> view,
                                   ValueHandle<SceneLayout> layout, glm::uvec2 size,
                                   const ListSettings& settings) {
    const BinBuffers bins = add_light_bins(
        graph, gpu, "blended-light-tiles", lights, view, settings,
        [&](Pass& pass) {
            pass.read(layout);
            pass.parameter(size);
        },
        [=](Execution&) { return tile_grid(size, settings); },
        [=](Execution& run) { return !run.value(layout).groups_of(AlphaMode::blend).empty(); });
    return add_culling(graph, gpu, "blended-light-tiles", "light_tiles.comp", LightList::tile, bins,
                       light_buffer, view, std::nullopt);
}

LightLists add_light_clusters(FrameGraph& graph, Gpu& gpu, ValueHandle<LightTable> lights,
                              BufferHandle<gpu::Light> light_buffer, ValueHandle<CameraView> view,
                              ValueHandle<SceneMetrics> metrics, glm::uvec2 size,
                              const ListSettings& settings) {
    const auto make_grid = [=](Execution& run) {
        const SceneMetrics& scene = run.value(metrics);
        const float distance = glm::length(scene.centre() - run.value(view).eye);
        const float farthest = std::max(distance + scene.radius(), 1e-6F);
        // Nearer than a thousandth of the scene one slice is enough.
        const float nearest = std::max(distance - scene.radius(), 1e-3F * farthest);
        return cluster_grid(size, settings, nearest, farthest);
    };
    const BinBuffers bins = add_light_bins(
        graph, gpu, "light-clusters", lights, view, settings,
        [&](Pass& pass) {
            pass.read(metrics);
            pass.parameter(size);
        },
        make_grid, [](Execution&) { return true; });
    return add_culling(graph, gpu, "light-clusters", "light_clusters.comp", LightList::cluster, bins,
                       light_buffer, view, std::nullopt);
}

void read_light_lists(Pass& pass, const LightLists& lists) {
    pass.read(lists.bins);
    pass.read(lists.view);
    pass.read(lists.first, Usage::storage);
    pass.read(lists.count, Usage::storage);
    pass.read(lists.entries, Usage::storage);
}

void bind_light_lists(const Gpu& gpu, Execution& run, const gl::Program& program, const LightLists& lists) {
    const LightBins& bins = run.value(lists.bins);
    gpu.bind_storage(BINDING_LIST_FIRST, run.object(lists.first));
    gpu.bind_storage(BINDING_LIST_COUNT, run.object(lists.count));
    gpu.bind_storage(BINDING_LIST_ENTRIES, run.object(lists.entries));
    program.set("global_light_count", bins.global_count);
    program.set("view_from_world", run.value(lists.view).view_from_world);
    set_grid(program, bins.grid);
}

}  // namespace candela
