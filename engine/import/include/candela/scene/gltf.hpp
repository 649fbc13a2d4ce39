#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/scene_error.hpp>

namespace candela {

/// What an import has added to the world.
struct ImportReport {
    std::vector<Entity> entities;       ///< all created entities, parents before their children
    std::uint64_t triangles = 0;        ///< total of all mesh instances
    std::vector<std::string> warnings;  ///< what the import has left out, one line each
};

/// Adds the default scene of a glTF 2.0 file, .gltf or .glb, to the world. Each node becomes an entity with
/// Name and Transform and, if the node has them, MeshInstance, one of the lights, and Camera. Meshes,
/// materials and images are shared between instances. Buffers and images may be embedded or in files relative
/// to this one; images are PNG or JPEG, reduced to 8 bits per channel.
///
/// Supported extensions: KHR_lights_punctual, KHR_materials_emissive_strength, KHR_materials_unlit (the
/// surface emits its base colour, without that of its vertices), KHR_texture_transform, and
/// CANDELA_environment of a scene, {"radiance": [r, g, b], "uri": "sky.hdr", "rotation": radians, "name":
/// "sky"}, which becomes an entity with an Environment (instead of "uri" it may have a "bufferView"), and
/// CANDELA_light of a light, {"castsShadow": false}. Any other extension is an error if the file requires it
/// and a warning if the file only uses it. Also left out with a warning: points and lines, skins, animations,
/// morph targets, further sets of texture coordinates and colours. Triangles without area are dropped. A node
/// with a sheared matrix, which a Transform cannot represent, becomes two entities, one the parent of the
/// other (see decompose).
///
/// Throws SceneError, whose message is one line that names the file, the object and the problem. The world is
/// then unchanged.
CANDELA_API ImportReport import_gltf(const std::filesystem::path& path, World& into);

/// The same from memory. `name` is the file's name in messages; URIs are relative to `base_directory`.
CANDELA_API ImportReport import_gltf(std::span<const unsigned char> bytes,
                                     const std::filesystem::path& base_directory, std::string_view name,
                                     World& into);

}  // namespace candela
