#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
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

/// Upper limits of an import, so that a small hostile file cannot use up memory or time. What exceeds one is
/// refused before memory is allocated for it, with a message that names the limit.
struct ImportLimits {
    std::uint64_t bytes = std::uint64_t{2} << 30U;  ///< of all files together, the scene's own included
    /// Memory for everything but pixels, as a multiple of the bytes of all files. 64 MiB are always allowed.
    std::uint64_t growth = 32;
    std::uint64_t image_pixels = std::uint64_t{1} << 26U;  ///< of one image, or of the picture of the sky
    std::uint64_t pixels = std::uint64_t{1} << 28U;        ///< of all of them; each image is decoded once
    std::uint64_t nodes = std::uint64_t{1} << 22U;         ///< of the document, with their instances
    std::uint64_t depth = std::uint64_t{1} << 20U;         ///< levels of the hierarchy of nodes
    std::uint64_t triangles = std::uint64_t{1} << 24U;     ///< of all meshes; instances do not count
};

/// How far an import is.
struct ImportProgress {
    std::string_view doing;  ///< for example "reading meshes"; has static storage duration
    double share = 0.0;      ///< of that which is done, from 0 to 1
};

/// Thrown by an import whose `progress` has asked it to stop. The world is unchanged.
class CANDELA_API ImportCancelled : public Error {
 public:
    using Error::Error;
};

struct ImportOptions {
    ImportLimits limits;
    /// Only files in this folder, or below it, are read; links are followed first. Empty: the folder of the
    /// scene's file. "/" allows all files.
    std::filesystem::path root;
    /// Called between parts of the work, on the same thread. If it returns false, the import ends with
    /// ImportCancelled.
    std::function<bool(const ImportProgress&)> progress;
};

/// Adds the default scene of a glTF 2.0 file, .gltf or .glb, to the world. Each node becomes an entity with
/// Name and Transform and, if the node has them, MeshInstance, one of the lights, and Camera. Meshes,
/// materials and images are shared between instances. Buffers and images may be embedded or in files relative
/// to this one, within `options.root`; images are PNG, JPEG or (if Candela was built with libwebp) WebP,
/// reduced to 8 bits per channel. Meshes, materials and images that the scene does not use are not read.
/// Tangents that a normal texture needs and the file lacks are derived, as are all of a primitive whose
/// normal texture is transformed.
///
/// The textures of a material may have two kinds of coordinates: sets of the file, each with its
/// KHR_texture_transform, which are applied here. The first, that of the base colour if it has a texture,
/// becomes Vertex::uv, the second Primitive::second_uvs. A texture of a third kind is a warning, and is
/// placed like one of the others.
///
/// What moves (see animation.hpp): nodes with a mesh and a skin get a Skin, and, if the mesh has morph
/// targets, MorphWeights. They also get a DeformedMesh, the shape that the nodes of the file give them, so
/// that a host which never moves them shows them as they are. Vertices without weights follow their first
/// joint; offsets of tangents are read with the file's tangents, and of a mesh without normals, each target
/// gets those of its faces. If animations move something of the scene, the last entity but that of an
/// environment, called "animations", has an AnimationPlayer with all of them, which plays the first from its
/// start, again and again, when the host calls advance_animations of animate.hpp.
///
/// Supported extensions:
/// - KHR_lights_punctual
/// - KHR_materials_emissive_strength, KHR_materials_ior, KHR_materials_specular without its textures
/// - KHR_materials_transmission as thin glass, its texture approximated by the factor
/// - KHR_materials_unlit: the surface emits its base colour, without that of its vertices
/// - KHR_materials_variants: the default materials are read
/// - KHR_texture_transform
/// - KHR_texture_basisu: the fallback is read
/// - EXT_texture_webp, if Candela was built with libwebp; else the fallback is read
/// - KHR_mesh_quantization
/// - EXT_meshopt_compression and KHR_draco_mesh_compression, if Candela was built with meshoptimizer and
/// Draco
/// - EXT_mesh_gpu_instancing: each instance becomes an entity below that of its node
/// - CANDELA_environment of a scene, {"radiance": [r, g, b], "uri": "sky.hdr", "rotation": radians, "name":
///   "sky"}: becomes an entity with an Environment. Instead of "uri" it may have a "bufferView".
/// - CANDELA_light of a light, {"castsShadow": false}
///
/// KHR_materials_anisotropy, _clearcoat, _diffuse_transmission, _dispersion, _iridescence, _sheen and _volume
/// are left out with a warning: surfaces look like their base layer.
///
/// Any other extension is a warning, also if the file requires it; primitives whose positions or indices it
/// holds are skipped. Also left out with a warning: points and lines, further sets of colours, skins with
/// joints outside of the scene or of instances, and what animates no node of the scene, a node with a matrix,
/// or another value than a translation, rotation, scale or weight. A figure that cannot be deformed keeps the
/// shape of its mesh, with a warning. Triangles without area are dropped, except of meshes that change their
/// shape. A node with a sheared matrix, which a Transform cannot represent, becomes two entities, one the
/// parent of the other (see decompose); a joint is the lower one.
///
/// An image that is missing, damaged or of another kind is one warning. A checker of magenta and black takes
/// its place in base colours, black in emission; other textures are left out. It is still an error if its
/// file is outside of `options.root` or it exceeds a limit.
///
/// Throws SceneError, whose message is one line that names the file, the object and the problem, or
/// ImportCancelled. The world then has the entities and components that it had. Messages contain nothing of
/// other files than this one.
CANDELA_API ImportReport import_gltf(const std::filesystem::path& path, World& into,
                                     const ImportOptions& options = {});

/// The same from memory. `name` is the file's name in messages; URIs are relative to `base_directory`.
CANDELA_API ImportReport import_gltf(std::span<const unsigned char> bytes,
                                     const std::filesystem::path& base_directory, std::string_view name,
                                     World& into, const ImportOptions& options = {});

}  // namespace candela
