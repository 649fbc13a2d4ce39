#include "renderer/passes/scene/scene_upload.hpp"

#include <algorithm>
#include <glm/matrix.hpp>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include <candela/graph/execute.hpp>
#include <candela/scene/hierarchy.hpp>
#include "renderer/passes/scene/material_upload.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

struct Gathered {
    ValueHandle<SceneGeometry> geometry;
    ValueHandle<ScenePlacement> placement;
};

Gathered add_scene_gather(FrameGraph& graph, SceneCheck& check) {
    return graph.add("scene-gather", [&](Pass& pass) {
        pass.read<MeshInstance>();
        pass.read<Transform>();
        const Gathered out{pass.write(graph.value<SceneGeometry>("scene geometry")),
                           pass.write(graph.value<ScenePlacement>("scene placement"))};
        pass.run([=, &check](Execution& run) {
            SceneGeometry geometry;
            ScenePlacement placement;
            for (const auto& [entity, instance] : run.world().view<MeshInstance>()) {
                const glm::mat4 world = world_matrix(run.world(), entity);
                if (!check.accepts(run.world(), entity, instance) ||
                    !check.accepts_at(run.world(), entity, world)) {
                    continue;
                }
                geometry.items.push_back({instance.mesh, glm::determinant(glm::mat3(world)) < 0.0F});
                placement.world.push_back(world);
            }
            run.set(out.geometry, std::move(geometry));
            run.set(out.placement, std::move(placement));
        });
        return out;
    });
}

