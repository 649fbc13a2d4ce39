#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>

namespace candela::sandbox {

/// How a value is interpolated between two keys. `smooth` eases in and out of every key (smoothstep).
enum class Interpolation : std::uint8_t { linear, step, smooth };

/// A key frame: the value at one frame.
template <class T>
struct Key {
    int frame = 0;
    T value{};
    bool operator==(const Key&) const = default;
};

/// Sorted by frame, and no two keys share a frame. Without keys the value is not animated.
template <class T>
using Keys = std::vector<Key<T>>;

/// The animation of one node. A value is constant before its first key and after its last key.
struct Track {
    std::string node;  ///< name
    Interpolation interpolation = Interpolation::linear;
    Keys<glm::vec3> translation{};  ///< metres, relative to the parent
    Keys<glm::quat> rotation{};     ///< unit length, relative to the parent; takes the shorter arc
    Keys<glm::vec3> scale{};
    Keys<float> intensity{};   ///< of a light: candela, or lux if directional
    Keys<glm::vec3> colour{};  ///< of a light: linear RGB
    Keys<bool> enabled{};      ///< of a light; always stepped
    bool operator==(const Track&) const = default;
};

/// Animation of a scene by frame number.
struct Script {
    std::filesystem::path path;        ///< the file it was read from; for messages
    std::optional<std::string> scene;  ///< the shipped scene or glTF file to animate; see scene_of
    int frames = 1;                    ///< >= 1
    bool loop = false;                 ///< restart after the last frame, instead of holding the last frame
    std::vector<Track> tracks;         ///< at most one per node
    bool operator==(const Script&) const = default;
};

/// The values of a track at one frame; nullopt for values that are not animated.
struct Pose {
    std::optional<glm::vec3> translation;
    std::optional<glm::quat> rotation;
    std::optional<glm::vec3> scale;
    std::optional<float> intensity;
    std::optional<glm::vec3> colour;
    std::optional<bool> enabled;
    bool operator==(const Pose&) const = default;
};

/// Depends only on its arguments.
[[nodiscard]] Pose pose_at(const Track& track, int frame);

/// The frame of the script that is shown in frame `frame` (>= 0) of a run.
[[nodiscard]] int frame_of(const Script& script, int frame);

/// A script and the entities that it animates.
class Animation {
 public:
    /// Looks up the nodes in the world. Throws std::runtime_error with a one-line message that names the
    /// script and the track, if a track's node does not exist, if its name is not unique, or if a track
    /// animates light values of a node that is not a light.
    Animation(Script script, const World& world);

    [[nodiscard]] const Script& script() const { return script_; }

    /// Sets everything that the script animates to its value in frame `frame` (>= 0) of a run. The result
    /// depends only on the frame, not on the frames shown before. A light that is switched off keeps its
    /// component, with intensity 0. A light that is switched on and whose intensity is not animated gets the
    /// intensity that it had when this object was created. `world` is the world that was given to the
    /// constructor, or a copy of it.
    void apply(World& world, int frame) const;

    /// Whether a track moves the entity or one of its parents.
    [[nodiscard]] bool moves(const World& world, Entity entity) const;

 private:
    /// Whether a track moves the entity itself.
    [[nodiscard]] bool drives(Entity entity) const;

    struct Driven {
        Entity entity;
        float strength = 0.0F;  ///< candela or lux at construction; 0 if it is not a light
    };

    Script script_;
    std::vector<Driven> driven_;  ///< one per track
};

}  // namespace candela::sandbox
