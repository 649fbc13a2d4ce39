#include "engine/import/gltf_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/scene_error.hpp>
#include "engine/import/decompose.hpp"
#include "engine/import/gltf_document.hpp"
#include "engine/import/gltf_instances.hpp"
#include "engine/import/gltf_lights.hpp"
#include "engine/import/naming.hpp"
#include "engine/import/unit_length.hpp"

namespace candela::gltf {

namespace {

/// A node to convert, its level in the hierarchy, and the index of its parent's entity.
struct Visit {
    int node;
    std::uint64_t level;
    std::optional<std::size_t> parent;
};

const Json& children_of(const Document& document, int node) {
    return list_in(document.at("nodes", node), "children");
}

/// The parent of each node; -1 for a root.
std::vector<int> find_parents(const Document& document) {
    std::vector<int> parents(document.all("nodes").size(), -1);
    for (int node = 0; node < static_cast<int>(parents.size()); ++node) {
        for (const Json& child : children_of(document, node)) {
            int& parent = parents[child.get<std::size_t>()];
            if (parent >= 0) {
                throw SceneError(
                    fmt::format("node {} has two parents, nodes {} and {}", child.get<int>(), parent, node));
            }
            parent = node;
        }
    }
    return parents;
}

/// All nodes, parents before their children.
std::vector<int> from_the_top(const Document& document, const std::vector<int>& parents) {
    std::vector<int> order;
    for (int node = 0; node < static_cast<int>(parents.size()); ++node) {
        if (parents[static_cast<std::size_t>(node)] < 0) order.push_back(node);
    }
    std::vector<bool> found(parents.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        found[static_cast<std::size_t>(order[i])] = true;
        for (const Json& child : children_of(document, order[i])) order.push_back(child.get<int>());
    }
    if (const auto lost = std::ranges::find(found, false); lost != found.end()) {
        throw SceneError(fmt::format("node {} is its own ancestor or has one that is", lost - found.begin()));
    }
    return order;
}

/// The roots of the scene, each once. Some files list nodes that are below others, too. Such a node belongs
/// to the scene anyway if the scene lists an ancestor; else it is a root, without its ancestors.
std::vector<int> roots_of_scene(Document& document) {
    const std::vector<int> parents = find_parents(document);
    const Json& listed = list_in(default_scene(document), "nodes");
    std::vector<bool> is_listed(parents.size(), false);
    for (const Json& node : listed) is_listed[node.get<std::size_t>()] = true;
    std::vector<bool> is_there(parents.size(), false);  // by an ancestor, or because it was added
    for (const int node : from_the_top(document, parents)) {
        const int parent = parents[static_cast<std::size_t>(node)];
        if (parent < 0) continue;
        const auto p = static_cast<std::size_t>(parent);
        is_there[static_cast<std::size_t>(node)] = is_there[p] || is_listed[p];
    }
    std::vector<int> roots;
    bool is_odd = false;
    for (const Json& node : listed) {
        const auto i = node.get<std::size_t>();
        is_odd = is_odd || is_there[i] || parents[i] >= 0;
        if (is_there[i]) continue;
        is_there[i] = true;
        roots.push_back(node.get<int>());
    }
    if (is_odd) {
        document.warnings.emplace_back(
            "the scene lists nodes twice, or nodes below others, as its roots; each is there once");
    }
    return roots;
}

bool is_finite(const Transform& transform) {
    const auto finite = [](float x) { return std::isfinite(x); };
    for (int i = 0; i < 3; ++i) {
        if (!finite(transform.translation[i]) || !finite(transform.scale[i])) return false;
    }
    return finite(transform.rotation.w) && finite(transform.rotation.x) && finite(transform.rotation.y) &&
           finite(transform.rotation.z);
}

std::vector<Transform> read_matrix(const Json& numbers) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) {
        matrix[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)].get<double>();
    }
    if (matrix[0][3] != 0.0 || matrix[1][3] != 0.0 || matrix[2][3] != 0.0 || matrix[3][3] != 1.0) {
        throw SceneError("its matrix does not end in a row of 0 0 0 1");
    }
    return decompose(matrix);
}

Transform read_translation_rotation_scale(const Json& node) {
    Transform transform;
    transform.translation = vector_in(node, "translation", transform.translation);
    transform.scale = vector_in(node, "scale", transform.scale);
    transform.rotation = unit_rotation(vector_in(node, "rotation", glm::dvec4(0.0, 0.0, 0.0, 1.0)));
    return transform;
}

/// Outermost first; more than one if the node is sheared.
std::vector<Transform> read_transforms(const Json& node) {
    const Json& matrix = list_in(node, "matrix");
    std::vector<Transform> transforms =
        matrix.empty() ? std::vector{read_translation_rotation_scale(node)} : read_matrix(matrix);
    if (!std::ranges::all_of(transforms, is_finite)) throw SceneError("its transform overflows");
    return transforms;
}

