#include "renderer/passes/scene/scene_upload.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <glm/matrix.hpp>
#include <map>
#include <memory>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/scene/material_upload.hpp"
#include "renderer/passes/scene/mesh_upload.hpp"

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

/// What is on the GPU of the scene's meshes and materials. It stays there while the world keeps it.
struct SceneStore {
    explicit SceneStore(Gpu& gpu) : materials(gpu) {}
    MaterialTable materials;
    MeshTable meshes;
    std::uint32_t instance_ids = 0;  // that are uploaded
};

/// What determines the drawing order. One call draws all drawables with equal keys, unless they are blended.
struct DrawKey {
    AlphaMode alpha;
    bool double_sided;
    bool mirrored;
    bool emits;
    MaterialImages images;

    [[nodiscard]] auto order() const {
        return std::tie(alpha, images[base_colour_slot], double_sided, mirrored, emits, images);
    }
    [[nodiscard]] bool operator<(const DrawKey& other) const { return order() < other.order(); }
};
using Buckets = std::map<DrawKey, std::vector<SceneLayout::Drawable>>;

/// Sorts the drawables of the scene, which become its meshes and materials. What is the same for all things
/// with a mesh or a material is found once.
class Sorter {
 public:
    explicit Sorter(SceneStore& store) : store_(store) {}

    Buckets sort(const SceneGeometry& geometry) {
        const std::vector<SceneLayout::Drawable>* of_mesh = nullptr;
        const Mesh* last = nullptr;
        for (std::uint32_t i = 0; i < geometry.items.size(); ++i) {
            const SceneGeometry::Item& item = geometry.items[i];
            if (!item.mesh) continue;
            if (std::exchange(last, item.mesh.get()) != item.mesh.get()) of_mesh = &drawables_of(item.mesh);
            for (const SceneLayout::Drawable& drawable : *of_mesh) {
                std::vector<SceneLayout::Drawable>& bucket = bucket_of(drawable, item.mirrored);
                bucket.push_back(drawable);
                bucket.back().item = i;
            }
        }
        return std::move(buckets_);
    }

 private:
    const std::vector<SceneLayout::Drawable>& drawables_of(const std::shared_ptr<const Mesh>& mesh) {
        const auto [found, is_new] = by_mesh_.try_emplace(mesh.get());
        for (std::uint32_t i = 0; is_new && i < mesh->primitives.size(); ++i) {
            const Primitive& primitive = mesh->primitives[i];
            const std::uint32_t material = store_.materials.index_of(primitive.material);
            const UploadedPrimitive& uploaded = store_.meshes.add(mesh, primitive);
            const glm::vec3 albedo = store_.materials.mean_albedo(material) * uploaded.mean_colour;
            found->second.push_back({0, &primitive, material, uploaded.bounds,
                                     std::max({albedo.r, albedo.g, albedo.b}), i, uploaded.parts});
        }
        return found->second;
    }

    std::vector<SceneLayout::Drawable>& bucket_of(const SceneLayout::Drawable& drawable, bool mirrored) {
        const std::size_t at = 2 * std::size_t{drawable.material} + (mirrored ? 1 : 0);
        if (at >= by_material_.size()) by_material_.resize(at + 1);
        if (by_material_[at] == nullptr) {
            const Material& material = *drawable.primitive->material;
            by_material_[at] = &buckets_[{drawn_alpha(material), material.double_sided, mirrored,
                                          emits(material), store_.materials.images_of(drawable.material)}];
        }
        return *by_material_[at];
    }

    SceneStore& store_;
    std::unordered_map<const Mesh*, std::vector<SceneLayout::Drawable>> by_mesh_;
    Buckets buckets_;
    std::vector<std::vector<SceneLayout::Drawable>*> by_material_;  // and whether mirrored
};

/// Appends the drawables of a bucket to the layout, with their groups.
void append(SceneLayout& layout, const DrawKey& key, const std::vector<SceneLayout::Drawable>& bucket,
            const MaterialTable& materials) {
    SceneLayout::Group group{.first_draw = static_cast<std::uint32_t>(layout.drawables.size()),
                             .draw_count = static_cast<std::uint32_t>(bucket.size()),
                             .material = materials.binding_of(bucket.front().material),
                             .mirrored = key.mirrored};
    layout.drawables.insert(layout.drawables.end(), bucket.begin(), bucket.end());
    if (key.alpha != AlphaMode::blend) {
        layout.groups.push_back(std::move(group));
        layout.solid_count = static_cast<std::uint32_t>(layout.drawables.size());
        return;
    }
    group.draw_count = 1;
    for (; group.first_draw < layout.drawables.size(); ++group.first_draw) layout.groups.push_back(group);
}

