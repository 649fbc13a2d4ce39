#include "engine/import/gltf_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <candela/scene/scene_error.hpp>
#include <candela/scene/tangents.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_compressed.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/gltf_morphs.hpp"
#include "engine/import/gltf_skins.hpp"
#include "engine/import/naming.hpp"
#include "engine/import/unit_length.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

using Corners = std::array<std::uint32_t, 3>;

/// Warnings about kinds of content that were left out, each once.
using Omissions = std::set<std::string>;

/// The accessor of an attribute; -1 for none.
int attribute_of(const Json& source, std::string_view name) {
    return index_in(source.at("attributes"), name);
}

int mode_of(const Json& source) {
    return value_in(source, "mode", mode_triangles);
}

/// The accessor of the indices; -1 for none.
int indices_of(const Json& source) {
    return index_in(source, "indices");
}

/// Sets an attribute, if the primitive has it, of the selected vertices. It must have one element for each
/// position.
template <class Element, class Vertices, class Set>
void read_attribute(const Document& document, const Json& source, std::string_view name, const Use& use,
                    const Selection& selection, Vertices& vertices, Set set) {
    const int accessor = attribute_of(source, name);
    if (accessor < 0) return;
    check_count(document, source, accessor, use.plural);
    const auto elements = read_reals<Element>(document, accessor, selection, use);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        set(vertices[i], elements[i]);
    }
}

void set_colour(Vertex& vertex, const glm::vec4& colour) {
    vertex.colour = glm::u16vec4(glm::clamp(colour, 0.0F, 1.0F) * 65535.0F + 0.5F);
}

void set_normal(Vertex& vertex, const glm::vec3& normal) {
    // In double precision, the square of a float neither underflows nor overflows.
    const double length = glm::length(glm::dvec3(normal));
    if (length > 0.0) {
        vertex.normal = is_unit_length(length) ? normal : glm::vec3(glm::dvec3(normal) / length);
    }
}

/// Leaves a tangent without length as it is: zero.
void set_tangent(Vertex& vertex, const glm::vec4& tangent) {
    const glm::dvec3 along(tangent);
    const double length = glm::length(along);
    if (!(length > 0.0)) return;
    // Those that an export has written, which were rounded to 16 bits, must stay the same.
    constexpr double tolerance = 1e-4;
    const glm::dvec3 unit = std::abs(length - 1.0) <= tolerance ? along : along / length;
    vertex.tangent = packed_tangent(glm::vec4(glm::vec3(unit), tangent.w < 0.0F ? -1.0F : 1.0F));
}

/// Reads texture coordinates of this kind; zero where the file has none.
template <class Element, class Set>
void read_uvs(const Document& document, const Json& source, const Coordinates& coordinates,
              const Selection& selection, std::vector<Element>& into, Set set) {
    read_attribute<glm::vec2>(document, source, fmt::format("TEXCOORD_{}", coordinates.set),
                              uses::texture_coordinates, selection, into, set);
}

glm::vec2 transformed(const Coordinates& coordinates, glm::vec2 uv) {
    return glm::vec2(coordinates.transform * glm::vec3(uv, 1.0F));
}

/// By selected vertex.
std::vector<glm::vec2> read_second_uvs(const Document& document, const Json& source,
                                       const Coordinates& coordinates, const Selection& selection,
                                       ImportBudget& budget) {
    budget.add_memory(selection.count() * sizeof(glm::vec2));
    std::vector<glm::vec2> uvs(selection.count(), glm::vec2(0.0F));
    read_uvs(document, source, coordinates, selection, uvs, [](glm::vec2& into, glm::vec2 uv) { into = uv; });
    for (glm::vec2& uv : uvs) uv = transformed(coordinates, uv);
    return uvs;
}

