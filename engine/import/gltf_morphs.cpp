#include "engine/import/gltf_morphs.hpp"

#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <candela/scene/scene_error.hpp>

namespace candela::gltf {

namespace {

/// An attribute of a morph target; empty if it does not have it.
std::vector<glm::vec3> read_offsets(const Document& document, const Json& primitive, const Json& target,
                                    const char* name, const Selection& selection, ImportBudget& budget,
                                    const Use& use) {
    const int accessor = index_in(target, name);
    if (accessor < 0) return {};
    check_count(document, primitive, accessor, "offsets in a morph target");
    budget.add_memory(selection.count() * sizeof(glm::vec3));
    return read_reals<glm::vec3>(document, accessor, selection, use);
}

}  // namespace

std::size_t count_targets(const Json& mesh) {
    std::optional<std::size_t> targets;
    for (const Json& primitive : mesh.at("primitives")) {
        const std::size_t count = list_in(primitive, "targets").size();
        if (targets.value_or(count) != count) {
            throw SceneError(fmt::format("its primitives have {} and {} morph targets", *targets, count));
        }
        targets = count;
    }
    return targets.value_or(0);
}

std::vector<float> read_morph_weights(const Json& object, std::size_t targets,
                                      const std::vector<float>& otherwise) {
    const Json& source = list_in(object, "weights");
    if (source.empty()) return otherwise;
    if (source.size() != targets) {
        throw SceneError(fmt::format("it has {} weights for {} morph targets", source.size(), targets));
    }
    return source.get<std::vector<float>>();
}

std::vector<MorphTarget> read_targets(const Document& document, const Json& primitive, bool with_tangents,
                                      const Selection& selection, ImportBudget& budget) {
    const Json& sources = list_in(primitive, "targets");
    budget.add_memory(sources.size() * sizeof(MorphTarget));
    std::vector<MorphTarget> targets;
    targets.reserve(sources.size());
    const bool with_normals = index_in(primitive, "attributes.NORMAL") >= 0;
    for (const Json& source : sources) {
        const auto read = [&](const char* name, const Use& use) {
            return read_offsets(document, primitive, source, name, selection, budget, use);
        };
        MorphTarget& target = targets.emplace_back();
        target.positions = read("POSITION", uses::positions);
        if (with_normals) target.normals = read("NORMAL", uses::normals);
        if (with_tangents) target.tangents = read("TANGENT", uses::normals);
    }
    return targets;
}

void set_face_normal_offsets(const std::vector<Vertex>& vertices,
                             std::span<const std::array<std::uint32_t, 3>> triangles, MorphTarget& target) {
    if (target.positions.empty()) return;
    target.normals.assign(vertices.size(), glm::vec3(0.0F));
    for (const std::array<std::uint32_t, 3>& corners : triangles) {
        const auto moved = [&](std::size_t i) {
            return glm::dvec3(vertices[corners[i]].position) + glm::dvec3(target.positions[corners[i]]);
        };
        const glm::dvec3 normal = glm::cross(moved(1) - moved(0), moved(2) - moved(0));
        const double length = glm::length(normal);
        if (!(length > 0.0)) continue;
        for (const std::uint32_t corner : corners) {
            target.normals[corner] = glm::vec3(normal / length - glm::dvec3(vertices[corner].normal));
        }
    }
}

}  // namespace candela::gltf