void index_by_item(SceneLayout& layout) {
    layout.first_of_item.assign(layout.geometry.items.size() + 1, 0);
    for (const SceneLayout::Drawable& drawable : layout.drawables) ++layout.first_of_item[drawable.item + 1];
    std::partial_sum(layout.first_of_item.begin(), layout.first_of_item.end(), layout.first_of_item.begin());
    layout.by_item.resize(layout.drawables.size());
    std::vector<std::uint32_t> next = layout.first_of_item;
    for (std::uint32_t i = 0; i < layout.drawables.size(); ++i) {
        layout.by_item[next[layout.drawables[i].item]++] = i;
    }
}

SceneLayout upload_scene(const Gpu& gpu, Execution& run, const SceneData& out, const SceneGeometry& geometry,
                         const Deformations& deformed, SceneStore& store) {
    store.materials.begin();
    store.meshes.begin();
    SceneLayout layout;
    layout.geometry = geometry;
    for (const auto& [key, bucket] : Sorter(store).sort(geometry)) {
        append(layout, key, bucket, store.materials);
    }
    index_by_item(layout);
    for (const SceneLayout::Drawable& drawable : layout.drawables) {
        if (geometry.items[drawable.item].deformed) store.meshes.add_deformed(drawable);
    }
    store.materials.upload(run, out.materials, out.texels);
    store.meshes.upload(gpu, run, out.vertices, out.indices, deformed);
    layout.materials = store.materials.materials();
    layout.draws = store.meshes.draws(layout.drawables);

    upload<gpu::DrawCommand>(gpu, run, out.draws, layout.draws);
    if (layout.draws.size() > store.instance_ids) {
        std::vector<std::uint32_t> instance_ids(layout.draws.size() + layout.draws.size() / 4);
        std::iota(instance_ids.begin(), instance_ids.end(), 0U);
        upload<std::uint32_t>(gpu, run, out.instance_ids, instance_ids);
        store.instance_ids = static_cast<std::uint32_t>(instance_ids.size());
    }
    return layout;
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
    return {.world = {rows[0], rows[1], rows[2]}, .material = drawable.material};
}

/// `before`: where the items were when the instances were last uploaded; null: all are uploaded.
void upload_instances(const Gpu& gpu, Execution& run, const SceneData& scene,
                      const SharedArray<glm::mat4>* before) {
    const ScenePlacement& placement = run.value(scene.placement);
    const SceneLayout& layout = run.value(scene.layout);
    if (before == nullptr) {
        std::vector<gpu::Instance> instances;
        instances.reserve(layout.drawables.size());
        for (const SceneLayout::Drawable& drawable : layout.drawables) {
            instances.push_back(instance_of(drawable, placement));
        }
        upload<gpu::Instance>(gpu, run, scene.instances, instances);
        return;
    }
    BufferWriter<gpu::Instance> writer(gpu, run.object(scene.instances));
    for (const std::uint32_t i : moved_drawables(layout, *before, placement.world)) {
        writer.seek(i);
        writer.push_back(instance_of(layout.drawables[i], placement));
    }
    writer.flush();
}

void add_instance_upload(FrameGraph& graph, const Gpu& gpu, SceneData& scene) {
    graph.add("instance-upload", [&](Pass& pass) {
        pass.read(scene.placement);
        pass.read(scene.layout);
        const auto uploaded = pass.update(graph.value<SharedArray<glm::mat4>>("uploaded places"));
        scene.instances = update_upload<gpu::Instance>(graph, pass, "instances");
        pass.run([=, &gpu](Execution& run) {
            const bool may_keep = run.has_result() && !run.changed(scene.layout);
            upload_instances(gpu, run, scene, may_keep ? run.previous(uploaded) : nullptr);
            run.set(uploaded, run.value(scene.placement).world);
        });
    });
}

