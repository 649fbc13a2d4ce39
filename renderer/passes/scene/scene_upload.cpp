#include "renderer/passes/scene/scene_upload.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <glm/matrix.hpp>
#include <memory>
#include <numeric>
#include <tuple>

#include <candela/graph/execute.hpp>
#include <candela/scene/hierarchy.hpp>
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

const Deformation* find(const Deformations& deformed, std::uint32_t item) {
    const auto found = deformed.find(item);
    return found == deformed.end() ? nullptr : &found->second;
}

/// The item's deformation; `last` is its last one, or null.
Deformation deformation_of(const DeformedMesh& deformed, const Deformation* last) {
    if (last != nullptr && last->vertices == deformed.vertices) return *last;
    Deformation deformation{deformed.vertices, {}};
    for (const std::vector<Vertex>& vertices : *deformed.vertices) {
        deformation.bounds.push_back(box_around(vertices));
    }
    return deformation;
}

Gathered add_scene_gather(FrameGraph& graph, SceneCheck& check) {
    return graph.add("scene-gather", [&](Pass& pass) {
        pass.read<MeshInstance>();
        pass.read<DeformedMesh>();
        pass.read<Transform>();
        const Gathered out{pass.write(graph.value<SceneGeometry>("scene geometry")),
                           pass.update(graph.value<ScenePlacement>("scene placement")),
                           pass.write(graph.value<Deformations>("deformations"))};
        pass.run([=, &check](Execution& run) {
            const ScenePlacement* const last = run.previous(out.placement);
            SceneGeometry geometry;
            ScenePlacement placement;
            WorldMatrices world_matrices(run.world());
            for (const auto& [entity, instance] : run.world().view<MeshInstance>()) {
                const auto item = static_cast<std::uint32_t>(geometry.items.size());
                const glm::mat4 world = world_matrices(entity);
                if (!check.accepts(run.world(), entity, instance) ||
                    !check.accepts_at(run.world(), entity, instance, world)) {
                    continue;
                }
                const auto* const deformed = run.world().find<DeformedMesh>(entity);
                if (deformed != nullptr) {
                    const Deformation* const before = last == nullptr ? nullptr : find(last->deformed, item);
                    placement.deformed.emplace(item, deformation_of(*deformed, before));
                }
                geometry.items.push_back(
                    {entity, instance.mesh, glm::determinant(glm::mat3(world)) < 0.0F, deformed != nullptr});
                placement.world.push_back(world);
            }
            run.set(out.deformed, placement.deformed);
            run.set(out.geometry, std::move(geometry));
            run.set(out.placement, std::move(placement));
        });
        return out;
    });
}

/// Indices 0 .. count - 1, sorted by `key`; equal keys keep their order.
template <class Key>
std::vector<std::uint32_t> stable_order(std::size_t count, Key key) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    return order;
}

/// What is on the GPU of the scene's meshes and materials. It stays there while the world keeps it.
struct SceneStore {
    explicit SceneStore(Gpu& gpu) : materials(gpu) {}
    MaterialTable materials;
    MeshTable meshes;
};

/// The drawables of the scene, which become its materials and meshes.
std::vector<SceneLayout::Drawable> list_drawables(const SceneGeometry& geometry, SceneStore& store) {
    std::vector<SceneLayout::Drawable> drawables;
    for (std::uint32_t item = 0; item < geometry.items.size(); ++item) {
        const std::shared_ptr<const Mesh>& mesh = geometry.items[item].mesh;
        for (std::uint32_t i = 0; i < mesh->primitives.size(); ++i) {
            const Primitive& primitive = mesh->primitives[i];
            const std::uint32_t material = store.materials.index_of(primitive.material);
            const UploadedPrimitive& uploaded = store.meshes.add(mesh, primitive);
            const glm::vec3 albedo = store.materials.mean_albedo(material) * uploaded.mean_colour;
            drawables.push_back({item, &primitive, material, uploaded.bounds,
                                 std::max({albedo.r, albedo.g, albedo.b}), i, uploaded.parts});
        }
    }
    const auto key = [&](std::uint32_t i) {
        const SceneLayout::Drawable& drawable = drawables[i];
        const Material& material = *drawable.primitive->material;
        const MaterialImages& images = store.materials.images_of(drawable.material);
        return std::tuple(drawn_alpha(material), images[base_colour_slot], material.double_sided,
                          geometry.items[drawable.item].mirrored, emits(material), images);
    };
    std::vector<SceneLayout::Drawable> ordered;
    for (const std::uint32_t i : stable_order(drawables.size(), key)) {
        ordered.push_back(drawables[i]);
    }
    return ordered;
}

