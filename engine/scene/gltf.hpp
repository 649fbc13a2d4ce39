#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/ecs/world.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/scene_error.hpp"

namespace candela {

/// What an import brought into the world.
struct ImportReport {
    std::vector<Entity> entities;       ///< all that were created, parents before their children
    std::uint64_t triangles = 0;        ///< of all mesh instances together
    std::vector<std::string> warnings;  ///< what the file has and the import leaves out, a line each
};

/// Adds the default scene of a glTF 2.0 file, .gltf or .glb, to the world: an entity with Name and Transform
/// for each node and, where the node has them, MeshInstance, one of the lights, Camera. Meshes, materials and
/// images are shared between instances. Buffers and images may be embedded or lie in files relative to this
/// one; images are PNG or JPEG, reduced to 8 bits a channel.
///
/// Of the extensions KHR_lights_punctual is supported. Another one that the file requires is an error; one
/// that it merely uses is a warning, as are points and lines, skins, animations, morph targets, vertex
/// colours and base colours that read a second set of texture coordinates. Triangles without
/// area are dropped. A matrix with shear, which no Transform can hold, becomes two entities, one the parent
/// of the other (see decompose).
///
/// Throws SceneError, whose one line names the file, the object and the fault; the world is then as it was.
ImportReport import_gltf(const std::filesystem::path& path, World& into);

/// The same from memory. `name` stands for the file in messages; relative URIs start from `base_directory`.
ImportReport import_gltf(std::span<const unsigned char> bytes, const std::filesystem::path& base_directory,
                         std::string_view name, World& into);

}  // namespace candela
