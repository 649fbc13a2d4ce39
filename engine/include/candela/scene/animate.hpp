#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/world_writer.hpp>
#include <candela/graph/frame_graph.hpp>
#include <candela/scene/animation.hpp>
#include <candela/scene/deformed_mesh.hpp>

namespace candela {

// In each frame of a host: the systems of add_animation, or advance_animations and MeshDeformer::update; then
// the renderer. Values that stay the same are not set again, so that the rest of the frame sees only what has
// really changed.

/// What does not work in a world, one line each that names the entity, for example "entity "walk": its clip 3
/// does not exist". Empty: nothing is wrong.
using AnimationFaults = std::vector<std::string>;

/// Moves the time of all players that are `playing` by `seconds` times their speed and applies their clips at
/// that time to their targets. A player that does not loop ends at the last key, or, backwards, at 0. Paused
/// players, and what they have moved, are left as they are. What is faulty is left out.
CANDELA_API AnimationFaults advance_animations(const WorldWriter& world, double seconds);

/// Applies the player's clip at its present time, also if it is paused: to show a time that was set. Throws
/// EntityError if the entity has no AnimationPlayer.
CANDELA_API AnimationFaults apply_animation(const WorldWriter& world, Entity player);

/// Sets the DeformedMesh of entities that have a mesh and a Skin or MorphWeights, and removes it when they
/// have neither any more. It keeps what it needs to do so only when joints, weights or the mesh have changed,
/// and buffers that nobody else holds any more. One is meant for one world, and its copies.
///
/// First the weighted offsets of the morph targets are added to the vertices. Then each vertex is moved by
/// the mean of the matrices of its joints, weighted, from the mesh's space to the world and from there to the
/// entity's space: by inverse(world matrix of the entity) × world matrix of the joint × inverse bind matrix.
/// Weights are divided by their sum; vertices without weights follow the first joint of theirs. Primitives
/// without influences move with the entity, as they do without a skin.
///
/// Normals are multiplied by the cofactor matrix of that mean, which is the transposed inverse times the
/// determinant: so they stay perpendicular to the surface under any scale, and on the side that the winding
/// of the triangles calls the front, also where a joint is mirrored. Tangents are multiplied by the mean.
/// Both are normalised; where that is impossible, they stay as they are in the mesh.
///
/// An entity has a fault, and keeps the shape that it had, if a joint was destroyed or has no world matrix
/// (see world_matrix), if the skin has fewer joints than the mesh uses or another number of inverse bind
/// matrices, if the entity's world matrix has no inverse, if influences or targets do not fit the vertices,
/// or if weights of joints are negative or not finite, or those of targets not finite.
class CANDELA_API MeshDeformer {
 public:
    MeshDeformer();
    MeshDeformer(MeshDeformer&&) noexcept;
    MeshDeformer& operator=(MeshDeformer&&) noexcept;
    ~MeshDeformer();

    AnimationFaults update(const WorldWriter& world);
    /// The same for these entities only; what is known of others is kept.
    AnimationFaults update(const WorldWriter& world, std::span<const Entity> entities);

 private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Systems that play a world's animations and deform its meshes.
struct AnimationSystems {
    ValueHandle<double> seconds;                    ///< imported: the time of the host's clock
    ValueHandle<AnimationFaults> animation_faults;  ///< of the players
    ValueHandle<AnimationFaults> mesh_faults;       ///< of the deformed meshes
};

/// Adds the systems `animation` and `deformation` to a graph. They call advance_animations, with the time
/// that has passed since its last run, and MeshDeformer::update. A graph with them is meant for one world.
[[nodiscard]] CANDELA_API AnimationSystems add_animation(FrameGraph& graph);

}  // namespace candela
