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
#include "engine/import/unit_length.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

constexpr float half_pi = 1.57079632679489662F;

/// A node to convert, its level in the hierarchy, and the index of its parent's entity.
struct Visit {
    int node;
    std::uint64_t level;
    std::optional<std::size_t> parent;
};

const Json& node_at(const Document& document, int index) {
    return document.nodes[static_cast<std::size_t>(index)];
}

/// Empty if the node has no such member.
const Json& array_of(const Json& node, const char* member) {
    static const Json none = Json::array();
    const Json* const found = node.find(member);
    return found ? *found : none;
}

const Json& children_of(const Document& document, int node) {
    return array_of(node_at(document, node), "children");
}

/// The parent of each node; -1 for a root.
std::vector<int> find_parents(const Document& document) {
    std::vector<int> parents(document.nodes.size(), -1);
    for (int node = 0; node < static_cast<int>(parents.size()); ++node) {
        for (const Json& child : children_of(document, node).items()) {
            int& parent = parents[child.whole<std::size_t>()];
            if (parent >= 0) {
                throw SceneError(fmt::format("node {} has two parents, nodes {} and {}", child.whole<int>(),
                                             parent, node));
            }
            parent = node;
        }
    }
    return parents;
}

/// Checks that every node is a root or below one, and that the scene lists only roots, each once.
void check_hierarchy(const Document& document) {
    const std::vector<int> parents = find_parents(document);
    std::vector<int> reached;
    for (int node = 0; node < static_cast<int>(parents.size()); ++node) {
        if (parents[static_cast<std::size_t>(node)] < 0) {
            reached.push_back(node);
        }
    }
    std::vector<bool> below_a_root(parents.size(), false);
    while (!reached.empty()) {
        const int node = reached.back();
        reached.pop_back();
        below_a_root[static_cast<std::size_t>(node)] = true;
        for (const Json& child : children_of(document, node).items()) {
            reached.push_back(child.whole<int>());
        }
    }
    if (const auto lost = std::ranges::find(below_a_root, false); lost != below_a_root.end()) {
        throw SceneError(
            fmt::format("node {} is its own ancestor or has one that is", lost - below_a_root.begin()));
    }

    std::vector<bool> listed(parents.size(), false);
    for (const int node : default_scene(document.model).nodes) {
        const auto i = static_cast<std::size_t>(node);
        if (parents[i] >= 0) {
            throw SceneError(fmt::format("node {} is a root of the scene but has a parent", node));
        }
        if (listed[i]) {
            throw SceneError(fmt::format("node {} is a root of the scene twice", node));
        }
        listed[i] = true;
    }
}

template <class Vector>
void assign(Vector& vector, const Json& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        vector[static_cast<typename Vector::length_type>(i)] = static_cast<float>(numbers[i].number());
    }
}

bool is_finite(const Transform& transform) {
    const auto finite = [](float x) { return std::isfinite(x); };
    for (int i = 0; i < 3; ++i) {
        if (!finite(transform.translation[i]) || !finite(transform.scale[i])) {
            return false;
        }
    }
    return finite(transform.rotation.w) && finite(transform.rotation.x) && finite(transform.rotation.y) &&
           finite(transform.rotation.z);
}

std::vector<Transform> read_matrix(const Json& numbers) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) {
        matrix[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)].number();
    }
    if (matrix[0][3] != 0.0 || matrix[1][3] != 0.0 || matrix[2][3] != 0.0 || matrix[3][3] != 1.0) {
        throw SceneError("its matrix does not end in a row of 0 0 0 1");
    }
    return decompose(matrix);
}

Transform read_translation_rotation_scale(const Json& node) {
    Transform transform;
    assign(transform.translation, array_of(node, "translation"));
    assign(transform.scale, array_of(node, "scale"));
    const Json& numbers = array_of(node, "rotation");
    if (numbers.empty()) {
        return transform;
    }
    const auto part = [&](std::size_t i) { return numbers[i].number(); };
    const glm::dquat rotation(part(3), part(0), part(1), part(2));
    const double length = glm::length(rotation);
    if (length == 0.0) {
        throw SceneError("its rotation is zero");
    }
    transform.rotation = glm::quat(is_unit_length(length) ? rotation : rotation / length);
    return transform;
}

/// Outermost first; more than one if the node is sheared.
std::vector<Transform> read_transforms(const Json& node, int index) {
    try {
        const Json& matrix = array_of(node, "matrix");
        std::vector<Transform> transforms =
            matrix.empty() ? std::vector{read_translation_rotation_scale(node)} : read_matrix(matrix);
        if (!std::ranges::all_of(transforms, is_finite)) {
            throw SceneError("its transform overflows");
        }
        return transforms;
    } catch (const SceneError& error) {
        throw SceneError(fmt::format("node {}: {}", index, error.what()));
    }
}