/// The selected vertices. A missing normal is zero until the faces provide one.
std::vector<Vertex> read_vertices(const Document& document, const Json& source,
                                  const Coordinates& coordinates, const Selection& selection) {
    std::vector<Vertex> vertices;
    vertices.reserve(selection.count());
    for (const glm::vec3& position :
         read_reals<glm::vec3>(document, attribute_of(source, "POSITION"), selection, uses::positions)) {
        vertices.push_back({position, glm::vec3(0.0F), glm::vec2(0.0F)});
    }
    read_attribute<glm::vec3>(document, source, "NORMAL", uses::normals, selection, vertices, set_normal);
    read_uvs(document, source, coordinates, selection, vertices,
             [](Vertex& vertex, glm::vec2 uv) { vertex.uv = uv; });
    read_attribute<glm::vec4>(document, source, "COLOR_0", uses::colours, selection, vertices, set_colour);
    return vertices;
}

std::vector<std::uint32_t> read_order(const Document& document, const Json& source,
                                      std::size_t vertex_count) {
    if (const int indices = indices_of(source); indices >= 0) {
        return read_indices(document, indices, vertex_count);
    }
    std::vector<std::uint32_t> order(vertex_count);
    std::iota(order.begin(), order.end(), 0U);
    return order;
}

/// The vertices that the indices in `order` use, ascending. Makes `order` refer to this list.
std::vector<std::uint32_t> compact(std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> used(order);
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& vertex : order) {
        vertex = static_cast<std::uint32_t>(std::ranges::lower_bound(used, vertex) - used.begin());
    }
    return used;
}

/// The triangles of a list, strip or fan, with the winding order of glTF 2.0 (section 3.7.2.1).
std::vector<Corners> assemble(std::span<const std::uint32_t> order, int mode) {
    std::vector<Corners> triangles;
    if (mode == mode_triangles) {
        for (std::size_t i = 0; i < order.size(); i += 3) {
            triangles.push_back({order[i], order[i + 1], order[i + 2]});
        }
        return triangles;
    }
    for (std::size_t i = 0; i + 2 < order.size(); ++i) {
        if (mode == mode_triangle_strip) {
            triangles.push_back({order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]});
        } else {
            triangles.push_back({order[i + 1], order[i + 2], order[0]});
        }
    }
    return triangles;
}

/// Unit normal of the triangle's front; zero if it has no area. Computed in double precision, in which the
/// products of floats neither underflow nor overflow.
glm::vec3 face_normal(const std::vector<Vertex>& vertices, const Corners& corners) {
    const glm::dvec3 a(vertices[corners[0]].position);
    const glm::dvec3 normal = glm::cross(glm::dvec3(vertices[corners[1]].position) - a,
                                         glm::dvec3(vertices[corners[2]].position) - a);
    const double length = glm::length(normal);
    return length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0F);
}

/// The items of the corners of all triangles, of a list with an item for each vertex.
template <class T>
void unshare(std::vector<T>& list, const std::vector<Corners>& triangles) {
    if (list.empty()) return;
    std::vector<T> unshared;
    unshared.reserve(3 * triangles.size());
    for (const Corners& corners : triangles) {
        for (const std::uint32_t corner : corners) {
            unshared.push_back(list[corner]);
        }
    }
    list = std::move(unshared);
}

/// Gives each corner of the triangles a vertex of its own.
void unshare_vertices(Primitive& primitive, std::vector<Corners>& triangles) {
    unshare(primitive.vertices, triangles);
    unshare(primitive.second_uvs, triangles);
    for (std::vector<Influences>& set : primitive.influences) {
        unshare(set, triangles);
    }
    for (MorphTarget& target : primitive.targets) {
        unshare(target.positions, triangles);
    }
    std::uint32_t next = 0;
    for (Corners& corners : triangles) {
        corners = {next, next + 1, next + 2};
        next += 3;
    }
}

/// Gives each vertex without a normal that of the first face that uses it, or +Z if no face does.
void fill_normals(std::vector<Vertex>& vertices, const std::vector<Corners>& triangles) {
    for (const Corners& corners : triangles) {
        const glm::vec3 normal = face_normal(vertices, corners);
        for (const std::uint32_t corner : corners) {
            if (vertices[corner].normal == glm::vec3(0.0F)) vertices[corner].normal = normal;
        }
    }
    for (Vertex& vertex : vertices) {
        if (vertex.normal == glm::vec3(0.0F)) vertex.normal = {0.0F, 0.0F, 1.0F};
    }
}

