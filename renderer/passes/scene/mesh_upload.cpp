#include "renderer/passes/scene/mesh_upload.hpp"

#include <utility>
#include <vector>

namespace candela {
namespace {

glm::vec3 mean_colour_of(const Primitive& primitive) {
    glm::dvec3 sum(0.0);
    for (const Vertex& vertex : primitive.vertices) {
        sum += glm::dvec3(vertex.colour);
    }
    return glm::vec3(sum / (65535.0 * static_cast<double>(primitive.vertices.size())));
}

std::shared_ptr<const std::vector<Box>> boxes_of_parts(const Primitive& primitive) {
    constexpr std::size_t part_size = 3 * triangles_per_part;
    const std::vector<std::uint32_t>& indices = primitive.indices;
    if (indices.size() <= part_size) return nullptr;
    std::vector<Box> boxes((indices.size() + part_size - 1) / part_size);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        boxes[i / part_size].grow(primitive.vertices[indices[i]].position);
    }
    return std::make_shared<const std::vector<Box>>(std::move(boxes));
}

}  // namespace

Box box_around(std::span<const Vertex> vertices) {
    if (vertices.empty()) return {glm::vec3(0.0F), glm::vec3(0.0F)};
    Box box;
    for (const Vertex& vertex : vertices) {
        box.grow(vertex.position);
    }
    return box;
}

void MeshTable::begin() {
    primitives_.begin();
    deformed_.clear();
}

const UploadedPrimitive& MeshTable::add(const std::shared_ptr<const Mesh>& mesh, const Primitive& primitive) {
    return primitives_[primitives_.use(&primitive, [&] {
        return UploadedPrimitive{.mesh = mesh,
                                 .primitive = &primitive,
                                 .bounds = box_around(primitive.vertices),
                                 .parts = boxes_of_parts(primitive),
                                 .mean_colour = mean_colour_of(primitive),
                                 .vertices = {.count = static_cast<std::uint32_t>(primitive.vertices.size())},
                                 .indices = {.count = static_cast<std::uint32_t>(primitive.indices.size())}};
    })];
}

void MeshTable::add_deformed(const SceneLayout::Drawable& drawable) {
    const auto count = static_cast<std::uint32_t>(drawable.primitive->vertices.size());
    deformed_.push_back({.drawable = drawable, .vertices = nullptr, .range = {.count = count}});
}

void MeshTable::upload(const Gpu& gpu, Execution& run, BufferHandle<Vertex> vertices,
                       BufferHandle<std::uint32_t> indices, const Deformations& deformations) {
    primitives_.drop_unused();
    std::vector<BufferRange*> vertex_ranges;
    std::vector<BufferRange*> index_ranges;
    std::vector<std::span<const Vertex>> contents;
    for (UploadedPrimitive* each : primitives_.used()) {
        vertex_ranges.push_back(&each->vertices);
        index_ranges.push_back(&each->indices);
        contents.emplace_back(each->primitive->vertices);
    }
    for (Deformed& each : deformed_) {
        const auto& now = deformations.at(each.drawable.item).vertices;
        each.range.uploaded &= each.vertices == now;
        each.vertices = now;
        vertex_ranges.push_back(&each.range);
        contents.push_back(vertices_of(each.drawable, deformations));
    }

    place_ranges(run, vertices, vertex_ranges, vertices_end_);
    upload_ranges(gpu, run, vertices, vertex_ranges,
                  [&](std::size_t i, BufferWriter<Vertex>& writer) { writer.append(contents[i]); });
    place_ranges(run, indices, index_ranges, indices_end_);
    upload_ranges(gpu, run, indices, index_ranges, [&](std::size_t i, BufferWriter<std::uint32_t>& writer) {
        writer.append(primitives_.used()[i]->primitive->indices);
    });
}

std::vector<gpu::DrawCommand> MeshTable::draws(std::span<const SceneLayout::Drawable> drawables) {
    std::vector<gpu::DrawCommand> draws;
    draws.reserve(drawables.size());
    auto deformed = deformed_.begin();
    const UploadedPrimitive* uploaded = nullptr;  // of the last drawable: many have the same one
    for (const SceneLayout::Drawable& drawable : drawables) {
        if (uploaded == nullptr || uploaded->primitive != drawable.primitive) {
            uploaded = primitives_.find(drawable.primitive);
        }
        const UploadedPrimitive& primitive = *uploaded;
        std::uint32_t first_vertex = primitive.vertices.first;
        if (deformed != deformed_.end() && deformed->drawable.item == drawable.item &&
            deformed->drawable.primitive == drawable.primitive) {
            first_vertex = deformed->range.first;
            ++deformed;
        }
        draws.push_back({.index_count = primitive.indices.count,
                         .instance_count = 1,
                         .first_index = primitive.indices.first,
                         .base_vertex = static_cast<std::int32_t>(first_vertex),
                         .base_instance = static_cast<std::uint32_t>(draws.size())});
    }
    return draws;
}

}  // namespace candela
