#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <candela/graph/execute.hpp>
#include <candela/scene/animate.hpp>
#include <candela/scene/animation.hpp>

namespace candela::sandbox {

/// Time between two frames wherever frames are counted: in headless runs, and in a window with --frames.
inline constexpr double seconds_a_frame = 1.0 / 30.0;

/// What plays the animations of a world's files, in the order of their creation.
[[nodiscard]] std::vector<Entity> animation_players(const World& world);

/// Makes each player play the clip of this name, or, if there is none, with this index, counted from 0.
/// Throws SceneError that lists the clips if no player has it.
void choose_clip(World& world, const std::string& wanted);

/// The player's clips. Valid as long as its `animations`.
[[nodiscard]] std::span<const std::shared_ptr<const AnimationClip>> clips_of(const AnimationPlayer& player);

/// The name of one of the player's clips, or "clip 3" if it has none.
[[nodiscard]] std::string clip_name(const AnimationPlayer& player, std::size_t clip);

/// Whether any clip moves on by itself.
[[nodiscard]] bool plays_clips(const World& world);

/// Pauses all players, or, if none plays, resumes all; those that have ended start again.
void toggle_clips(World& world);

/// Plays the clips of a world, and deforms what its skeletons and morph weights move, whoever has changed
/// these.
class ClipPlayback {
 public:
    ClipPlayback();

    /// Moves all players on by one frame and pauses them.
    void step(World& world);
    /// Shows a player's clip at a time, seconds.
    void seek(World& world, Entity player, double time);

    /// Moves on what plays by so many seconds.
    void advance(World& world, double seconds);

    /// What does not work, one line each.
    [[nodiscard]] AnimationFaults faults() const;

 private:
    std::unique_ptr<GraphRuntime> systems_;
    AnimationSystems handles_;
    double seconds_ = 0.0;     // played so far
    AnimationFaults of_seek_;  // of the player whose time was set last
};

}  // namespace candela::sandbox