Box bounds_of(const Primitive& primitive) {
    if (primitive.vertices.empty()) {
        return {glm::vec3(0.0F), glm::vec3(0.0F)};
    }
    Box bounds;
    for (const Vertex& vertex : primitive.vertices) {
        bounds.grow(vertex.position);
    }
    return bounds;
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

/// The content of the vertex, index and draw buffers.
struct PackedMeshes {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<gpu::DrawCommand> draws;
};

glm::vec3 mean_colour(const Primitive& primitive) {
    glm::dvec3 sum(0.0);
    for (const Vertex& vertex : primitive.vertices) {
        sum += glm::dvec3(vertex.colour);
    }
    return glm::vec3(sum / (65535.0 * static_cast<double>(primitive.vertices.size())));
}

std::vector<SceneLayout::Drawable> list_drawables(const SceneGeometry& geometry, MaterialTable& materials) {
    std::vector<SceneLayout::Drawable> drawables;
    for (std::uint32_t item = 0; item < geometry.items.size(); ++item) {
        for (const Primitive& primitive : geometry.items[item].mesh->primitives) {
            const std::uint32_t material = materials.index_of(primitive.material);
            const glm::vec3 albedo = materials.mean_albedo(material) * mean_colour(primitive);
            drawables.push_back(
                {item, &primitive, material, bounds_of(primitive), std::max({albedo.r, albedo.g, albedo.b})});
        }
    }
    const auto key = [&](std::uint32_t i) {
        const SceneLayout::Drawable& drawable = drawables[i];
        const Material& material = *drawable.primitive->material;
        const MaterialImages& images = materials.images_of(drawable.material);
        return std::tuple(material.alpha_mode, images.base_colour, material.double_sided,
                          geometry.items[drawable.item].mirrored, emits(material), images.emissive);
    };
    std::vector<SceneLayout::Drawable> ordered;
    for (const std::uint32_t i : stable_order(drawables.size(), key)) {
        ordered.push_back(drawables[i]);
    }
    return ordered;
}

PackedMeshes pack_meshes(const std::vector<SceneLayout::Drawable>& drawables) {
    PackedMeshes packed;
    std::unordered_map<const Primitive*, gpu::DrawCommand> known;
    for (const SceneLayout::Drawable& drawable : drawables) {
        const Primitive& primitive = *drawable.primitive;
        auto [found, is_new] = known.try_emplace(&primitive);
        if (is_new) {
            found->second = {.index_count = static_cast<std::uint32_t>(primitive.indices.size()),
                             .instance_count = 1,
                             .first_index = static_cast<std::uint32_t>(packed.indices.size()),
                             .base_vertex = static_cast<std::int32_t>(packed.vertices.size()),
                             .base_instance = 0};
            packed.vertices.insert(packed.vertices.end(), primitive.vertices.begin(),
                                   primitive.vertices.end());
            packed.indices.insert(packed.indices.end(), primitive.indices.begin(), primitive.indices.end());
        }
        gpu::DrawCommand draw = found->second;
        draw.base_instance = static_cast<std::uint32_t>(packed.draws.size());
        packed.draws.push_back(draw);
    }
    return packed;
}

bool can_share(const SceneLayout::Group& a, const SceneLayout::Group& b) {
    return a.alpha != AlphaMode::blend && a.alpha == b.alpha && a.texture == b.texture &&
           a.emission == b.emission && a.double_sided == b.double_sided && a.mirrored == b.mirrored &&
           a.emits == b.emits;
}

/// Number of drawables whose alpha mode is at most `last`, in the order of the enum.
std::uint32_t count_until(const std::vector<SceneLayout::Drawable>& drawables, AlphaMode last) {
    return static_cast<std::uint32_t>(std::ranges::count_if(
        drawables, [&](const auto& drawable) { return drawable.primitive->material->alpha_mode <= last; }));
}

std::vector<SceneLayout::Group> group_draws(const SceneGeometry& geometry,
                                            const std::vector<SceneLayout::Drawable>& drawables,
                                            const MaterialTable& materials) {
    std::vector<SceneLayout::Group> groups;
    for (std::uint32_t draw = 0; draw < drawables.size(); ++draw) {
        const SceneLayout::Drawable& drawable = drawables[draw];
        const Material& material = *drawable.primitive->material;
        const MaterialImages& images = materials.images_of(drawable.material);
        SceneLayout::Group group{.first_draw = draw,
                                 .draw_count = 1,
                                 .alpha = material.alpha_mode,
                                 .texture = materials.texture(images.base_colour),
                                 .emission = materials.texture(images.emissive),
                                 .double_sided = material.double_sided,
                                 .mirrored = geometry.items[drawable.item].mirrored,
                                 .emits = emits(material)};
        if (group.alpha == AlphaMode::blend) {
            group.centre = (drawable.bounds.lower + drawable.bounds.upper) * 0.5F;
        }
        if (!groups.empty() && can_share(groups.back(), group)) {
            ++groups.back().draw_count;
        } else {
            groups.push_back(std::move(group));
        }
    }
    return groups;
}

void upload_scene(Gpu& gpu, Execution& run, const SceneData& out, const SceneGeometry& geometry) {
    MaterialTable materials(gpu);
    SceneLayout layout;
    layout.geometry = geometry;
    layout.drawables = list_drawables(geometry, materials);
    layout.groups = group_draws(geometry, layout.drawables, materials);
    layout.materials = materials.materials();
    layout.opaque_count = count_until(layout.drawables, AlphaMode::opaque);
    layout.solid_count = count_until(layout.drawables, AlphaMode::mask);

    PackedMeshes meshes = pack_meshes(layout.drawables);
    std::vector<std::uint32_t> instance_ids(meshes.draws.size());
    std::iota(instance_ids.begin(), instance_ids.end(), 0U);
    upload<Vertex>(gpu, run, out.vertices, meshes.vertices);
    upload<std::uint32_t>(gpu, run, out.indices, meshes.indices);
    upload<gpu::DrawCommand>(gpu, run, out.draws, meshes.draws);
    upload<std::uint32_t>(gpu, run, out.instance_ids, instance_ids);
    upload<gpu::Material>(gpu, run, out.materials, materials.records());
    upload<std::uint32_t>(gpu, run, out.texels, materials.texels());
    layout.draws = std::move(meshes.draws);
    run.set(out.layout, std::move(layout));
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

template <class T>
BufferHandle<T> write_upload(FrameGraph& graph, Pass& pass, std::string_view name) {
    return pass.write(graph.buffer<T>(name, 1, Lifetime::persistent), Usage::copy);
}

}  // namespace

std::span<const SceneLayout::Group> SceneLayout::groups_of(AlphaMode alpha) const {
    const auto first = std::ranges::lower_bound(groups, alpha, {}, &Group::alpha);
    const auto last = std::ranges::upper_bound(groups, alpha, {}, &Group::alpha);
    return {first, last};
}

SceneData add_scene_upload(FrameGraph& graph, Gpu& gpu) {
    const Gathered gathered = add_scene_gather(graph, gpu.scene_check());
    SceneData scene = graph.add("scene-upload", [&](Pass& pass) {
        pass.read(gathered.geometry);
        const SceneData out{.placement = gathered.placement,
                            .layout = pass.write(graph.value<SceneLayout>("scene layout")),
                            .vertices = write_upload<Vertex>(graph, pass, "vertices"),
                            .indices = write_upload<std::uint32_t>(graph, pass, "indices"),
                            .instance_ids = write_upload<std::uint32_t>(graph, pass, "instance ids"),
                            .draws = write_upload<gpu::DrawCommand>(graph, pass, "draws"),
                            .materials = write_upload<gpu::Material>(graph, pass, "materials"),
                            .texels = write_upload<std::uint32_t>(graph, pass, "texels"),
                            .instances = {}};
        pass.run([=, &gpu](Execution& run) { upload_scene(gpu, run, out, run.value(gathered.geometry)); });
        return out;
    });
    graph.add("instance-upload", [&](Pass& pass) {
        pass.read(scene.placement);
        pass.read(scene.layout);
        scene.instances = write_upload<gpu::Instance>(graph, pass, "instances");
        pass.run([=, &gpu](Execution& run) { upload_instances(gpu, run, scene); });
    });
    return scene;
}

}  // namespace candela