Camera read_camera(const CameraSource& source, int index) {
    const bool endless = source.is_perspective && source.far_plane == 0.0;
    Camera camera;
    camera.near_plane = static_cast<float>(source.near_plane);
    camera.far_plane =
        endless ? std::numeric_limits<float>::infinity() : static_cast<float>(source.far_plane);
    if (camera.far_plane <= camera.near_plane) {
        throw SceneError(fmt::format("camera {}: its zfar of {} is not beyond its znear of {}", index,
                                     camera.far_plane, camera.near_plane));
    }
    if (source.is_perspective) {
        camera.vertical_fov = static_cast<float>(source.vertical_fov);
    } else {
        camera.projection = Camera::Projection::orthographic;
        camera.half_height = static_cast<float>(source.half_height);
    }
    return camera;
}

SpotLight read_cones(const LightSource& source, int index) {
    SpotLight light;
    light.inner_cone = static_cast<float>(source.inner_cone);
    light.outer_cone = std::min(static_cast<float>(source.outer_cone), half_pi);
    if (light.inner_cone >= light.outer_cone) {
        throw SceneError(fmt::format("light {}: its inner cone of {} is not inside its outer cone of {}",
                                     index, light.inner_cone, light.outer_cone));
    }
    return light;
}

decltype(StagedEntity::light) read_light(const LightSource& source, int index) {
    glm::vec3 colour(1.0F);
    for (std::size_t i = 0; i < source.colour.size(); ++i) {
        colour[static_cast<glm::length_t>(i)] = static_cast<float>(source.colour[i]);
    }
    const auto intensity = static_cast<float>(source.intensity);
    const float range =
        source.range > 0.0 ? static_cast<float>(source.range) : std::numeric_limits<float>::infinity();

    if (source.type == "directional") {
        return DirectionalLight{colour, intensity, source.casts_shadow};
    }
    if (source.type == "point") {
        return PointLight{colour, intensity, range, source.casts_shadow};
    }
    if (source.type != "spot") {
        throw SceneError(fmt::format("light {} has the unknown type \"{}\"", index, readable(source.type)));
    }
    SpotLight light = read_cones(source, index);
    light.colour = colour;
    light.intensity = intensity;
    light.range = range;
    light.casts_shadow = source.casts_shadow;
    return light;
}

/// An index that the node holds; -1 for none.
int index_of(const Json& node, std::string_view path) {
    const Json* const index = node.find_path(path);
    return index ? index->whole<int>() : -1;
}

/// Index of the node's light; -1 for none.
int light_of(const Json& node) {
    return index_of(node, "extensions/KHR_lights_punctual/light");
}

std::string name_of(const Document& document, int index) {
    const Json& node = node_at(document, index);
    if (const Json* const name = node.find("name")) {
        return name->text();
    }
    const auto name_in = [](const auto& list, int i) {
        return i < 0 ? std::string() : list[static_cast<std::size_t>(i)].name;
    };
    const Model& model = document.model;
    for (std::string name :
         {name_in(model.cameras, index_of(node, "camera")), name_in(model.lights, light_of(node)),
          name_in(model.meshes, index_of(node, "mesh"))}) {
        if (!name.empty()) {
            return name;
        }
    }
    return fmt::format("node {}", index);
}

/// Adds the node's mesh, camera and light to its (innermost) entity.
void equip(StagedEntity& entity, const Document& document, const Json& node) {
    const Model& model = document.model;
    entity.mesh = index_of(node, "mesh");
    if (const int camera = index_of(node, "camera"); camera >= 0) {
        entity.camera = read_camera(model.cameras[static_cast<std::size_t>(camera)], camera);
    }
    if (const int light = light_of(node); light >= 0) {
        entity.light = read_light(model.lights[static_cast<std::size_t>(light)], light);
    }
}

}  // namespace

const SceneSource& default_scene(const Model& model) {
    if (model.scenes.empty()) {
        throw SceneError("it has no scene");
    }
    return model.scenes[static_cast<std::size_t>(std::max(model.default_scene, 0))];
}

std::vector<StagedEntity> read_nodes(const Document& document, ImportBudget& budget,
                                     const Progress& progress) {
    check_hierarchy(document);
    std::vector<StagedEntity> entities;
    std::vector<Visit> ahead;  // the next one last
    const std::vector<int>& roots = default_scene(document.model).nodes;
    std::for_each(roots.rbegin(), roots.rend(), [&](int node) { ahead.push_back({node, 1, {}}); });
    while (!ahead.empty()) {
        auto [node, level, parent] = ahead.back();
        ahead.pop_back();
        budget.check_depth(level);
        if (entities.size() % 4096 == 0) {
            progress("reading nodes", entities.size(), document.nodes.size());
        }
        for (const Transform& transform : read_transforms(node_at(document, node), node)) {
            StagedEntity& entity = entities.emplace_back();
            entity.parent = parent;
            entity.name = name_of(document, node);
            entity.transform = transform;
            parent = entities.size() - 1;
        }
        equip(entities.back(), document, node_at(document, node));
        const Json& children = children_of(document, node);
        for (std::size_t i = children.size(); i-- > 0;) {
            ahead.push_back({children[i].whole<int>(), level + 1, parent});
        }
    }
    return entities;
}

}  // namespace candela::gltf