Camera read_camera(const Json& source, int index) {
    constexpr float endless = std::numeric_limits<float>::infinity();
    const bool is_perspective = source.at("type") == "perspective";
    const Json& lens = source.at(source.at("type").get<std::string>());
    Camera camera;
    camera.near_plane = value_in(lens, "znear", 0.0F);
    camera.far_plane = value_in(lens, "zfar", endless);
    if (camera.far_plane <= camera.near_plane) {
        throw SceneError(fmt::format("camera {}: its zfar of {} is not beyond its znear of {}", index,
                                     camera.far_plane, camera.near_plane));
    }
    if (is_perspective) {
        camera.vertical_fov = value_in(lens, "yfov", 0.0F);
    } else {
        camera.projection = Camera::Projection::orthographic;
        camera.half_height = value_in(lens, "ymag", 0.0F);
    }
    return camera;
}

/// Index of the node's light; -1 for none.
int light_of(const Json& node) {
    return index_in(node, "extensions.KHR_lights_punctual.light");
}

constexpr std::string_view all_lights = "extensions.KHR_lights_punctual.lights";

std::string name_of(const Document& document, int index) {
    const Json& node = document.at("nodes", index);
    if (const Json* const name = find_member(node, "name")) return *name;
    const auto name_in = [&](std::string_view list, int i) {
        return i < 0 ? std::string() : text_in(document.at(list, i), "name");
    };
    for (std::string name :
         {name_in("cameras", index_in(node, "camera")), name_in(all_lights, light_of(node)),
          name_in("meshes", index_in(node, "mesh"))}) {
        if (!name.empty()) return name;
    }
    return fmt::format("node {}", index);
}

/// Adds the node's mesh, camera and light to its (innermost) entity.
void equip(StagedEntity& entity, const Document& document, const Json& node) {
    entity.is_node = true;
    entity.mesh = index_in(node, "mesh");
    entity.skin = index_in(node, "skin");
    if (const int camera = index_in(node, "camera"); camera >= 0) {
        entity.camera = read_camera(document.at("cameras", camera), camera);
    }
    if (const int light = light_of(node); light >= 0) {
        entity.light = read_light(document.at(all_lights, light), light);
    }
}

/// Replaces the mesh of the last entity, which is the node's, by an entity for each instance. Returns how
/// many there are. `before` nodes and instances have been counted.
std::size_t add_instances(std::vector<StagedEntity>& entities, const Document& document, const Json& node,
                          std::uint64_t before, ImportBudget& budget) {
    const std::size_t count = entities.back().mesh < 0 ? 0 : count_instances(document, node);
    if (count == 0) return 0;
    const StagedEntity whole = entities.back();
    const std::size_t parent = entities.size() - 1;
    budget.check_nodes(before + count);
    // Beside the entity, its transform and what this is read from.
    budget.add_memory(count * (sizeof(StagedEntity) + whole.name.size() + 2 * sizeof(Transform)));
    entities.back().mesh = -1;
    for (const Transform& transform : read_instances(document, node, count)) {
        StagedEntity& instance = entities.emplace_back();
        instance.parent = parent;
        instance.name = whole.name;
        instance.node = whole.node;
        instance.transform = transform;
        instance.mesh = whole.mesh;
    }
    return count;
}

}  // namespace

glm::quat unit_rotation(const glm::dvec4& parts) {
    const glm::dquat rotation(parts.w, parts.x, parts.y, parts.z);
    const double length = glm::length(rotation);
    if (length == 0.0) throw SceneError("its rotation is zero");
    return glm::quat(is_unit_length(length) ? rotation : rotation / length);
}

const Json& default_scene(const Document& document) {
    if (document.all("scenes").empty()) throw SceneError("it has no scene");
    return document.at("scenes", value_in(document.json, "scene", 0));
}

std::vector<StagedEntity> read_nodes(Document& document, ImportBudget& budget, const Progress& progress) {
    const std::vector<int> roots = roots_of_scene(document);
    std::vector<StagedEntity> entities;
    std::vector<Visit> ahead;  // the next one last
    std::uint64_t counted = document.all("nodes").size();
    for (std::size_t i = roots.size(); i-- > 0;) {
        ahead.push_back({roots[i], 1, {}});
    }
    while (!ahead.empty()) {
        auto [node, level, parent] = ahead.back();
        ahead.pop_back();
        budget.check_depth(level);
        if (entities.size() % 4096 == 0) {
            progress("reading nodes", entities.size(), document.all("nodes").size());
        }
        const Json& json = document.at("nodes", node);
        for (const Transform& transform :
             naming(fmt::format("node {}", node), [&] { return read_transforms(json); })) {
            StagedEntity& entity = entities.emplace_back();
            entity.parent = parent;
            entity.name = name_of(document, node);
            entity.node = node;
            entity.transform = transform;
            parent = entities.size() - 1;
        }
        equip(entities.back(), document, json);
        counted += naming(fmt::format("node {}", node),
                          [&] { return add_instances(entities, document, json, counted, budget); });
        const Json& children = children_of(document, node);
        for (std::size_t i = children.size(); i-- > 0;) {
            ahead.push_back({children[i].get<int>(), level + 1, parent});
        }
    }
    return entities;
}

}  // namespace candela::gltf
