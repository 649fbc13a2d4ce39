#include "renderer/passes/scene/scene_upload.hpp"

#include <algorithm>
#include <cstddef>
#include <glm/matrix.hpp>
#include <memory>
#include <numeric>
#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/scene/kept_layout.hpp"

namespace candela {
namespace {

struct Gathered {
    ValueHandle<SceneGeometry> geometry;
    ValueHandle<ScenePlacement> placement;
    ValueHandle<Deformations> deformed;
};

/// Changed in place, so that it cannot be compared.
struct KeptList {
    std::shared_ptr<SceneList> list;
};

Gathered add_scene_gather(FrameGraph& graph, SceneCheck& check) {
    return graph.add("scene-gather", [&](Pass& pass) {
        pass.read<MeshInstance>();
        pass.read<DeformedMesh>();
        pass.read<Transform>();
        const auto kept = pass.update(graph.value<KeptList>("scene list"));
        const Gathered out{pass.write(graph.value<SceneGeometry>("scene geometry")),
                           pass.write(graph.value<ScenePlacement>("scene placement")),
                           pass.write(graph.value<Deformations>("deformations"))};
        pass.run([=, &check](Execution& run) {
            const std::shared_ptr<SceneList> list =
                run.has_result() ? run.previous(kept)->list : std::make_shared<SceneList>(check);
            list->update(run.world());
            run.set(out.deformed, list->placement().deformed);
            run.set(out.geometry, list->geometry());
            run.set(out.placement, list->placement());
            run.set(kept, {list});
        });
        return out;
    });
}

/// Changed in place, so that it cannot be compared.
struct KeptScene {
    std::shared_ptr<KeptLayout> layout;
    SharedArray<gpu::DrawCommand> draws;  // that are uploaded
};

/// 0, 1, 2, ...
void upload_instance_ids(const Gpu& gpu, Execution& run, BufferHandle<std::uint32_t> buffer,
                         std::uint64_t count, bool is_new) {
    if (!reserve_more(run, buffer, count) && !is_new) return;
    std::vector<std::uint32_t> ids(run.count(buffer));
    std::iota(ids.begin(), ids.end(), 0U);
    upload<std::uint32_t>(gpu, run, buffer, ids);
}

/// `before`: those in the buffer.
void upload_draws(const Gpu& gpu, Execution& run, BufferHandle<gpu::DrawCommand> buffer,
                  const SharedArray<gpu::DrawCommand>& before, const SharedArray<gpu::DrawCommand>& now) {
    const bool all = reserve_more(run, buffer, now.size());
    BufferWriter<gpu::DrawCommand> writer(gpu, run.object(buffer));
    visit_changes(all ? SharedArray<gpu::DrawCommand>() : before, now, [&](std::size_t i) {
        writer.seek(i);
        writer.push_back(now[i]);
    });
    writer.flush();
}

template <class T>
BufferHandle<T> write_upload(FrameGraph& graph, Pass& pass, std::string_view name) {
    return pass.write(growing_buffer<T>(graph, name), Usage::copy);
}

/// The same for a buffer whose content stays between frames.
template <class T>
BufferHandle<T> update_upload(FrameGraph& graph, Pass& pass, std::string_view name) {
    return pass.update(growing_buffer<T>(graph, name), Usage::copy);
}

gpu::Instance instance_of(const SceneLayout::Drawable& drawable, const ScenePlacement& placement) {
    const glm::mat4 rows = glm::transpose(placement.world[drawable.item]);
    return {.world = {rows[0], rows[1], rows[2]}, .material = drawable.drawn->material};
}

/// What the buffer of instances was made from.
struct UploadedInstances {
    SharedArray<SceneLayout::Drawable> drawables;
    SharedArray<glm::mat4> world;
    bool operator==(const UploadedInstances&) const = default;
};

/// The numbers of the drawables whose instances differ from those in the buffer, ascending.
std::vector<std::uint32_t> changed_instances(const SceneLayout& layout, const ScenePlacement& placement,
                                             const UploadedInstances& before) {
    std::vector<std::uint32_t> changed = moved_drawables(layout, before.world, placement.world);
    visit_changes(before.drawables, layout.drawables, [&](std::size_t i) {
        if (layout.drawables[i].drawn) changed.push_back(static_cast<std::uint32_t>(i));
    });
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
}

void upload_instances(const Gpu& gpu, Execution& run, const SceneData& scene,
                      const UploadedInstances* before) {
    const ScenePlacement& placement = run.value(scene.placement);
    const SceneLayout& layout = run.value(scene.layout);
    const bool all = reserve_more(run, scene.instances, layout.drawables.size()) || before == nullptr;
    const UploadedInstances known = all ? UploadedInstances{} : *before;
    BufferWriter<gpu::Instance> writer(gpu, run.object(scene.instances));
    for (const std::uint32_t i : changed_instances(layout, placement, known)) {
        writer.seek(i);
        writer.push_back(instance_of(layout.drawables[i], placement));
    }
    writer.flush();
}

void add_instance_upload(FrameGraph& graph, const Gpu& gpu, SceneData& scene) {
    graph.add("instance-upload", [&](Pass& pass) {
        pass.read(scene.placement);
        pass.read(scene.layout);
        const auto uploaded = pass.update(graph.value<UploadedInstances>("uploaded instances"));
        scene.instances = update_upload<gpu::Instance>(graph, pass, "instances");
        pass.run([=, &gpu](Execution& run) {
            upload_instances(gpu, run, scene, run.has_result() ? run.previous(uploaded) : nullptr);
            run.set(uploaded, {run.value(scene.layout).drawables, run.value(scene.placement).world});
        });
    });
}

/// At the places of the vertices that are drawn with them.
std::vector<glm::vec2> second_uvs_of(const SceneLayout& layout) {
    std::vector<glm::vec2> uvs(1);  // buffers must not be empty
    for (std::size_t i = 0; i < layout.drawables.size(); ++i) {
        if (!layout.drawables[i].drawn) continue;
        const std::vector<glm::vec2>& added = layout.drawables[i].primitive().second_uvs;
        const auto first = static_cast<std::size_t>(layout.draws[layout.draw_of[i]].base_vertex);
        if (added.empty()) continue;
        uvs.resize(std::max(uvs.size(), first + added.size()));
        std::ranges::copy(added, uvs.begin() + static_cast<std::ptrdiff_t>(first));
    }
    return uvs;
}

}  // namespace

SceneData add_scene_upload(FrameGraph& graph, Gpu& gpu, bool second_uvs) {
    const Gathered gathered = add_scene_gather(graph, gpu.scene_check());
    SceneData scene = graph.add("scene-upload", [&](Pass& pass) {
        pass.keeps_state();  // where things lie in the buffers depends on what was there before
        pass.read(gathered.geometry);
        pass.read(gathered.deformed);
        const auto kept = pass.update(graph.value<KeptScene>("kept scene"));
        const SceneData out{.placement = gathered.placement,
                            .layout = pass.write(graph.value<SceneLayout>("scene layout")),
                            .vertices = update_upload<Vertex>(graph, pass, "vertices"),
                            .indices = update_upload<std::uint32_t>(graph, pass, "indices"),
                            .instance_ids = update_upload<std::uint32_t>(graph, pass, "instance ids"),
                            .draws = update_upload<gpu::DrawCommand>(graph, pass, "draws"),
                            .materials = update_upload<gpu::Material>(graph, pass, "materials"),
                            .texels = update_upload<std::uint32_t>(graph, pass, "texels"),
                            .instances = {},
                            .second_uvs = {}};
        pass.run([=, &gpu](Execution& run) {
            const bool is_new = !run.has_result();
            KeptScene now = is_new ? KeptScene{std::make_shared<KeptLayout>(gpu), {}} : *run.previous(kept);
            const bool changed =
                now.layout->update(run, {out.vertices, out.indices, out.materials, out.texels},
                                   run.value(gathered.geometry), run.value(gathered.deformed));
            if (changed || is_new) {
                const SceneLayout& layout = now.layout->layout();
                upload_draws(gpu, run, out.draws, now.draws, layout.draws);
                upload_instance_ids(gpu, run, out.instance_ids, layout.drawables.size(), is_new);
                now.draws = layout.draws;
                run.set(out.layout, layout);
            }
            run.set(kept, now);
        });
        return out;
    });
    add_instance_upload(graph, gpu, scene);
    if (second_uvs) {
        graph.add("second-uv-upload", [&](Pass& pass) {
            pass.read(scene.layout);
            scene.second_uvs = write_upload<glm::vec2>(graph, pass, "second uvs");
            pass.run([=, &gpu](Execution& run) {
                upload<glm::vec2>(gpu, run, *scene.second_uvs, second_uvs_of(run.value(scene.layout)));
            });
        });
    }
    return scene;
}

}  // namespace candela
