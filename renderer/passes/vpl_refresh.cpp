#include "renderer/passes/vpl_refresh.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <glm/vec4.hpp>
#include <iterator>
#include <utility>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

constexpr std::uint32_t checks_a_group = 32;  // as in shaders/vpl_check.comp

/// Everything that a schedule depends on.
struct RefreshInputs {
    VplPaths plan;
    LightTable lights;
    SceneGeometry geometry;
    ScenePlacement placement;
    std::vector<std::shared_ptr<const Material>> materials;
    VplClock clock;
    VplSettings settings;
    bool has_maps = false;
};

/// What outlasts a frame.
struct RefreshState {
    RefreshInputs inputs;
    VplMemory memory;
};

struct RefreshHandles {
    ValueHandle<RefreshState> state;
    DueVpls out;
    BufferHandle<gpu::CheckedPath> checked;
    BufferHandle<std::uint32_t> tiles;
    BufferHandle<gpu::PathCheck> checks;
};

/// An item of a scene and where it is, comparable byte for byte.
struct PlacedItem {
    const Mesh* mesh;
    glm::mat4 world;

    bool operator<(const PlacedItem& other) const {
        return mesh == other.mesh ? std::memcmp(&world, &other.world, sizeof(world)) < 0
                                  : std::less<>{}(mesh, other.mesh);
    }
};

std::vector<PlacedItem> placed_items(const SceneGeometry& geometry, const ScenePlacement& placement) {
    std::vector<PlacedItem> items;
    items.reserve(geometry.items.size());
    for (std::size_t i = 0; i < geometry.items.size(); ++i) {
        items.push_back({geometry.items[i].mesh.get(), placement.world[i]});
    }
    std::sort(items.begin(), items.end());
    return items;
}

/// Box around what of an item stops light; empty if nothing does.
Box box_around(const PlacedItem& item) {
    Box box;
    for (const Primitive& primitive : item.mesh->primitives) {
        if (primitive.material->alpha_mode == AlphaMode::blend) {
            continue;
        }
        for (const Vertex& vertex : primitive.vertices) {
            box.grow(glm::vec3(item.world * glm::vec4(vertex.position, 1.0F)));
        }
    }
    return box;
}

ScheduleSettings schedule_settings(const RefreshInputs& inputs) {
    return {.budget = inputs.settings.budget, .tiles = inputs.settings.count, .maps = inputs.has_maps};
}

/// Whether the memory is of no use. Refinement goes on to a set of its own, all at once; back from there the
/// VPLs of that set serve until the budget has replaced them.
bool starts_over(const RefreshInputs& before, const RefreshInputs& now) {
    const bool next_set = before.plan.seed != now.plan.seed && now.plan.seed != now.settings.seed;
    return before.clock.epoch != now.clock.epoch || next_set || before.settings.seed != now.settings.seed ||
           before.settings.count != now.settings.count || before.settings.bounces != now.settings.bounces ||
           before.has_maps != now.has_maps;
}

/// The paths as the shader is to test them, and their tiles.
struct CheckOrder {
    std::vector<gpu::CheckedPath> paths;
    std::vector<std::uint32_t> tiles;
};

CheckOrder order_checks(const RefreshInputs& now, const VplMemory& memory, bool scene_changed) {
    const std::vector<std::uint32_t> known = match_paths(now.plan, now.lights, memory);
    const std::vector<std::uint8_t> moved = moved_lights(now.lights, memory);
    CheckOrder order;
    order.paths.reserve(known.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
        const gpu::Path& path = now.plan.paths[i];
        order.paths.push_back({.light = path.light,
                               .index = path.index,
                               .seed = path.seed,
                               .first_tile = static_cast<std::uint32_t>(order.tiles.size()),
                               .bounces = 0,
                               .tested = 0,
                               .canonical = 0,
                               .traced_seed = path.seed});
        if (known[i] == no_path) {
            continue;
        }
        const gpu::Path& before = memory.paths.paths[known[i]];
        const bool light_moved = moved[path.light] != 0;
        gpu::CheckedPath& checked = order.paths.back();
        checked.bounces = std::min(before.bounces, path.vpl_count);
        checked.tested = scene_changed ? checked.bounces : (light_moved ? 1U : 0U);
        checked.traced_seed = before.seed;
        const bool same_light = !light_moved && before.seed == path.seed;
        checked.canonical = memory.memories[known[i]].canonical && same_light ? 1 : 0;
        for (std::uint32_t bounce = 0; bounce < checked.bounces; ++bounce) {
            order.tiles.push_back(memory.paths.places[before.first_vpl + bounce].tile);
        }
    }
    return order;
}

