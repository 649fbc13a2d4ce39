#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include <candela/api.hpp>
#include <candela/ecs/world.hpp>

namespace candela {

// What moves in a scene: figures with skeletons, meshes that change their shape, and the animations of both.
// Like all components, these are plain values, and large data is shared and immutable. Nothing happens by
// itself: advance_animations and MeshDeformer, in animate.hpp, turn them into Transforms and DeformedMeshes.

/// The skeleton of the entity's mesh, whose primitives have `influences`. The joints alone place the mesh:
/// the entity's own world matrix does not move it, as in glTF.
struct Skin {
    std::vector<Entity> joints;  ///< their world matrices move the vertices
    /// From the mesh's space to that of each joint when the mesh has its own shape; as many as joints. Null:
    /// identities.
    std::shared_ptr<const std::vector<glm::mat4>> inverse_bind_matrices;
    bool operator==(const Skin&) const = default;
};

/// How much of each of the mesh's morph targets is added to its vertices; any finite numbers. Targets without
/// a weight count as 0.
struct MorphWeights {
    std::vector<float> values;
    bool operator==(const MorphWeights&) const = default;
};

/// How values between two keys are found (glTF 2.0, appendix C).
enum class Interpolation : std::uint8_t {
    step,         ///< the value of the key before
    linear,       ///< straight; rotations on the shortest arc, at constant speed
    cubic_spline  ///< a Hermite spline; rotations are normalised
};

/// A value that changes with time. Before the first key it is that of the first, after the last that of the
/// last.
struct AnimationSampler {
    Interpolation interpolation = Interpolation::linear;
    /// Of the keys, seconds, ascending; at least one. Shared by samplers with the same keys. Never null.
    std::shared_ptr<const std::vector<float>> times;
    /// The components of each key's value, key after key; of a rotation x, y, z, w. Of a cubic spline, each
    /// key has a tangent to arrive, in units per second, then the value, then a tangent to leave. Never null.
    std::shared_ptr<const std::vector<float>> values;
};

/// What an animation changes.
enum class AnimatedProperty : std::uint8_t {
    translation,   ///< of the Transform, 3 components
    rotation,      ///< of the Transform, 4 components
    scale,         ///< of the Transform, 3 components
    morph_weights  ///< all MorphWeights, as many components as there are
};

/// A value of a target that follows a sampler.
struct AnimationChannel {
    std::size_t target = 0;  ///< index into Animations::targets
    AnimatedProperty property = AnimatedProperty::translation;
    std::size_t sampler = 0;  ///< index into AnimationClip::samplers
};

/// A motion. Immutable once it is shared.
struct AnimationClip {
    std::string name;
    std::vector<AnimationSampler> samplers;
    std::vector<AnimationChannel> channels;
    float duration = 0.0F;  ///< seconds from 0 to the last key
};

/// The motions of a figure. The targets are apart from the clips, so that several figures can share clips.
/// Immutable once they are shared.
struct Animations {
    std::vector<std::shared_ptr<const AnimationClip>> clips;  ///< none is null
    std::vector<Entity> targets;                              ///< what the channels of the clips change
};

/// Plays one of the clips. Changes in each frame, so that it shares what stays the same.
struct AnimationPlayer {
    std::shared_ptr<const Animations> animations;  ///< null: none
    std::size_t clip = 0;                          ///< the one that is played; index into `clips`
    double time = 0.0;                             ///< seconds from the start of the clip
    double speed = 1.0;                            ///< seconds of the clip by second; negative: backwards
    bool playing = true;                           ///< advance_animations moves it
    bool looping = true;  ///< it starts again at its end; else it stays there and `playing` ends
    bool operator==(const AnimationPlayer&) const = default;
};

/// The clip that the player plays; null if it does not exist. Valid as long as the player's `animations`.
[[nodiscard]] inline const AnimationClip* played_clip(const AnimationPlayer& player) {
    const bool exists = player.animations && player.clip < player.animations->clips.size();
    return exists ? player.animations->clips[player.clip].get() : nullptr;
}

}  // namespace candela