/// At the places of the vertices that are drawn with them.
std::vector<glm::vec2> second_uvs_of(const SceneLayout& layout) {
    std::vector<glm::vec2> uvs(1);  // buffers must not be empty
    for (std::size_t i = 0; i < layout.drawables.size(); ++i) {
        const std::vector<glm::vec2>& added = layout.drawables[i].primitive->second_uvs;
        const auto first = static_cast<std::size_t>(layout.draws[i].base_vertex);
        if (added.empty()) continue;
        uvs.resize(std::max(uvs.size(), first + added.size()));
        std::ranges::copy(added, uvs.begin() + static_cast<std::ptrdiff_t>(first));
    }
    return uvs;
}

}  // namespace

std::span<const Vertex> vertices_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    const Deformation* const found = find_deformation(deformed, drawable.item);
    return found == nullptr ? drawable.primitive->vertices : (*found->vertices)[drawable.index_in_mesh];
}

const Box& bounds_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    const Deformation* const found = find_deformation(deformed, drawable.item);
    return found == nullptr ? drawable.bounds : found->bounds[drawable.index_in_mesh];
}

std::span<const Box> parts_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    if (drawable.parts && find_deformation(deformed, drawable.item) == nullptr) return *drawable.parts;
    return {&bounds_of(drawable, deformed), 1};
}

std::span<const SceneLayout::Group> SceneLayout::groups_of(AlphaMode alpha) const {
    const auto alpha_of = [](const Group& group) { return group.material.alpha; };
    return {std::ranges::lower_bound(groups, alpha, {}, alpha_of),
            std::ranges::upper_bound(groups, alpha, {}, alpha_of)};
}

std::vector<std::uint32_t> moved_drawables(const SceneLayout& layout, const SharedArray<glm::mat4>& before,
                                           const SharedArray<glm::mat4>& now) {
    std::vector<std::uint32_t> moved;
    visit_differences(before, now, [&](std::size_t item) {
        const std::span<const std::uint32_t> drawables = layout.drawables_of(item);
        moved.insert(moved.end(), drawables.begin(), drawables.end());
    });
    std::ranges::sort(moved);
    return moved;
}

std::vector<std::uint32_t> moved_solids(const SceneLayout& layout, const ScenePlacement& before,
                                        const ScenePlacement& now) {
    std::vector<std::uint32_t> moved = moved_drawables(layout, before.world, now.world);
    for (const auto& [item, deformation] : now.deformed) {
        const Deformation* const last = find_deformation(before.deformed, item);
        if (last != nullptr && last->vertices == deformation.vertices) continue;
        const std::span<const std::uint32_t> drawables = layout.drawables_of(item);
        moved.insert(moved.end(), drawables.begin(), drawables.end());
    }
    std::ranges::sort(moved);
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    moved.erase(std::ranges::lower_bound(moved, layout.solid_count), moved.end());
    return moved;
}

SceneData add_scene_upload(FrameGraph& graph, Gpu& gpu, bool second_uvs) {
    const Gathered gathered = add_scene_gather(graph, gpu.scene_check());
    SceneData scene = graph.add("scene-upload", [&](Pass& pass) {
        pass.keeps_state();  // where things lie in the buffers depends on what was there before
        pass.read(gathered.geometry);
        pass.read(gathered.deformed);
        // Shared, because the store is changed in place.
        const auto kept = pass.update(graph.value<std::shared_ptr<SceneStore>>("scene store"));
        const SceneData out{.placement = gathered.placement,
                            .layout = pass.write(graph.value<SceneLayout>("scene layout")),
                            .vertices = update_upload<Vertex>(graph, pass, "vertices"),
                            .indices = update_upload<std::uint32_t>(graph, pass, "indices"),
                            .instance_ids = update_upload<std::uint32_t>(graph, pass, "instance ids"),
                            .draws = write_upload<gpu::DrawCommand>(graph, pass, "draws"),
                            .materials = write_upload<gpu::Material>(graph, pass, "materials"),
                            .texels = update_upload<std::uint32_t>(graph, pass, "texels"),
                            .instances = {},
                            .second_uvs = {}};
        pass.run([=, &gpu](Execution& run) {
            const std::shared_ptr<SceneStore> store =
                run.has_result() ? *run.previous(kept) : std::make_shared<SceneStore>(gpu);
            const Deformations& deformed = run.value(gathered.deformed);
            if (run.changed(gathered.geometry)) {
                run.set(out.layout,
                        upload_scene(gpu, run, out, run.value(gathered.geometry), deformed, *store));
            } else {
                store->meshes.upload(gpu, run, out.vertices, out.indices, deformed);
            }
            run.set(kept, store);
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