template <class T>
std::vector<T> read_back(const Gpu& gpu, Execution& run, BufferHandle<T> buffer, std::size_t count) {
    std::vector<T> content(count);
    gpu.gl().GetNamedBufferSubData(run.object(buffer), 0, static_cast<GLsizeiptr>(count * sizeof(T)),
                                   content.data());
    return content;
}

/// Tests paths on the GPU, and waits.
std::vector<gpu::PathCheck> check_paths(const Gpu& gpu, Execution& run, const gl::Program& program,
                                        const Tracing& tracing, BufferHandle<gpu::Light> lights,
                                        const RefreshHandles& handles, const CheckOrder& order) {
    const auto path_count = static_cast<std::uint32_t>(order.paths.size());
    upload<gpu::CheckedPath>(gpu, run, handles.checked, order.paths);
    upload<std::uint32_t>(gpu, run, handles.tiles, order.tiles);
    run.reserve(handles.checks, path_count);
    bind_tracing(gpu, run, program, tracing);
    gpu.bind_storage(BINDING_LIGHTS, run.object(lights));
    gpu.bind_storage(BINDING_PATHS, run.object(handles.checked));
    gpu.bind_storage(BINDING_VPL_PLACES, run.object(handles.tiles));
    gpu.bind_storage(BINDING_VPL_RECORDS, run.object(handles.out.records));
    gpu.bind_storage(BINDING_PATH_CHECKS, run.object(handles.checks));
    program.set("path_count", path_count);
    program.set("ray_offset", run.value(tracing.metrics).ray_offset());
    program.use();
    // The records are those of the frame before, of which the plan of this frame's barriers does not know.
    gpu.gl().MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    gpu.gl().DispatchCompute((path_count + checks_a_group - 1) / checks_a_group, 1, 1);
    gpu.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return read_back(gpu, run, handles.checks, order.paths.size());
}

std::vector<CheckedLength> checked_lengths(const std::vector<gpu::PathCheck>& checks) {
    std::vector<CheckedLength> lengths;
    lengths.reserve(checks.size());
    for (const gpu::PathCheck& check : checks) {
        lengths.push_back(
            {.bounces = check.bounces, .start = check.start, .canonical_start = check.canonical});
    }
    return lengths;
}

std::vector<RecordedVpl> recorded_vpls(const std::vector<gpu::VplRecord>& records) {
    std::vector<RecordedVpl> vpls;
    vpls.reserve(records.size());
    for (const gpu::VplRecord& record : records) {
        const glm::vec3 colour = record.throughput;
        const float mean =
            record.state == gpu::VplState::placed ? (colour.r + colour.g + colour.b) / 3.0F : 0.0F;
        vpls.push_back({.position = record.position, .normal = record.normal, .throughput = mean});
    }
    return vpls;
}

/// Whether a schedule needs to know of paths what only the GPU can tell: whether they still hold, and, unless
/// all are as full regeneration would have them, where they start.
bool needs_checks(const RefreshInputs& now, const VplMemory& memory, bool scene_changed) {
    const auto moved = moved_lights(now.lights, memory);
    const bool light_moved = std::ranges::any_of(moved, [](std::uint8_t m) { return m != 0; });
    if (scene_changed || light_moved || memory.paths.seed != now.plan.seed) {
        return true;
    }
    const auto known = match_paths(now.plan, now.lights, memory);
    bool settled = true;
    bool located = true;
    for (std::size_t i = 0; i < known.size(); ++i) {
        const std::uint32_t k = known[i];
        settled = settled && k != no_path && memory.memories[k].canonical &&
                  memory.paths.paths[k].bounces >= now.plan.paths[i].vpl_count;
        located = located && k != no_path && memory.memories[k].located;
    }
    return !settled && !located;
}

