#include "renderer/passes/scene/mesh_upload.hpp"

#include <algorithm>
#include <utility>

namespace candela {
namespace {

glm::vec3 mean_colour_of(const Primitive& primitive) {
    glm::dvec3 sum(0.0);
    for (const Vertex& vertex : primitive.vertices) {
        sum += glm::dvec3(vertex.colour);
    }
    return glm::vec3(sum / (65535.0 * static_cast<double>(primitive.vertices.size())));
}

std::vector<Box> boxes_of_parts(const Primitive& primitive) {
    constexpr std::size_t part_size = 3 * triangles_per_part;
    const std::vector<std::uint32_t>& indices = primitive.indices;
    if (indices.size() <= part_size) return {};
    std::vector<Box> boxes((indices.size() + part_size - 1) / part_size);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        boxes[i / part_size].grow(primitive.vertices[indices[i]].position);
    }
    return boxes;
}

/// What a range of a buffer contains.
template <class T>
struct Piece {
    BufferRange* range;
    std::span<const T> content;
};

struct Pieces {
    std::vector<Piece<Vertex>> vertices;
    std::vector<Piece<std::uint32_t>> indices;
};

template <class T>
std::vector<BufferRange*> ranges_of(const std::vector<Piece<T>>& pieces) {
    std::vector<BufferRange*> ranges;
    ranges.reserve(pieces.size());
    for (const Piece<T>& piece : pieces) ranges.push_back(piece.range);
    return ranges;
}

/// Uploads the pieces; all that `all()` lists, if they get new places. Returns whether they do.
template <class T, class All>
bool upload_pieces(const Gpu& gpu, Execution& run, BufferHandle<T> buffer, RangePlaces& places,
                   std::vector<Piece<T>> pieces, All all) {
    const bool moved = place_ranges(run, buffer, places, ranges_of(pieces), [&] {
        pieces = all();
        return ranges_of(pieces);
    });
    upload_ranges(gpu, run, buffer, ranges_of(pieces),
                  [&](std::size_t i, BufferWriter<T>& writer) { writer.append(pieces[i].content); });
    return moved;
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

const MeshTable::Primitives& MeshTable::take(const std::shared_ptr<const Mesh>& mesh,
                                             MaterialTable& materials) {
    const std::uint32_t number =
        meshes_.take(mesh.get(), [&] { return Uploaded{.mesh = mesh, .primitives = {}}; });
    Uploaded& uploaded = meshes_[number];
    if (uploaded.ranges.size() == mesh->primitives.size()) return uploaded.primitives;
    std::uint32_t first_triangle = 0;
    for (const Primitive& primitive : mesh->primitives) {
        const std::uint32_t material = materials.take(primitive.material);
        const glm::vec3 albedo = materials.mean_albedo(material) * mean_colour_of(primitive);
        uploaded.primitives.push_back(std::make_shared<const DrawnPrimitive>(
            DrawnPrimitive{.mesh = mesh,
                           .mesh_number = number,
                           .index_in_mesh = static_cast<std::uint32_t>(uploaded.primitives.size()),
                           .first_triangle = first_triangle,
                           .material = material,
                           .bounds = box_around(primitive.vertices),
                           .albedo = std::max({albedo.r, albedo.g, albedo.b}),
                           .is_solid = drawn_alpha(*primitive.material) != AlphaMode::blend,
                           .parts = boxes_of_parts(primitive)}));
        first_triangle += static_cast<std::uint32_t>(primitive.indices.size() / 3);
        uploaded.ranges.push_back(
            {.vertices = {.count = static_cast<std::uint32_t>(primitive.vertices.size())},
             .indices = {.count = static_cast<std::uint32_t>(primitive.indices.size())}});
    }
    return uploaded.primitives;
}

void MeshTable::drop_unused(MaterialTable& materials) {
    meshes_.drop_unused([&](std::uint32_t number) {
        Uploaded& uploaded = meshes_[number];
        for (const auto& drawn : uploaded.primitives) materials.release(*drawn->primitive().material);
        for (Ranges& ranges : uploaded.ranges) {
            vertex_places_.take_back(ranges.vertices);
            index_places_.take_back(ranges.indices);
        }
    });
}

void MeshTable::add_deformed(std::uint32_t drawable, const DrawnPrimitive& drawn) {
    const auto count = static_cast<std::uint32_t>(drawn.primitive().vertices.size());
    deformed_[drawable] = {.vertices = nullptr, .range = {.count = count}};
}

void MeshTable::remove_deformed(std::uint32_t drawable) {
    const auto found = deformed_.find(drawable);
    if (found == deformed_.end()) return;
    vertex_places_.take_back(found->second.range);
    deformed_.erase(found);
}

bool MeshTable::upload(const Gpu& gpu, Execution& run, BufferHandle<Vertex> vertices,
                       BufferHandle<std::uint32_t> indices, const SceneLayout& layout,
                       const Deformations& deformations) {
    const auto add_mesh = [](Pieces& pieces, Uploaded& uploaded) {
        for (std::size_t i = 0; i < uploaded.ranges.size(); ++i) {
            const Primitive& primitive = uploaded.mesh->primitives[i];
            pieces.vertices.push_back({&uploaded.ranges[i].vertices, primitive.vertices});
            pieces.indices.push_back({&uploaded.ranges[i].indices, primitive.indices});
        }
    };
    const auto add_deformed = [&](Pieces& pieces, std::uint32_t number, Deformed& deformed) {
        pieces.vertices.push_back({&deformed.range, vertices_of(layout.drawables[number], deformations)});
    };
    Pieces changed;
    for (const std::uint32_t number : meshes_.take_added()) add_mesh(changed, meshes_[number]);
    for (auto& [number, deformed] : deformed_) {
        const auto& now = deformations.at(layout.drawables[number].item).vertices;
        if (std::exchange(deformed.vertices, now) == now) continue;
        deformed.range.uploaded = false;
        add_deformed(changed, number, deformed);
    }
    const auto all = [&] {
        Pieces pieces;
        meshes_.visit([&](Uploaded& uploaded) { add_mesh(pieces, uploaded); });
        for (auto& [number, deformed] : deformed_) add_deformed(pieces, number, deformed);
        return pieces;
    };
    const bool moved_vertices = upload_pieces(gpu, run, vertices, vertex_places_, std::move(changed.vertices),
                                              [&] { return all().vertices; });
    const bool moved_indices = upload_pieces(gpu, run, indices, index_places_, std::move(changed.indices),
                                             [&] { return all().indices; });
    return moved_vertices || moved_indices;
}

gpu::DrawCommand MeshTable::draw(std::uint32_t number, const DrawnPrimitive& drawn) const {
    const Ranges& ranges = meshes_[drawn.mesh_number].ranges[drawn.index_in_mesh];
    const auto deformed = deformed_.find(number);
    const BufferRange& vertices = deformed == deformed_.end() ? ranges.vertices : deformed->second.range;
    return {.index_count = ranges.indices.count,
            .instance_count = 1,
            .first_index = ranges.indices.first,
            .base_vertex = static_cast<std::int32_t>(vertices.first),
            .base_instance = number};
}

}  // namespace candela
