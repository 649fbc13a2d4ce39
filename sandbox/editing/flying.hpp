#pragma once

#include <set>

#include <glm/vec3.hpp>

namespace candela::sandbox {

/// Moves a camera while keys are held: W and S forwards and backwards, A and D to the left and right, Q and E
/// down and up; four times as fast with shift.
class Flying {
 public:
    /// Whether the key moves the camera, or makes it faster.
    [[nodiscard]] static bool uses(int key);

    void press(int key) { held_.insert(key); }
    void release(int key) { held_.erase(key); }
    void stop() { held_.clear(); }
    /// Whether the camera moves.
    [[nodiscard]] bool moving() const { return direction() != glm::vec3(0.0F); }

    /// Each notch makes flying a fifth faster, within limits.
    void adjust_speed(float notches);

    /// The motion within a time, in view space (+x right, +y up, +z backwards). `radius` is that of the
    /// scene, metres: a scene is crossed in about four seconds, whatever its size.
    [[nodiscard]] glm::vec3 motion(float seconds, float radius) const;

 private:
    [[nodiscard]] glm::vec3 direction() const;  ///< unit length, or zero

    std::set<int> held_;
    float speed_ = 1.0F;  ///< relative to the usual one
};

}  // namespace candela::sandbox