/// Finds out what has become of the memory: asks `check` of paths and `read_records` for VPLs on the GPU, if
/// anything changed that they depend on.
template <class Check, class ReadRecords>
VplChecks check_memory(const RefreshState& last, const RefreshInputs& now, const Check& check,
                       const ReadRecords& read_records) {
    VplChecks checks;
    const std::vector<Box> moved =
        moved_boxes(last.inputs.geometry, last.inputs.placement, now.geometry, now.placement);
    const bool scene_changed = !moved.empty() || last.inputs.materials != now.materials;
    if (!now.plan.paths.empty() && needs_checks(now, last.memory, scene_changed)) {
        checks.paths = checked_lengths(check(order_checks(now, last.memory, scene_changed)));
    }
    if (now.has_maps && !moved.empty()) {
        checks.moved = moved;
        checks.records = recorded_vpls(read_records());
    }
    return checks;
}

}  // namespace

std::vector<Box> moved_boxes(const SceneGeometry& before, const ScenePlacement& placed_before,
                             const SceneGeometry& now, const ScenePlacement& placed_now) {
    const std::vector<PlacedItem> old_items = placed_items(before, placed_before);
    const std::vector<PlacedItem> new_items = placed_items(now, placed_now);
    std::vector<PlacedItem> different;
    std::set_symmetric_difference(old_items.begin(), old_items.end(), new_items.begin(), new_items.end(),
                                  std::back_inserter(different));
    std::vector<Box> boxes;
    for (const PlacedItem& item : different) {
        const Box box = box_around(item);
        if (box != Box{}) {
            boxes.push_back(box);
        }
    }
    return boxes;
}

DueVpls add_vpl_refresh(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const Tracing& tracing,
                        const RefreshSources& sources, const VplSettings& settings, bool has_maps) {
    return graph.add("vpl-refresh", [&](Pass& pass) {
        pass.remembers();
        pass.read(sources.all.paths);
        pass.read(sources.lights);
        pass.read(sources.light_buffer, Usage::storage);
        pass.read(sources.clock);
        pass.read(scene.layout);
        pass.read(scene.placement);
        read_tracing(pass, tracing);
        pass.parameter(settings);
        pass.parameter(has_maps);
        const gl::Program& program = gpu.program({"vpl_check.comp"});
        const auto scratch = [&]<class T>(T /*element*/, std::string_view name, Usage usage) {
            return pass.write(graph.buffer<T>(name, 1, Lifetime::persistent), usage);
        };
        const RefreshHandles handles{.state = pass.write(graph.value<RefreshState>("vpl memory")),
                                     .out = {.paths = pass.write(graph.value<VplPaths>("vpl schedule")),
                                             .records = pass.write(sources.all.records, Usage::storage)},
                                     .checked = scratch(gpu::CheckedPath{}, "checked paths", Usage::copy),
                                     .tiles = scratch(std::uint32_t{}, "checked tiles", Usage::copy),
                                     .checks = scratch(gpu::PathCheck{}, "path checks", Usage::storage)};
        pass.run([=, &gpu, &program, layout = scene.layout, placement = scene.placement](Execution& run) {
            RefreshInputs inputs{.plan = run.value(sources.all.paths),
                                 .lights = run.value(sources.lights),
                                 .geometry = run.value(layout).geometry,
                                 .placement = run.value(placement),
                                 .materials = run.value(layout).materials,
                                 .clock = run.value(sources.clock),
                                 .settings = settings,
                                 .has_maps = has_maps};
            const RefreshState* last = run.find(handles.state);
            run.reserve(handles.out.records, std::max(settings.count, 1U));
            const ScheduleSettings limits = schedule_settings(inputs);
            if (!last || starts_over(last->inputs, inputs)) {
                VplMemory memory = schedule_all(inputs.plan, inputs.lights, limits);
                run.set(handles.out.paths, memory.paths);
                run.set(handles.state, {std::move(inputs), std::move(memory)});
                return;
            }

            const VplChecks checks = check_memory(
                *last, inputs,
                [&](const CheckOrder& order) {
                    return check_paths(gpu, run, program, tracing, sources.light_buffer, handles, order);
                },
                [&] {
                    gpu.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
                    return read_back(gpu, run, handles.out.records, std::max(settings.count, 1U));
                });
            VplMemory memory = schedule(inputs.plan, inputs.lights, last->memory, checks, limits);
            run.set(handles.out.paths, memory.paths);
            run.set(handles.state, {std::move(inputs), std::move(memory)});
        });
        return handles.out;
    });
}

}  // namespace candela