/// Why the primitive has no positions or indices, although it names accessors of them: these are then in an
/// extension that is not supported. Zeros would be drawn otherwise. Empty if it has them.
std::string missing_data(const Document& document, const Json& source) {
    const int indices = indices_of(source);
    const bool is_there =
        has_data(document, attribute_of(source, "POSITION")) && (indices < 0 || has_data(document, indices));
    if (is_there) return {};
    for (const auto& [name, extension] : list_in(source, "extensions").items()) {
        if (!is_supported(name)) {
            return fmt::format("primitives whose data {} holds are skipped", readable(name));
        }
    }
    return "primitives whose positions or indices have no data are skipped";
}

bool is_drawn(const Document& document, const Json& source, Omissions& omissions) {
    if (attribute_of(source, "COLOR_1") >= 0) {
        omissions.insert("vertex colours beyond the first set are ignored");
    }
    if (mode_of(source) < mode_triangles) {
        omissions.insert("points and lines are skipped");
        return false;
    }
    if (attribute_of(source, "POSITION") < 0) {
        omissions.insert("primitives without positions are skipped");
        return false;
    }
    if (const std::string missing = missing_data(document, source); !missing.empty()) {
        omissions.insert(missing);
        return false;
    }
    return true;
}

/// The triangles of so many indices or vertices.
std::uint64_t triangle_count(std::uint64_t order, int mode) {
    if (order < 3 || (mode == mode_triangles && order % 3 != 0)) {
        throw SceneError(
            fmt::format("it has {} indices or vertices, which make no whole number of triangles", order));
    }
    return mode == mode_triangles ? order / 3 : order - 2;
}

/// Counts what read_primitive needs, without the vertices that it selects.
void count_triangles(const Document& document, const Json& source, ImportBudget& budget) {
    const int indices = indices_of(source);
    const std::uint64_t order =
        element_count(document, indices >= 0 ? indices : attribute_of(source, "POSITION"));
    const std::uint64_t triangles = triangle_count(order, mode_of(source));
    budget.add_triangles(triangles);
    budget.add_memory(order * sizeof(std::uint32_t) + triangles * sizeof(Corners));
    if (attribute_of(source, "NORMAL") < 0) {
        const std::uint64_t targets = list_in(source, "targets").size();
        budget.add_memory(triangles * 3 * (sizeof(Vertex) + targets * 2 * sizeof(glm::vec3)));
    }
}

/// Whether the file's tangents may be used: by glTF, those without normals are to be ignored. Tangents belong
/// to the file's coordinates of the normal texture; a transform may turn these.
bool has_tangents(const Json& source, const ReadMaterial& material) {
    const Coordinates& bumps = material.material->second_uvs.normal ? *material.second_uvs : material.uv;
    return attribute_of(source, "TANGENT") >= 0 && attribute_of(source, "NORMAL") >= 0 &&
           bumps.transform == glm::mat3(1.0F);
}

/// Derives what tangents a normal texture needs and the file does not have.
void complete_tangents(Primitive& primitive, ImportBudget& budget) {
    const auto is_missing = [](const Vertex& vertex) { return vertex.tangent == glm::i16vec4(0); };
    if (std::ranges::none_of(primitive.vertices, is_missing)) return;
    // Each vertex may be split; sums and indices by vertex take about as much again.
    const std::size_t vertex_size = sizeof(Vertex) + primitive.influences.size() * sizeof(Influences) +
                                    primitive.targets.size() * 2 * sizeof(glm::vec3);
    budget.add_memory(primitive.vertices.size() * 3 * vertex_size);
    derive_tangents(primitive);
}

