#include "renderer/passes/scene/mesh_upload.hpp"

#include <vector>

namespace candela {
namespace {

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

glm::vec3 mean_colour_of(const Primitive& primitive) {
    glm::dvec3 sum(0.0);
    for (const Vertex& vertex : primitive.vertices) {
        sum += glm::dvec3(vertex.colour);
    }
    return glm::vec3(sum / (65535.0 * static_cast<double>(primitive.vertices.size())));
}

/// Keeps one kind of elements of the primitives, such as their vertices, in a buffer.
template <class T>
void keep(const Gpu& gpu, Execution& run, BufferHandle<T> buffer,
          const std::vector<UploadedPrimitive*>& primitives, BufferRange UploadedPrimitive::*range,
          const std::vector<T> Primitive::*content, std::uint32_t& end) {
    std::vector<BufferRange*> ranges;
    for (UploadedPrimitive* each : primitives) {
        ranges.push_back(&(each->*range));
    }
    place_ranges(run, buffer, ranges, end);
    upload_ranges(gpu, run, buffer, ranges, [&](std::size_t i, std::vector<T>& elements) {
        const std::vector<T>& added = primitives[i]->primitive->*content;
        elements.insert(elements.end(), added.begin(), added.end());
    });
}

}  // namespace

std::uint32_t MeshTable::add(const std::shared_ptr<const Mesh>& mesh, const Primitive& primitive) {
    return primitives_.use(&primitive, [&] {
        return UploadedPrimitive{.mesh = mesh,
                                 .primitive = &primitive,
                                 .bounds = bounds_of(primitive),
                                 .mean_colour = mean_colour_of(primitive),
                                 .vertices = {.count = static_cast<std::uint32_t>(primitive.vertices.size())},
                                 .indices = {.count = static_cast<std::uint32_t>(primitive.indices.size())}};
    });
}

void MeshTable::upload(const Gpu& gpu, Execution& run, BufferHandle<Vertex> vertices,
                       BufferHandle<std::uint32_t> indices) {
    primitives_.drop_unused();
    keep(gpu, run, vertices, primitives_.used(), &UploadedPrimitive::vertices, &Primitive::vertices,
         vertices_end_);
    keep(gpu, run, indices, primitives_.used(), &UploadedPrimitive::indices, &Primitive::indices,
         indices_end_);
}

gpu::DrawCommand MeshTable::draw(std::uint32_t number, std::uint32_t instance) const {
    const UploadedPrimitive& primitive = primitives_[number];
    return {.index_count = primitive.indices.count,
            .instance_count = 1,
            .first_index = primitive.indices.first,
            .base_vertex = static_cast<std::int32_t>(primitive.vertices.first),
            .base_instance = instance};
}

}  // namespace candela
