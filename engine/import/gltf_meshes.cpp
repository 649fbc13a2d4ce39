#include "engine/import/gltf_meshes.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/naming.hpp"
#include "engine/import/unit_length.hpp"

namespace candela::gltf {

namespace {

using Corners = std::array<std::uint32_t, 3>;

/// Kinds of content that were left out of the meshes. Each is reported once.
struct Omissions {
    bool points_or_lines = false;
    bool no_positions = false;
    bool morph_targets = false;
    bool second_colours = false;
};

std::optional<int> find_attribute(const Json& source, std::string_view name) {
    const Json* const found = source.at("attributes").find(name);
    return found ? std::optional(found->whole<int>()) : std::nullopt;
}

int mode_of(const Json& source) {
    return number_in(source, "mode", mode_triangles);
}

/// The accessor of the indices; -1 for none.
int indices_of(const Json& source) {
    return index_in(source, "indices");
}

/// The accessor of an attribute, which must have one element for each position.
int checked_attribute(const Document& document, int accessor, std::string_view attribute,
                      std::size_t positions) {
    const std::size_t count = element_count(document, accessor);
    if (count != positions) {
        throw SceneError(fmt::format("it has {} positions, but {} {}", positions, count, attribute));
    }
    return accessor;
}

/// The selected vertices. A missing normal is zero until the faces provide one.
std::vector<Vertex> read_vertices(const Document& document, const Json& source, int positions,
                                  const Selection& selection) {
    const std::size_t all = element_count(document, positions);
    std::vector<Vertex> vertices;
    vertices.reserve(selection.count());
    for (const glm::vec3& position : read_vectors(document, positions, selection)) {
        vertices.push_back({position, glm::vec3(0.0F), glm::vec2(0.0F)});
    }
    if (const auto found = find_attribute(source, "NORMAL")) {
        const int accessor = checked_attribute(document, *found, "normals", all);
        const std::vector<glm::vec3> normals = read_vectors(document, accessor, selection);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            // In double precision, the square of a float neither underflows nor overflows.
            const glm::dvec3 normal(normals[i]);
            const double length = glm::length(normal);
            if (length > 0.0) {
                vertices[i].normal = is_unit_length(length) ? normals[i] : glm::vec3(normal / length);
            }
        }
    }
    if (const auto found = find_attribute(source, "TEXCOORD_0")) {
        const int accessor = checked_attribute(document, *found, "texture coordinates", all);
        const std::vector<glm::vec2> coordinates = read_texture_coordinates(document, accessor, selection);
        for (std::size_t i = 0; i < coordinates.size(); ++i) {
            vertices[i].uv = coordinates[i];
        }
    }
    if (const auto found = find_attribute(source, "COLOR_0")) {
        const int accessor = checked_attribute(document, *found, "colours", all);
        const std::vector<glm::u16vec4> colours = read_colours(document, accessor, selection);
        for (std::size_t i = 0; i < colours.size(); ++i) {
            vertices[i].colour = colours[i];
        }
    }
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

std::vector<Vertex> unshare(const std::vector<Vertex>& vertices, std::vector<Corners>& triangles) {
    std::vector<Vertex> unshared;
    for (Corners& corners : triangles) {
        for (std::uint32_t& corner : corners) {
            unshared.push_back(vertices[corner]);
            corner = static_cast<std::uint32_t>(unshared.size() - 1);
        }
    }
    return unshared;
}

/// Gives each vertex without a normal that of the first face that uses it, or +Z if no face does.
void fill_normals(std::vector<Vertex>& vertices, const std::vector<Corners>& triangles) {
    for (const Corners& corners : triangles) {
        const glm::vec3 normal = face_normal(vertices, corners);
        for (const std::uint32_t corner : corners) {
            if (vertices[corner].normal == glm::vec3(0.0F)) {
                vertices[corner].normal = normal;
            }
        }
    }
    for (Vertex& vertex : vertices) {
        if (vertex.normal == glm::vec3(0.0F)) {
            vertex.normal = {0.0F, 0.0F, 1.0F};
        }
    }
}

bool is_drawn(const Json& source, Omissions& omissions) {
    const bool triangles = mode_of(source) >= mode_triangles;
    const bool positions = find_attribute(source, "POSITION").has_value();
    omissions.points_or_lines |= !triangles;
    omissions.no_positions |= triangles && !positions;
    omissions.morph_targets |= !list_in(source, "targets").empty();
    omissions.second_colours |= find_attribute(source, "COLOR_1").has_value();
    return triangles && positions;
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
        element_count(document, indices >= 0 ? indices : *find_attribute(source, "POSITION"));
    const std::uint64_t triangles = triangle_count(order, mode_of(source));
    budget.add_triangles(triangles);
    budget.add_memory(order * sizeof(std::uint32_t) + triangles * sizeof(Corners));
    if (!find_attribute(source, "NORMAL")) {
        budget.add_memory(triangles * 3 * sizeof(Vertex));
    }
}

/// Without indices if no triangle has an area.
Primitive read_primitive(const Document& document, const Json& source, ImportBudget& budget) {
    const int positions = *find_attribute(source, "POSITION");
    const std::size_t vertex_count = element_count(document, positions);
    count_triangles(document, source, budget);
    std::vector<std::uint32_t> order = read_order(document, source, vertex_count);
    // Many primitives may share the vertices of one accessor, of which each uses a few.
    const bool uses_few = order.size() < vertex_count / 2;
    const std::vector<std::uint32_t> used = uses_few ? compact(order) : std::vector<std::uint32_t>{};
    const Selection selection = uses_few ? Selection(used) : Selection(vertex_count);
    budget.add_memory(selection.count() * sizeof(Vertex));

    Primitive primitive;
    primitive.vertices = read_vertices(document, source, positions, selection);
    std::vector<Corners> triangles = assemble(order, mode_of(source));
    std::erase_if(triangles, [&](const Corners& corners) {
        return face_normal(primitive.vertices, corners) == glm::vec3(0.0F);
    });
    if (!find_attribute(source, "NORMAL")) {
        primitive.vertices = unshare(primitive.vertices, triangles);
    }
    fill_normals(primitive.vertices, triangles);
    primitive.indices.reserve(3 * triangles.size());
    for (const Corners& corners : triangles) {
        primitive.indices.insert(primitive.indices.end(), corners.begin(), corners.end());
    }
    return primitive;
}

Mesh read_mesh(const Document& document, const Json& source, const std::vector<ReadMaterial>& materials,
               Omissions& omissions, ImportBudget& budget) {
    Mesh mesh;
    mesh.name = text_in(source, "name");
    for (const Json& part : source.at("primitives").items()) {
        if (!is_drawn(part, omissions)) {
            continue;
        }
        Primitive primitive = read_primitive(document, part, budget);
        if (primitive.indices.empty()) {
            continue;
        }
        const int material = index_in(part, "material");
        const ReadMaterial& read =
            material < 0 ? materials.back() : materials[static_cast<std::size_t>(material)];
        primitive.material = read.material;
        for (Vertex& vertex : primitive.vertices) {
            vertex.uv = glm::vec2(read.uv_transform * glm::vec3(vertex.uv, 1.0F));
        }
        mesh.primitives.push_back(std::move(primitive));
    }
    return mesh;
}

void report(const Omissions& omissions, std::vector<std::string>& warnings) {
    if (omissions.points_or_lines) {
        warnings.emplace_back("points and lines are skipped");
    }
    if (omissions.no_positions) {
        warnings.emplace_back("primitives without positions are skipped");
    }
    if (omissions.morph_targets) {
        warnings.emplace_back("morph targets are ignored");
    }
    if (omissions.second_colours) {
        warnings.emplace_back("vertex colours beyond the first set are ignored");
    }
}

}  // namespace

std::vector<std::shared_ptr<const Mesh>> read_meshes(Document& document, const std::vector<bool>& used,
                                                     const std::vector<ReadMaterial>& materials,
                                                     ImportBudget& budget, const Progress& progress) {
    Omissions omissions;
    std::vector<std::shared_ptr<const Mesh>> meshes(used.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (!used[i]) {
            continue;
        }
        progress("reading meshes", i, meshes.size());
        Mesh mesh = naming(fmt::format("mesh {}", i), [&] {
            return read_mesh(document, document.all("meshes")[i], materials, omissions, budget);
        });
        meshes[i] = mesh.primitives.empty() ? nullptr : std::make_shared<const Mesh>(std::move(mesh));
    }
    report(omissions, document.warnings);
    return meshes;
}

}  // namespace candela::gltf
