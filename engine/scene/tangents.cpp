#include <candela/scene/tangents.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace candela {

namespace {

/// The 16-bit integer that stands for 1.
constexpr float one = 32767.0F;

/// Sums of tangents of triangles whose texture is not mirrored, and of those whose texture is.
using Sums = std::array<glm::dvec3, 2>;

/// Places of vertices with the tangents of either side.
using Places = std::array<std::uint32_t, 2>;

constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

/// What makes two vertices one, as bits, which have an order whatever the numbers are.
std::array<std::uint32_t, 8> key_of(const Vertex& vertex, glm::vec2 uv) {
    const auto bits = [](float number) {
        return std::bit_cast<std::uint32_t>(number + 0.0F);  // makes -0 a 0
    };
    return {bits(vertex.position.x),
            bits(vertex.position.y),
            bits(vertex.position.z),
            bits(vertex.normal.x),
            bits(vertex.normal.y),
            bits(vertex.normal.z),
            bits(uv.x),
            bits(uv.y)};
}

/// Whether the normal texture lies by Primitive::second_uvs.
bool bumps_by_second_uvs(const Primitive& primitive) {
    return primitive.material && primitive.material->second_uvs.normal && !primitive.second_uvs.empty();
}

/// The coordinates of the normal texture at each vertex.
std::vector<glm::vec2> uvs_of(const Primitive& primitive) {
    if (bumps_by_second_uvs(primitive)) return primitive.second_uvs;
    std::vector<glm::vec2> uvs;
    uvs.reserve(primitive.vertices.size());
    for (const Vertex& vertex : primitive.vertices) uvs.push_back(vertex.uv);
    return uvs;
}

/// For each vertex, the number of the set of equal vertices that it belongs to.
std::vector<std::uint32_t> sets_of_equals(const std::vector<Vertex>& vertices,
                                          const std::vector<glm::vec2>& uvs) {
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) { return key_of(vertices[i], uvs[i]); };
    std::ranges::sort(order, {}, key);
    std::vector<std::uint32_t> sets(vertices.size(), 0);
    for (std::size_t i = 1; i < order.size(); ++i) {
        const bool is_new = key(order[i]) != key(order[i - 1]);
        sets[order[i]] = sets[order[i - 1]] + (is_new ? 1U : 0U);
    }
    return sets;
}

/// Zero for a zero vector.
glm::dvec3 direction_of(const glm::dvec3& vector) {
    const double length = glm::length(vector);
    return length > 0.0 ? vector / length : glm::dvec3(0.0);
}

/// Direction of what is left of a unit vector without its part along the unit vector `normal`; zero if that
/// is nothing but rounding of the normal, whose members are floats.
glm::dvec3 in_plane(const glm::dvec3& vector, const glm::dvec3& normal) {
    const glm::dvec3 projected = vector - glm::dot(vector, normal) * normal;
    constexpr double rounding = 1e-6;
    return glm::length(projected) > rounding ? glm::normalize(projected) : glm::dvec3(0.0);
}

glm::dvec3 perpendicular_to(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    glm::dvec3 axis(0.0, 0.0, 1.0);
    if (size.x <= size.y && size.x <= size.z) {
        axis = {1.0, 0.0, 0.0};
    } else if (size.y <= size.z) {
        axis = {0.0, 1.0, 0.0};
    }
    const glm::dvec3 across = direction_of(glm::cross(axis, normal));
    return across == glm::dvec3(0.0) ? glm::dvec3(1.0, 0.0, 0.0) : across;
}

/// In radians, between two unit vectors; zero if one of them is zero.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    if (a == glm::dvec3(0.0) || b == glm::dvec3(0.0)) return 0.0;
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

struct TriangleTangent {
    glm::dvec3 along;  ///< unit vector in the triangle, in the direction of increasing u
    std::size_t side;  ///< 0, or 1 if the texture is mirrored
};

/// Nullopt if the triangle has no area, in space or in the texture.
std::optional<TriangleTangent> tangent_of(const std::array<const Vertex*, 3>& corners,
                                          const std::array<glm::dvec2, 3>& uv) {
    const auto& [a, b, c] = corners;
    const glm::dvec3 to_b = glm::dvec3(b->position) - glm::dvec3(a->position);
    const glm::dvec3 to_c = glm::dvec3(c->position) - glm::dvec3(a->position);
    // MikkTSpace's v grows upwards, glTF's downwards.
    const glm::dvec2 upwards(1.0, -1.0);
    const glm::dvec2 uv_to_b = upwards * (uv[1] - uv[0]);
    const glm::dvec2 uv_to_c = upwards * (uv[2] - uv[0]);
    const double area = uv_to_b.x * uv_to_c.y - uv_to_b.y * uv_to_c.x;
    if (area == 0.0 || glm::cross(to_b, to_c) == glm::dvec3(0.0)) return std::nullopt;
    const glm::dvec3 along = direction_of(uv_to_c.y * to_b - uv_to_b.y * to_c);
    return area > 0.0 ? TriangleTangent{along, 0} : TriangleTangent{-along, 1};
}