bool can_share(const SceneLayout::Group& a, const SceneLayout::Group& b) {
    return a.material.alpha != AlphaMode::blend && a.material == b.material && a.mirrored == b.mirrored;
}

std::uint32_t count_solids(const std::vector<SceneLayout::Drawable>& drawables) {
    return static_cast<std::uint32_t>(std::ranges::count_if(
        drawables, [](const auto& drawable) { return !is_seen_through(*drawable.primitive->material); }));
}

std::vector<SceneLayout::Group> group_draws(const SceneGeometry& geometry,
                                            const std::vector<SceneLayout::Drawable>& drawables,
                                            const MaterialTable& materials) {
    std::vector<SceneLayout::Group> groups;
    for (std::uint32_t draw = 0; draw < drawables.size(); ++draw) {
        const SceneLayout::Drawable& drawable = drawables[draw];
        SceneLayout::Group group{.first_draw = draw,
                                 .draw_count = 1,
                                 .material = materials.binding_of(drawable.material),
                                 .mirrored = geometry.items[drawable.item].mirrored};
        if (!groups.empty() && can_share(groups.back(), group)) {
            ++groups.back().draw_count;
        } else {
            groups.push_back(std::move(group));
        }
    }
    return groups;
}

SceneLayout upload_scene(const Gpu& gpu, Execution& run, const SceneData& out, const SceneGeometry& geometry,
                         const Deformations& deformed, SceneStore& store) {
    store.materials.begin();
    store.meshes.begin();
    SceneLayout layout;
    layout.geometry = geometry;
    layout.drawables = list_drawables(geometry, store);
    layout.groups = group_draws(geometry, layout.drawables, store.materials);
    layout.solid_count = count_solids(layout.drawables);
    for (const SceneLayout::Drawable& drawable : layout.drawables) {
        if (geometry.items[drawable.item].deformed) store.meshes.add_deformed(drawable);
    }
    store.materials.upload(run, out.materials, out.texels);
    store.meshes.upload(gpu, run, out.vertices, out.indices, deformed);
    layout.materials = store.materials.materials();
    layout.draws = store.meshes.draws(layout.drawables);

    std::vector<std::uint32_t> instance_ids(layout.draws.size());
    std::iota(instance_ids.begin(), instance_ids.end(), 0U);
    upload<gpu::DrawCommand>(gpu, run, out.draws, layout.draws);
    upload<std::uint32_t>(gpu, run, out.instance_ids, instance_ids);
    return layout;
}

void upload_instances(const Gpu& gpu, Execution& run, const SceneData& scene) {
    const ScenePlacement& placement = run.value(scene.placement);
    std::vector<gpu::Instance> instances;
    for (const SceneLayout::Drawable& drawable : run.value(scene.layout).drawables) {
        const glm::mat4 rows = glm::transpose(placement.world[drawable.item]);
        instances.push_back({.world = {rows[0], rows[1], rows[2]}, .material = drawable.material});
    }
    upload<gpu::Instance>(gpu, run, scene.instances, instances);
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

template <class T>
BufferHandle<T> write_upload(FrameGraph& graph, Pass& pass, std::string_view name) {
    return pass.write(growing_buffer<T>(graph, name), Usage::copy);
}

/// The same for a buffer whose content stays between frames.
template <class T>
BufferHandle<T> update_upload(FrameGraph& graph, Pass& pass, std::string_view name) {
    return pass.update(growing_buffer<T>(graph, name), Usage::copy);
}

}  // namespace

std::span<const Vertex> vertices_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    const Deformation* const found = find(deformed, drawable.item);
    return found == nullptr ? drawable.primitive->vertices : (*found->vertices)[drawable.index_in_mesh];
}

const Box& bounds_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    const Deformation* const found = find(deformed, drawable.item);
    return found == nullptr ? drawable.bounds : found->bounds[drawable.index_in_mesh];
}

std::span<const Box> parts_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    if (drawable.parts && find(deformed, drawable.item) == nullptr) return *drawable.parts;
    return {&bounds_of(drawable, deformed), 1};
}

std::span<const SceneLayout::Group> SceneLayout::groups_of(AlphaMode alpha) const {
    const auto alpha_of = [](const Group& group) { return group.material.alpha; };
    return {std::ranges::lower_bound(groups, alpha, {}, alpha_of),
            std::ranges::upper_bound(groups, alpha, {}, alpha_of)};
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
                            .instance_ids = write_upload<std::uint32_t>(graph, pass, "instance ids"),
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
    graph.add("instance-upload", [&](Pass& pass) {
        pass.read(scene.placement);
        pass.read(scene.layout);
        scene.instances = write_upload<gpu::Instance>(graph, pass, "instances");
        pass.run([=, &gpu](Execution& run) { upload_instances(gpu, run, scene); });
    });
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