/// Without indices if no triangle has an area. Triangles that may get one when they move are kept.
Primitive read_primitive(const Document& document, const Json& source, const ReadMaterial& material,
                         bool is_skinned, ImportBudget& budget) {
    const std::size_t vertex_count = element_count(document, attribute_of(source, "POSITION"));
    count_triangles(document, source, budget);
    std::vector<std::uint32_t> order = read_order(document, source, vertex_count);
    // Many primitives may share the vertices of one accessor, of which each uses a few.
    const bool uses_few = order.size() < vertex_count / 2;
    const std::vector<std::uint32_t> used = uses_few ? compact(order) : std::vector<std::uint32_t>{};
    const Selection selection = uses_few ? Selection(used) : Selection(vertex_count);
    budget.add_memory(selection.count() * sizeof(Vertex));

    Primitive primitive;
    primitive.material = material.material;
    primitive.vertices = read_vertices(document, source, material.uv, selection);
    if (material.second_uvs) {
        primitive.second_uvs = read_second_uvs(document, source, *material.second_uvs, selection, budget);
    }
    const bool needs_tangents = material.material->normal_texture != nullptr;
    const bool uses_tangents = needs_tangents && has_tangents(source, material);
    if (uses_tangents) {
        read_attribute<glm::vec4>(document, source, "TANGENT", uses::tangents, selection, primitive.vertices,
                                  set_tangent);
    }
    if (is_skinned) primitive.influences = read_influences(document, source, selection, budget);
    primitive.targets = read_targets(document, source, uses_tangents, selection, budget);
    std::vector<Corners> triangles = assemble(order, mode_of(source));
    const bool is_rigid = primitive.influences.empty() && primitive.targets.empty();
    std::erase_if(triangles, [&](const Corners& corners) {
        return is_rigid && face_normal(primitive.vertices, corners) == glm::vec3(0.0F);
    });
    const bool is_flat = attribute_of(source, "NORMAL") < 0;
    if (is_flat) unshare_vertices(primitive, triangles);
    fill_normals(primitive.vertices, triangles);
    for (MorphTarget& target : primitive.targets) {
        if (is_flat) set_face_normal_offsets(primitive.vertices, triangles, target);
    }
    primitive.indices.reserve(3 * triangles.size());
    for (const Corners& corners : triangles) {
        primitive.indices.insert(primitive.indices.end(), corners.begin(), corners.end());
    }
    for (Vertex& vertex : primitive.vertices) {
        vertex.uv = transformed(material.uv, vertex.uv);
    }
    if (needs_tangents && !triangles.empty()) complete_tangents(primitive, budget);
    return primitive;
}

Mesh read_mesh(const Document& document, const Json& source, const std::vector<ReadMaterial>& materials,
               bool is_skinned, Omissions& omissions, ImportBudget& budget) {
    Mesh mesh;
    const std::size_t targets = count_targets(source);
    budget.add_memory(targets * sizeof(float));
    mesh.morph_weights = read_morph_weights(source, targets, std::vector<float>(targets));
    mesh.name = text_in(source, "name");
    for (const Json& part : source.at("primitives")) {
        if (!is_drawn(document, part, omissions)) continue;
        const int index = index_in(part, "material");
        const ReadMaterial& material =
            index < 0 ? materials.back() : materials[static_cast<std::size_t>(index)];
        Primitive primitive = read_primitive(document, part, material, is_skinned, budget);
        if (!primitive.indices.empty()) mesh.primitives.push_back(std::move(primitive));
    }
    return mesh;
}

}  // namespace

std::vector<std::shared_ptr<const Mesh>> read_meshes(Document& document, const std::vector<bool>& used,
                                                     const std::vector<bool>& skinned,
                                                     const std::vector<ReadMaterial>& materials,
                                                     ImportBudget& budget, const Progress& progress) {
    Omissions omissions;
    std::vector<std::shared_ptr<const Mesh>> meshes(used.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (!used[i]) continue;
        progress("reading meshes", i, meshes.size());
        Mesh mesh = naming(fmt::format("mesh {}", i), [&] {
            const Json& source = document.all("meshes")[i];
            decode_primitives(document, source, budget);
            return read_mesh(document, source, materials, skinned[i], omissions, budget);
        });
        meshes[i] = mesh.primitives.empty() ? nullptr : std::make_shared<const Mesh>(std::move(mesh));
    }
    document.warnings.insert(document.warnings.end(), omissions.begin(), omissions.end());
    return meshes;
}

}  // namespace candela::gltf