/// Appends a copy of one of its items to a list that has an item for each vertex, if it is not empty.
template <class T>
void repeat(std::vector<T>& list, std::size_t item) {
    if (item >= list.size()) return;
    const T copy = list[item];
    list.push_back(copy);
}

/// Appends a copy of a vertex with all that belongs to it.
void repeat_vertex(Primitive& primitive, std::size_t vertex) {
    repeat(primitive.vertices, vertex);
    repeat(primitive.second_uvs, vertex);
    for (std::vector<Influences>& set : primitive.influences) repeat(set, vertex);
    for (MorphTarget& target : primitive.targets) {
        repeat(target.positions, vertex);
        repeat(target.normals, vertex);
        repeat(target.tangents, vertex);
    }
}

class TangentWriter {
 public:
    explicit TangentWriter(Primitive& primitive)
        : primitive_(primitive),
          vertices_(primitive.vertices),
          indices_(primitive.indices),
          uvs_(uvs_of(primitive)),
          sets_(sets_of_equals(vertices_, uvs_)),
          sums_(vertices_.size(), Sums{glm::dvec3(0.0), glm::dvec3(0.0)}),
          places_(vertices_.size(), Places{nowhere, nowhere}) {}

    void write() {
        std::vector<std::optional<std::size_t>> sides(indices_.size() / 3);
        for (std::size_t i = 0; i < sides.size(); ++i) {
            sides[i] = add_triangle(3 * i);
        }
        for (std::size_t i = 0; i < 3 * sides.size(); ++i) {
            indices_[i] = place(indices_[i], sides[i / 3]);
        }
        for (std::uint32_t i = 0; i < places_.size(); ++i) {
            if (places_[i] == Places{nowhere, nowhere}) place(i, std::nullopt);
        }
    }

 private:
    /// Adds the triangle's tangent to those of its corners. Returns its side, if it has one.
    std::optional<std::size_t> add_triangle(std::size_t first) {
        std::array<const Vertex*, 3> corners{};
        std::array<glm::dvec2, 3> uv{};
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = &vertices_[indices_[first + i]];
            uv[i] = glm::dvec2(uvs_[indices_[first + i]]);
        }
        const auto tangent = tangent_of(corners, uv);
        if (!tangent) return std::nullopt;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 normal = direction_of(corners[i]->normal);
            const glm::dvec3 position(corners[i]->position);
            const auto edge = [&](std::size_t to) {
                return in_plane(direction_of(glm::dvec3(corners[to]->position) - position), normal);
            };
            const double angle = angle_between(edge((i + 1) % 3), edge((i + 2) % 3));
            sums_[sets_[indices_[first + i]]][tangent->side] += angle * in_plane(tangent->along, normal);
        }
        return tangent->side;
    }

    /// The index of the vertex, or of its copy, that has the tangent of this side. Without a side, that of
    /// triangles whose texture is not mirrored, if there are any.
    std::uint32_t place(std::uint32_t vertex, std::optional<std::size_t> wanted) {
        const Sums& sums = sums_[sets_[vertex]];
        const bool is_mirrored = sums[0] == glm::dvec3(0.0) && sums[1] != glm::dvec3(0.0);
        const std::size_t side = wanted.value_or(is_mirrored ? 1 : 0);
        Places& places = places_[vertex];
        if (places[side] != nowhere) return places[side];
        places[side] = vertex;
        if (places[1 - side] != nowhere) {
            places[side] = static_cast<std::uint32_t>(vertices_.size());
            repeat_vertex(primitive_, vertex);
        }
        const glm::dvec3 normal = direction_of(vertices_[vertex].normal);
        const glm::dvec3 sum = in_plane(direction_of(sums[side]), normal);
        const glm::dvec3 along = sum == glm::dvec3(0.0) ? perpendicular_to(normal) : sum;
        vertices_[places[side]].tangent =
            packed_tangent(glm::vec4(glm::vec3(along), side == 0 ? 1.0F : -1.0F));
        return places[side];
    }

    Primitive& primitive_;
    std::vector<Vertex>& vertices_;
    std::vector<std::uint32_t>& indices_;
    std::vector<glm::vec2> uvs_;  // of the vertices that there were
    std::vector<std::uint32_t> sets_;
    std::vector<Sums> sums_;      // by set
    std::vector<Places> places_;  // by vertex
};

}  // namespace

void derive_tangents(Primitive& primitive) {
    TangentWriter(primitive).write();
}

glm::i16vec4 packed_tangent(const glm::vec4& tangent) {
    return {glm::round(glm::clamp(tangent, -1.0F, 1.0F) * one)};
}

glm::vec4 unpacked_tangent(const glm::i16vec4& tangent) {
    return glm::vec4(tangent) / one;
}

}  // namespace candela
