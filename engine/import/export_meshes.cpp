#include "engine/import/export_meshes.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <candela/scene/tangents.hpp>
#include "engine/import/export_motion.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/naming.hpp"
#include "engine/import/unit_length.hpp"
#include "engine/readable.hpp"
#include "engine/scene/check.hpp"

namespace candela::gltf {

namespace {

// All but the tangents of vertices, which glTF has as floats, is written as memory holds it, interleaved, so
// that every bit is kept.
static_assert(offsetof(Vertex, normal) == 12 && offsetof(Vertex, uv) == 24 && offsetof(Vertex, colour) == 32);
static_assert(offsetof(Vertex, tangent) == 40);
constexpr std::size_t before_tangent = offsetof(Vertex, tangent);

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
constexpr Attribute tangent{"TANGENT", before_tangent, floating_point, "VEC4"};

bool has_colours(const std::vector<Vertex>& vertices) {
    return std::ranges::any_of(vertices,
                               [](const Vertex& vertex) { return vertex.colour != glm::u16vec4(65535); });
}

bool has_tangents(const std::vector<Vertex>& vertices) {
    return std::ranges::any_of(vertices,
                               [](const Vertex& vertex) { return vertex.tangent != glm::i16vec4(0); });
}

/// The bytes of the vertices, each followed by its tangent if these are wanted.
std::vector<std::byte> interleaved(const std::vector<Vertex>& vertices, bool with_tangents) {
    std::vector<std::byte> bytes;
    const auto append = [&](std::span<const std::byte> more) {
        bytes.insert(bytes.end(), more.begin(), more.end());
    };
    for (const Vertex& vertex : vertices) {
        append(std::as_bytes(std::span(&vertex, 1)).first(before_tangent));
        const glm::vec4 along = unpacked_tangent(vertex.tangent);
        if (with_tangents) append(std::as_bytes(std::span(&along, 1)));
    }
    return bytes;
}

/// The accessors of the attributes.
Json add_vertices(const std::vector<Vertex>& vertices, Draft& draft) {
    const bool with_tangents = has_tangents(vertices);
    const std::size_t stride = before_tangent + (with_tangents ? sizeof(glm::vec4) : 0);
    const std::size_t view = draft.add_view(interleaved(vertices, with_tangents),
                                            {{"byteStride", stride}, {"target", vertices_target}});
    Json attributes;
    const auto add = [&](const Attribute& attribute, Json members = Json::object()) {
        members["byteOffset"] = attribute.offset;
        attributes[attribute.name] = draft.add_accessor(view, attribute.component_type, attribute.type,
                                                        vertices.size(), std::move(members));
    };
    std::vector<glm::vec3> positions(vertices.size());
    std::ranges::transform(vertices, positions.begin(), &Vertex::position);
    add(position, bounds_of(positions));
    add(normal);
    add(uv);
    if (has_colours(vertices)) add(colour, {{"normalized", true}});
    if (with_tangents) add(tangent);
    return attributes;
}

std::size_t add_second_uvs(const std::vector<glm::vec2>& uvs, Draft& draft) {
    const std::size_t view = draft.add_view(std::as_bytes(std::span(uvs)), {{"target", vertices_target}});
    return draft.add_accessor(view, floating_point, "VEC2", uvs.size());
}

std::size_t add_indices(const std::vector<std::uint32_t>& indices, Draft& draft) {
    const std::size_t view = draft.add_view(std::as_bytes(std::span(indices)), {{"target", indices_target}});
    return draft.add_accessor(view, unsigned_int, "SCALAR", indices.size());
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
    if (const std::size_t targets = count_targets(mesh); targets > 0) {
        json["weights"] = describe_weights(mesh.morph_weights, targets);
    }
    if (!mesh.name.empty()) json["name"] = to_json(mesh.name);
    return draft_.add("meshes", std::move(json));
}

Json MeshWriter::describe(const Primitive& primitive) {
    Json attributes = add_vertices(primitive.vertices, draft_);
    if (!primitive.second_uvs.empty()) {
        attributes["TEXCOORD_1"] = add_second_uvs(primitive.second_uvs, draft_);
    }
    add_influences(primitive, draft_, attributes);
    Json json = {{"attributes", std::move(attributes)},
                 {"indices", add_indices(primitive.indices, draft_)},
                 {"material", materials_.index_of(primitive.material)}};
    if (!primitive.targets.empty()) json["targets"] = describe_targets(primitive, draft_);
    return json;
}

}  // namespace candela::gltf
