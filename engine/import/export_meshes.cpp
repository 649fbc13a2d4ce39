#include "engine/import/export_meshes.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/import/gltf_constants.hpp"
#include "engine/import/naming.hpp"
#include "engine/import/unit_length.hpp"
#include "engine/readable.hpp"
#include "engine/scene/check.hpp"

namespace candela::gltf {

namespace {

// Vertices are written as memory holds them, interleaved, so that every bit is kept.
static_assert(offsetof(Vertex, normal) == 12 && offsetof(Vertex, uv) == 24 && offsetof(Vertex, colour) == 32);
static_assert(sizeof(Vertex) == 48);

struct Attribute {
    const char* name;
    std::size_t offset;
    int component_type;
    const char* type;
};

constexpr Attribute position{"POSITION", offsetof(Vertex, position), floating_point, "VEC3"};
constexpr Attribute normal{"NORMAL", offsetof(Vertex, normal), floating_point, "VEC3"};
constexpr Attribute uv{"TEXCOORD_0", offsetof(Vertex, uv), floating_point, "VEC2"};
constexpr Attribute colour{"COLOR_0", offsetof(Vertex, colour), unsigned_short, "VEC4"};

/// glTF requires the bounds of positions.
void add_bounds(Json& accessor, const std::vector<Vertex>& vertices) {
    glm::vec3 lower(std::numeric_limits<float>::infinity());
    glm::vec3 upper = -lower;
    for (const Vertex& vertex : vertices) {
        lower = glm::min(lower, vertex.position);
        upper = glm::max(upper, vertex.position);
    }
    accessor["min"] = to_json(lower);
    accessor["max"] = to_json(upper);
}

bool has_colours(const std::vector<Vertex>& vertices) {
    return std::ranges::any_of(vertices,
                               [](const Vertex& vertex) { return vertex.colour != glm::u16vec4(65535); });
}

/// The accessors of the attributes.
Json add_vertices(const std::vector<Vertex>& vertices, Draft& draft) {
    const std::size_t view = draft.add_view(std::as_bytes(std::span(vertices)),
                                            {{"byteStride", sizeof(Vertex)}, {"target", vertices_target}});
    Json attributes;
    const auto add = [&](const Attribute& attribute, Json accessor) {
        accessor.update({{"bufferView", view},
                         {"byteOffset", attribute.offset},
                         {"componentType", attribute.component_type},
                         {"type", attribute.type},
                         {"count", vertices.size()}});
        attributes[attribute.name] = draft.add("accessors", std::move(accessor));
    };
    Json bounds;
    add_bounds(bounds, vertices);
    add(position, std::move(bounds));
    add(normal, Json::object());
    add(uv, Json::object());
    if (has_colours(vertices)) add(colour, {{"normalized", true}});
    return attributes;
}

std::size_t add_indices(const std::vector<std::uint32_t>& indices, Draft& draft) {
    const std::size_t view = draft.add_view(std::as_bytes(std::span(indices)), {{"target", indices_target}});
    return draft.add("accessors", {{"bufferView", view},
                                   {"componentType", unsigned_int},
                                   {"type", "SCALAR"},
                                   {"count", indices.size()}});
}

bool has_unit_normals(const Mesh& mesh) {
    const auto is_unit = [](const Vertex& vertex) {
        return is_unit_length(glm::length(glm::dvec3(vertex.normal)));
    };
    return std::ranges::all_of(mesh.primitives, [&](const Primitive& primitive) {
        return std::ranges::all_of(primitive.vertices, is_unit);
    });
}

}  // namespace

std::optional<std::size_t> MeshWriter::index_of(const std::shared_ptr<const Mesh>& mesh) {
    const auto found = meshes_.find(mesh);
    return found != meshes_.end() ? found->second : meshes_.emplace(mesh, add(*mesh)).first->second;
}

std::optional<std::size_t> MeshWriter::add(const Mesh& mesh) {
    check(fault_of(mesh, Strictness::usual));
    if (!has_unit_normals(mesh)) {
        draft_.warnings.push_back(fmt::format(
            "mesh \"{}\": normals that are not of unit length will be normalised", readable(mesh.name)));
    }
    Json primitives;
    for (const Primitive& primitive : mesh.primitives) {
        if (!primitive.indices.empty()) primitives.push_back(describe(primitive));
    }
    if (primitives.empty()) return std::nullopt;
    Json json = {{"primitives", std::move(primitives)}};
    if (!mesh.name.empty()) json["name"] = to_json(mesh.name);
    return draft_.add("meshes", std::move(json));
}

Json MeshWriter::describe(const Primitive& primitive) {
    return {{"attributes", add_vertices(primitive.vertices, draft_)},
            {"indices", add_indices(primitive.indices, draft_)},
            {"material", materials_.index_of(primitive.material)}};
}

}  // namespace candela::gltf
