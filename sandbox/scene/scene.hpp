#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/gltf.hpp>
#include "sandbox/animation/animation.hpp"
#include "sandbox/files/shipped_file.hpp"

namespace candela {
struct Box;
}  // namespace candela

namespace candela::sandbox {

/// What the app shows: a world, the file it was read from, and its animation.
struct Scene {
    std::filesystem::path path;
    World world;
    std::vector<std::string> warnings;   ///< what the import left out, and what the app added; one per line
    std::optional<Animation> animation;  ///< refers to entities of `world`
    std::vector<Entity> studio{};        ///< sky and light of add_studio; none before it was called
};

/// The whole number that `text` is, as where a camera or a clip is chosen by its index.
[[nodiscard]] std::optional<std::size_t> parse_index(const std::string& text);

/// The file of the animation script, if there is one.
[[nodiscard]] std::optional<std::string> animation_of(const Scene& scene);

/// Whether the file is one of those that shipped_file finds.
[[nodiscard]] bool is_shipped(const std::string& folder, const std::filesystem::path& file);

/// The shipped scenes, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> shipped_scenes();

/// What the app allows files to be: all that its user may read.
[[nodiscard]] ImportOptions unconfined();

/// Imports a glTF file, without an animation. Throws SceneError that names the file and the error, and what
/// import_gltf throws besides.
[[nodiscard]] Scene load_scene(const std::filesystem::path& path,
                               const ImportOptions& options = unconfined());

/// Why a picture of the scene has no surfaces, in one line with the file; empty if it has a triangle with an
/// area.
[[nodiscard]] std::string why_nothing_is_seen(const Scene& scene);

/// Saves a world as .gltf or .glb so that load_scene opens the same. `of_app` are entities that the app has
/// added for itself, such as the camera of its view: they are not saved. Returns what glTF cannot hold, one
/// line each. Throws SceneError that names the file and the error; the files are then as they were. See
/// export_gltf.
std::vector<std::string> save_scene(const World& world, const std::filesystem::path& path,
                                    std::span<const Entity> of_app);

/// The box around the meshes of these entities; world space, metres. Empty without meshes.
[[nodiscard]] Box box_of(const World& world, const std::vector<Entity>& entities);

/// The bounding sphere of the bounding box of all mesh instances; world space, metres. Radius 0 without
/// meshes.
struct Bounds {
    glm::vec3 centre{0.0F};
    float radius = 0.0F;
};
[[nodiscard]] Bounds bounds(const World& world);

/// The entities with a Camera, in the order of their creation.
[[nodiscard]] std::vector<Entity> cameras(const World& world);

/// The camera with the name `wanted`, or, if there is none, the camera with this index, counted from 0. The
/// first camera if `wanted` is not set. If it is not set and the world has no camera, adds one that sees the
/// whole scene at this aspect ratio (width / height). Throws SceneError that lists the cameras if there is no
/// such camera.
[[nodiscard]] Entity choose_camera(World& world, const std::optional<std::string>& wanted, float aspect);

/// The entity's name, or "entity 3" if it has none.
[[nodiscard]] std::string name_of(const World& world, Entity entity);

}  // namespace candela::sandbox
