#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "engine/ecs/world.hpp"

namespace candela::sandbox {

/// How a value gets from one key to the next. `smooth` starts and ends every stretch at rest.
enum class Interpolation : std::uint8_t { linear, step, smooth };

/// What a value is at a frame.
template <class T>
struct Key {
    int frame = 0;
    T value{};
};

/// In the order of their frames, of which no two are equal. Without keys a value is not driven.
template <class T>
using Keys = std::vector<Key<T>>;

/// What a script does to one node. Before its first key a value is as there, after its last as there.
struct Track {
    std::string node;  ///< name
    Interpolation interpolation = Interpolation::linear;
    Keys<glm::vec3> translation{};  ///< metres, to the parent
    Keys<glm::quat> rotation{};     ///< unit length, to the parent; taken the shorter way round
    Keys<glm::vec3> scale{};
    Keys<float> intensity{};   ///< of a light: candela, or lux of a directional one
    Keys<glm::vec3> colour{};  ///< of a light: linear
    Keys<bool> enabled{};      ///< of a light; steps, whatever the interpolation
};

/// Motion of a scene by frame number.
struct Script {
    std::filesystem::path path;        ///< where it came from; for messages
    std::optional<std::string> scene;  ///< the shipped scene that it is for, or a glTF file; see scene_of
    int frames = 1;                    ///< >= 1
    bool loop = false;                 ///< after the last frame comes the first, or else the last again
    std::vector<Track> tracks;         ///< one a node
};

/// What a track makes of its node in one frame; what it does not drive is nullopt.
struct Pose {
    std::optional<glm::vec3> translation;
    std::optional<glm::quat> rotation;
    std::optional<glm::vec3> scale;
    std::optional<float> intensity;
    std::optional<glm::vec3> colour;
    std::optional<bool> enabled;
    bool operator==(const Pose&) const = default;
};

/// Depends on nothing but its arguments.
[[nodiscard]] Pose pose_at(const Track& track, int frame);

/// The frame of the script that is shown in frame `frame`, >= 0, of a run.
[[nodiscard]] int frame_of(const Script& script, int frame);

/// A script and the entities that it moves.
class Animation {
 public:
    /// Finds the nodes in the world. Throws std::runtime_error whose one line names the script and the track
    /// that asks for a node which is not there or not the only one of its name, or for light of what is no
    /// light.
    Animation(Script script, const World& world);

    [[nodiscard]] const Script& script() const { return script_; }

    /// Puts everything that the script drives to where it is in frame `frame`, >= 0, of a run, whatever was
    /// there before: the world depends on the frame alone, not on those shown before it. A light that is
    /// switched off keeps its component, with no intensity; one that is on and whose intensity is not driven
    /// has what it had when this was made. `world` is that of the constructor, or a copy.
    void apply(World& world, int frame) const;

 private:
    struct Driven {
        Entity entity;
        float strength = 0.0F;  ///< candela or lux, when the animation was made; of no light 0
    };

    Script script_;
    std::vector<Driven> driven_;  ///< one a track
};

}  // namespace candela::sandbox
