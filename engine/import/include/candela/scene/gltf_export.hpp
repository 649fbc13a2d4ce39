#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/world.hpp>
#include <candela/scene/scene_error.hpp>

namespace candela {

/// Writes a world as a glTF 2.0 file that import_gltf reads back: hierarchy, names, transforms, cameras,
/// lights, meshes, skins, morph targets, animations, materials, images and the environment that counts, with
/// every bit of their numbers. Meshes, materials and images that are shared are written once. The path
/// decides the format: x.gltf gets its buffer and pictures in files beside it (x.bin, x-0.png, x-sky.exr),
/// x.glb contains them. Equal worlds give equal files.
///
/// Entities with a Transform, a mesh, a light or a camera, joints, and what an animation moves become nodes,
/// in the order of the entities: roots, and the children of each node. Entities that are listed in `without`,
/// and all below them, are left out. Of the components, only those of <candela/scene/components.hpp>,
/// lights.hpp and animation.hpp are kept. Two are written as extensions of Candela's own:
/// CANDELA_environment, and CANDELA_light, {"castsShadow": false}, of a light.
///
/// What glTF cannot hold comes back differently:
/// - missing: custom projections of cameras, deformations (DeformedMesh) of other entities than figures,
///   environments after the first. Each has a line in the result. So do meshes without triangles, and skins
///   and animations of entities that are left out.
/// - missing, without a line: how far a player of animations is and how it plays. All clips get one player.
/// - equal in effect: colours of lights above 1 (the intensity takes over the excess), ranges below
///   1.2e-38 m, missing transforms and names, and what a component does not use, such as the field of view
///   of an orthographic camera. The import drops triangles without area.
/// - valid values for invalid ones, with a line in the result: rotations and normals that are not of unit
///   length, cones of spot lights that are not inside each other or not below pi/2.
///
/// Throws SceneError, whose message is one line that names the file, the object and the problem, such as a
/// number that is not finite, several lights of one entity, or a full disk. All files are then as they were.
///
/// Returns what has been left out, one line each.
CANDELA_API std::vector<std::string> export_gltf(const World& world, const std::filesystem::path& path,
                                                 std::span<const Entity> without = {});

}  // namespace candela
