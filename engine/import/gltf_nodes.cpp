#include "engine/import/gltf_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/scene_error.hpp>
#include "engine/import/decompose.hpp"
#include "engine/import/gltf_document.hpp"
#include "engine/import/unit_length.hpp"

namespace candela::gltf {

namespace {

constexpr float half_pi = 1.57079632679489662F;

/// A node to convert, and the index of its parent's entity.
struct Visit {
    int node;
    std::optional<std::size_t> parent;
};

const tinygltf::Node& node_at(const tinygltf::Model& model, int index) {
    return model.nodes[static_cast<std::size_t>(index)];
}

/// The parent of each node; -1 for a root.
std::vector<int> find_parents(const tinygltf::Model& model) {
    std::vector<int> parents(model.nodes.size(), -1);
    for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node) {
        for (const int child : node_at(model, node).children) {
            int& parent = parents[static_cast<std::size_t>(child)];
            if (parent >= 0) {
                throw SceneError(
                    fmt::format("node {} has two parents, nodes {} and {}", child, parent, node));
            }
            parent = node;
        }
    }
    return parents;
}

/// Checks that every node is a root or below one, and that the scene lists only roots, each once.
void check_hierarchy(const tinygltf::Model& model) {
    const std::vector<int> parents = find_parents(model);
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
        std::ranges::copy(node_at(model, node).children, std::back_inserter(reached));
    }
    if (const auto lost = std::ranges::find(below_a_root, false); lost != below_a_root.end()) {
        throw SceneError(
            fmt::format("node {} is its own ancestor or has one that is", lost - below_a_root.begin()));
    }

    std::vector<bool> listed(parents.size(), false);
    for (const int node : default_scene(model).nodes) {
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
void assign(Vector& vector, const std::vector<double>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        vector[static_cast<typename Vector::length_type>(i)] = static_cast<float>(numbers[i]);
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

std::vector<Transform> read_matrix(const std::vector<double>& numbers) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) {
        matrix[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)];
    }
    if (matrix[0][3] != 0.0 || matrix[1][3] != 0.0 || matrix[2][3] != 0.0 || matrix[3][3] != 1.0) {
        throw SceneError("its matrix does not end in a row of 0 0 0 1");
    }
    return decompose(matrix);
}

Transform read_translation_rotation_scale(const tinygltf::Node& node) {
    Transform transform;
    assign(transform.translation, node.translation);
    assign(transform.scale, node.scale);
    if (node.rotation.empty()) {
        return transform;
    }
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(rotation);
    if (length == 0.0) {
        throw SceneError("its rotation is zero");
    }
    transform.rotation = glm::quat(is_unit_length(length) ? rotation : rotation / length);
    return transform;
}

/// Outermost first; more than one if the node is sheared.
std::vector<Transform> read_transforms(const tinygltf::Node& node, int index) {
    try {
        std::vector<Transform> transforms = node.matrix.empty()
                                                ? std::vector{read_translation_rotation_scale(node)}
                                                : read_matrix(node.matrix);
        if (!std::ranges::all_of(transforms, is_finite)) {
            throw SceneError("its transform overflows");
        }
        return transforms;
    } catch (const SceneError& error) {
        throw SceneError(fmt::format("node {}: {}", index, error.what()));
    }
}

Camera read_camera(const tinygltf::Camera& source, int index) {
    const bool perspective = source.type == "perspective";
    const double far_plane = perspective ? source.perspective.zfar : source.orthographic.zfar;
    const bool endless = perspective && far_plane == 0.0;  // TinyGLTF's value if there is no zfar
    Camera camera;
    camera.near_plane =
        static_cast<float>(perspective ? source.perspective.znear : source.orthographic.znear);
    camera.far_plane = endless ? std::numeric_limits<float>::infinity() : static_cast<float>(far_plane);
    if (camera.far_plane <= camera.near_plane) {
        throw SceneError(fmt::format("camera {}: its zfar of {} is not beyond its znear of {}", index,
                                     camera.far_plane, camera.near_plane));
    }
    if (perspective) {
        camera.vertical_fov = static_cast<float>(source.perspective.yfov);
    } else {
        camera.projection = Camera::Projection::orthographic;
        camera.half_height = static_cast<float>(source.orthographic.ymag);
    }
    return camera;
}

