#include "engine/animation/skinning.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <candela/scene/scene_error.hpp>
#include <candela/scene/tangents.hpp>

namespace candela {

namespace {

// Four floats are read and written at a time from the position, whose fourth lane is then the normal's x, and
// from the normal, whose fourth lane is the texture coordinates' first.
static_assert(offsetof(Vertex, position) == 0 && offsetof(Vertex, normal) == 12 &&
              offsetof(Vertex, uv) == 24);

Lanes load(const Vertex& vertex, std::size_t offset) {
    Lanes lanes;
    std::memcpy(&lanes, reinterpret_cast<const unsigned char*>(&vertex) + offset, sizeof lanes);
    return lanes;
}

void store(Lanes lanes, Vertex& vertex, std::size_t offset) {
    std::memcpy(reinterpret_cast<unsigned char*>(&vertex) + offset, &lanes, sizeof lanes);
}

Lanes all(float value) {
    return Lanes{value, value, value, value};
}

/// y, z, x.
Lanes rotated(Lanes v) {
    return __builtin_shufflevector(v, v, 1, 2, 0, 3);
}

/// The weighted mean of the matrices.
AffineColumns mean_of(const Pull* pull, const Pull* end, std::span<const AffineColumns> joints) {
    const AffineColumns& first = joints[pull->joint];
    Lanes weight = all(pull->weight);
    AffineColumns mean{first.x * weight, first.y * weight, first.z * weight, first.translation * weight};
    for (++pull; pull != end; ++pull) {
        const AffineColumns& joint = joints[pull->joint];
        weight = all(pull->weight);
        mean.x += joint.x * weight;
        mean.y += joint.y * weight;
        mean.z += joint.z * weight;
        mean.translation += joint.translation * weight;
    }
    return mean;
}

/// The product with the matrix of cofactors, whose columns are the cross products of the matrix's columns.
Lanes times_cofactors(const AffineColumns& m, Lanes v) {
    const Lanes x = rotated(m.x);
    const Lanes y = rotated(m.y);
    const Lanes z = rotated(m.z);
    return rotated((m.y * z - y * m.z) * all(v[0]) + (m.z * x - z * m.x) * all(v[1]) +
                   (m.x * y - x * m.y) * all(v[2]));
}

float squared_length(Lanes v) {
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

glm::dvec3 to_double(Lanes v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// The unit normal where single precision overflows or underflows; `otherwise` if it has no direction.
Lanes precise_normal(const AffineColumns& m, Lanes v, Lanes otherwise) {
    const glm::dvec3 x = to_double(m.x);
    const glm::dvec3 y = to_double(m.y);
    const glm::dvec3 z = to_double(m.z);
    const glm::dvec3 of = to_double(v);
    const glm::dvec3 normal = glm::cross(y, z) * of.x + glm::cross(z, x) * of.y + glm::cross(x, y) * of.z;
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length)) return otherwise;
    const glm::vec3 unit(normal / length);
    return Lanes{unit.x, unit.y, unit.z, 0.0F};
}

/// Squares of lengths between which single precision does.
constexpr float smallest = 1e-30F;
constexpr float largest = 1e30F;

Lanes moved_normal(const AffineColumns& m, Lanes normal) {
    const Lanes moved = times_cofactors(m, normal);
    const float square = squared_length(moved);
    if (!(square > smallest && square < largest)) return precise_normal(m, normal, normal);
    return moved * all(1.0F / std::sqrt(square));
}

glm::i16vec4 moved_tangent(const AffineColumns& m, const glm::i16vec4& tangent) {
    const glm::vec4 rest = unpacked_tangent(tangent);
    const Lanes moved = m.x * all(rest.x) + m.y * all(rest.y) + m.z * all(rest.z);
    const float square = squared_length(moved);
    if (!(square > smallest && square < largest)) return tangent;
    const Lanes unit = moved * all(1.0F / std::sqrt(square));
    return packed_tangent({unit[0], unit[1], unit[2], rest.w});
}

/// Whether a list is empty or has an item for each vertex.
template <class List>
bool fits(const List& list, const Primitive& primitive) {
    return list.empty() || list.size() == primitive.vertices.size();
}

/// Keeps those with a weight of a vertex's pulls, which begin at `first`, and makes the weights add up to 1.
void normalise(std::vector<Pull>& pulls, std::size_t first) {
    const std::uint32_t follows = pulls[first].joint;
    double sum = 0.0;
    for (std::size_t i = first; i < pulls.size(); ++i) sum += static_cast<double>(pulls[i].weight);
    const auto begin = pulls.begin() + static_cast<std::ptrdiff_t>(first);
    pulls.erase(std::remove_if(begin, pulls.end(), [](const Pull& pull) { return pull.weight == 0.0F; }),
                pulls.end());
    if (pulls.size() == first) {
        pulls.push_back({follows, 1.0F});
        return;
    }
    for (std::size_t i = first; i < pulls.size(); ++i) {
        pulls[i].weight = static_cast<float>(static_cast<double>(pulls[i].weight) / sum);
    }
}

}  // namespace

AffineColumns columns_of(const glm::mat4& m) {
    const auto column = [&](int i) { return Lanes{m[i].x, m[i].y, m[i].z, 0.0F}; };
    return {column(0), column(1), column(2), column(3)};
}

PreparedInfluences prepare_influences(const Primitive& primitive) {
    PreparedInfluences prepared;
    prepared.has_tangents = std::ranges::any_of(
        primitive.vertices, [](const Vertex& vertex) { return vertex.tangent != glm::i16vec4(0); });
    for (const std::vector<Influences>& set : primitive.influences) {
        if (set.size() != primitive.vertices.size()) {
            throw SceneError(
                fmt::format("{} influences for {} vertices", set.size(), primitive.vertices.size()));
        }
    }
    if (primitive.influences.empty()) return prepared;
    for (std::size_t i = 0; i < primitive.vertices.size(); ++i) {
        const std::size_t first = prepared.pulls.size();
        for (const std::vector<Influences>& set : primitive.influences) {
            for (int k = 0; k < 4; ++k) {
                const float weight = set[i].weights[k];
                if (!(weight >= 0.0F) || !std::isfinite(weight)) {
                    throw SceneError(fmt::format("vertex {}: a weight is negative or not finite", i));
                }
                prepared.pulls.push_back({set[i].joints[k], weight});
            }
        }
        normalise(prepared.pulls, first);
        for (std::size_t k = first; k < prepared.pulls.size(); ++k) {
            prepared.joints = std::max<std::size_t>(prepared.joints, prepared.pulls[k].joint + 1);
        }
        prepared.ends.push_back(static_cast<std::uint32_t>(prepared.pulls.size()));
    }
    return prepared;
}

std::optional<std::string> fault_of_targets(const Primitive& primitive) {
    for (std::size_t i = 0; i < primitive.targets.size(); ++i) {
        const MorphTarget& target = primitive.targets[i];
        if (!fits(target.positions, primitive) || !fits(target.normals, primitive) ||
            !fits(target.tangents, primitive)) {
            return fmt::format("morph target {} does not have as many offsets as vertices", i);
        }
    }
    return {};
}

void add_targets(const Primitive& primitive, std::span<const float> weights, std::span<Vertex> moved) {
    const std::vector<Vertex>& rest = primitive.vertices;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        moved[i].position = rest[i].position;
        moved[i].normal = rest[i].normal;
        moved[i].tangent = rest[i].tangent;
    }
    std::vector<glm::vec3> tangents;  // sums, before they are rounded
    bool turns_normals = false;
    for (std::size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
        const float weight = weights[t];
        if (weight == 0.0F) continue;
        const MorphTarget& target = primitive.targets[t];
        for (std::size_t i = 0; i < target.positions.size(); ++i) {
            moved[i].position += weight * target.positions[i];
        }
        for (std::size_t i = 0; i < target.normals.size(); ++i) {
            moved[i].normal += weight * target.normals[i];
        }
        turns_normals |= !target.normals.empty();
        if (target.tangents.empty()) continue;
        if (tangents.empty()) {
            for (const Vertex& vertex : rest) tangents.emplace_back(unpacked_tangent(vertex.tangent));
        }
        for (std::size_t i = 0; i < target.tangents.size(); ++i) {
            tangents[i] += weight * target.tangents[i];
        }
    }
    for (std::size_t i = 0; turns_normals && i < rest.size(); ++i) {
        const double length = glm::length(glm::dvec3(moved[i].normal));
        const bool has_direction = length > 0.0 && std::isfinite(length);
        moved[i].normal = has_direction ? glm::vec3(glm::dvec3(moved[i].normal) / length) : rest[i].normal;
    }
    for (std::size_t i = 0; i < tangents.size(); ++i) {
        const float length = glm::length(tangents[i]);
        if (rest[i].tangent == glm::i16vec4(0) || !(length > 0.0F) || !std::isfinite(length)) continue;
        moved[i].tangent =
            packed_tangent(glm::vec4(tangents[i] / length, rest[i].tangent.w < 0 ? -1.0F : 1.0F));
    }
}

void move_by_joints(std::span<const Vertex> rest, const PreparedInfluences& influences,
                    std::span<const AffineColumns> joints, std::span<Vertex> moved) {
    const Pull* pull = influences.pulls.data();
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const Pull* const end = influences.pulls.data() + influences.ends[i];
        const AffineColumns mean = mean_of(pull, end, joints);
        pull = end;
        const Lanes position = load(rest[i], offsetof(Vertex, position));
        const Lanes normal = load(rest[i], offsetof(Vertex, normal));
        Lanes unit = moved_normal(mean, normal);
        unit[3] = normal[3];  // not part of the normal
        store(mean.x * all(position[0]) + mean.y * all(position[1]) + mean.z * all(position[2]) +
                  mean.translation,
              moved[i], offsetof(Vertex, position));
        store(unit, moved[i], offsetof(Vertex, normal));
        if (influences.has_tangents && rest[i].tangent != glm::i16vec4(0)) {
            moved[i].tangent = moved_tangent(mean, rest[i].tangent);
        }
    }
}

}  // namespace candela
