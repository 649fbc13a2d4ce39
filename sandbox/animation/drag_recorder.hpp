#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include "sandbox/animation/animation.hpp"

namespace candela::sandbox {

/// Records how one entity moves, and how its light changes, as a script. Frames are 1/30 s apart: a window
/// that shows 30 frames per second plays the script as fast as it was recorded. Values between two records
/// are interpolated; if nothing was recorded for a quarter of a second, they stay as they are until a frame
/// before the next record.
class DragRecorder {
 public:
    static constexpr double frames_per_second = 30.0;

    /// How far the script may be from what was recorded, in each frame.
    struct Tolerance {
        float distance = 1e-3F;  ///< metres, in the space of the entity's parent
        float angle = 1e-3F;     ///< radians
        float part = 1e-3F;  ///< of scales, intensity and colour, relative to the largest that was recorded
    };

    /// Starts to record an entity of the world. Throws std::runtime_error if its name is empty or not unique
    /// in the world: a script could not name it.
    DragRecorder(const World& world, Entity entity, Tolerance tolerance);
    DragRecorder(const World& world, Entity entity) : DragRecorder(world, entity, Tolerance()) {}

    /// Records the entity's Transform, and its light's strength and colour. `seconds` is the time of any
    /// clock; if it is before that of the last record, it counts as that. `world` is the world of the
    /// constructor, or a copy of it.
    void record(const World& world, double seconds);

    /// The script, with one track. Values that did not change have no keys. Script::scene is not set.
    [[nodiscard]] Script finish() const;

 private:
    struct Record {
        double seconds = 0.0;
        glm::vec3 translation{0.0F};
        glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
        glm::vec3 scale{1.0F};
        float intensity = 0.0F;  ///< candela, or lux if directional
        glm::vec3 colour{0.0F};
    };

    [[nodiscard]] std::vector<Record> frames() const;

    std::string name_;
    Entity entity_;
    Tolerance tolerance_;
    std::vector<Record> records_;
};

}  // namespace candela::sandbox
