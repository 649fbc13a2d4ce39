#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <candela/scene/components.hpp>
#include "engine/import/gltf_document.hpp"
#include "engine/import/progress.hpp"

namespace candela::gltf {

/// An entity to create: its components, with `parent` as an index into the list that contains it.
struct StagedEntity {
    std::optional<std::size_t> parent;
    std::string name;
    Transform transform;  ///< `parent` is null
    int node = -1;        ///< that it comes from, by index
    bool is_node =
        false;      ///< its local space is the node's: it is no instance and not the upper of two entities
    int mesh = -1;  ///< index into the document's meshes; -1 for none
    int skin = -1;  ///< index into the document's skins; -1 for none
    std::optional<AnyLight> light;
    std::optional<Camera> camera;
};

/// The rotation of (x, y, z, w), normalised. Throws SceneError if all are 0.
[[nodiscard]] glm::quat unit_rotation(const glm::dvec4& parts);

/// The scene that the file names as default, else its first. Throws SceneError if there is none.
[[nodiscard]] const Json& default_scene(const Document& document);

/// The nodes of the default scene (the first scene if no default is given), parents before children, siblings
/// in the file's order. A sheared node makes two entities with its name, the first the parent of the second
/// (see decompose). A node that the file does not name gets the name of its camera, light or mesh, or else
/// `node N`. Of a node with instances (EXT_mesh_gpu_instancing), each becomes an entity below the node's,
/// with its name and its mesh, which the node's entity then does not have. Throws SceneError, which names the
/// node, camera or light and the problem, such as two parents, a cycle or no scene.
[[nodiscard]] std::vector<StagedEntity> read_nodes(Document& document, ImportBudget& budget,
                                                   const Progress& progress);

}  // namespace candela::gltf