SpotLight read_cones(const tinygltf::SpotLight& source, int index) {
    SpotLight light;
    light.inner_cone = static_cast<float>(source.innerConeAngle);
    light.outer_cone = std::min(static_cast<float>(source.outerConeAngle), half_pi);
    if (light.inner_cone >= light.outer_cone) {
        throw SceneError(fmt::format("light {}: its inner cone of {} is not inside its outer cone of {}",
                                     index, light.inner_cone, light.outer_cone));
    }
    return light;
}

bool casts_shadow(const tinygltf::Light& source) {
    const auto extension = source.extensions.find(light_extension);
    return extension == source.extensions.end() || !extension->second.Has("castsShadow") ||
           extension->second.Get("castsShadow").Get<bool>();
}

decltype(StagedEntity::light) read_light(const tinygltf::Light& source, int index) {
    glm::vec3 colour(1.0F);
    assign(colour, source.color);
    const auto intensity = static_cast<float>(source.intensity);
    const float range =
        source.range > 0.0 ? static_cast<float>(source.range) : std::numeric_limits<float>::infinity();

    if (source.type == "directional") {
        return DirectionalLight{colour, intensity, casts_shadow(source)};
    }
    if (source.type == "point") {
        return PointLight{colour, intensity, range, casts_shadow(source)};
    }
    if (source.type != "spot") {
        throw SceneError(fmt::format("light {} has the unknown type \"{}\"", index, source.type));
    }
    SpotLight light = read_cones(source.spot, index);
    light.colour = colour;
    light.intensity = intensity;
    light.range = range;
    light.casts_shadow = casts_shadow(source);
    return light;
}

/// Index of the node's light; -1 for none.
int light_of(const tinygltf::Node& node) {
    const auto extension = node.extensions.find(lights_extension);
    return extension == node.extensions.end() ? -1 : extension->second.Get("light").GetNumberAsInt();
}

std::string name_of(const Document& document, int index) {
    const tinygltf::Model& model = document.model;
    const tinygltf::Node& node = node_at(model, index);
    if (document.node_has_name[static_cast<std::size_t>(index)]) {
        return node.name;
    }
    const auto name_in = [](const auto& list, int i) {
        return i < 0 ? std::string() : list[static_cast<std::size_t>(i)].name;
    };
    for (std::string name : {name_in(model.cameras, node.camera), name_in(model.lights, light_of(node)),
                             name_in(model.meshes, node.mesh)}) {
        if (!name.empty()) {
            return name;
        }
    }
    return fmt::format("node {}", index);
}

/// Adds the node's mesh, camera and light to its (innermost) entity.
void equip(StagedEntity& entity, const tinygltf::Model& model, int index,
           const std::vector<std::shared_ptr<const Mesh>>& meshes) {
    const tinygltf::Node& node = node_at(model, index);
    if (node.mesh >= 0) {
        entity.mesh = meshes[static_cast<std::size_t>(node.mesh)];
    }
    if (node.camera >= 0) {
        entity.camera = read_camera(model.cameras[static_cast<std::size_t>(node.camera)], node.camera);
    }
    if (const int light = light_of(node); light >= 0) {
        entity.light = read_light(model.lights[static_cast<std::size_t>(light)], light);
    }
}

/// Pushes the nodes onto the stack `ahead` so that the first of them is visited next.
void put_ahead(const std::vector<int>& nodes, std::optional<std::size_t> parent, std::vector<Visit>& ahead) {
    std::for_each(nodes.rbegin(), nodes.rend(), [&](int node) { ahead.push_back({node, parent}); });
}

}  // namespace

const tinygltf::Scene& default_scene(const tinygltf::Model& model) {
    if (model.scenes.empty()) {
        throw SceneError("it has no scene");
    }
    return model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))];
}

std::vector<StagedEntity> read_nodes(const Document& document,
                                     const std::vector<std::shared_ptr<const Mesh>>& meshes) {
    const tinygltf::Model& model = document.model;
    check_hierarchy(model);
    std::vector<StagedEntity> entities;
    std::vector<Visit> ahead;
    put_ahead(default_scene(model).nodes, {}, ahead);
    while (!ahead.empty()) {
        auto [node, parent] = ahead.back();
        ahead.pop_back();
        for (const Transform& transform : read_transforms(node_at(model, node), node)) {
            StagedEntity& entity = entities.emplace_back();
            entity.parent = parent;
            entity.name = name_of(document, node);
            entity.transform = transform;
            parent = entities.size() - 1;
        }
        equip(entities.back(), model, node, meshes);
        put_ahead(node_at(model, node).children, parent, ahead);
    }
    return entities;
}

}  // namespace candela::gltf
