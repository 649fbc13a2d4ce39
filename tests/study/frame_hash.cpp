#include "tests/study/frame_hash.hpp"

#include <fmt/format.h>

#include "tests/study/scene_hash.hpp"

namespace candela::study {
namespace {

std::string text(const glm::vec3& value) {
    return fmt::format("{} {} {}", value.x, value.y, value.z);
}

std::string text(const glm::quat& value) {
    return fmt::format("{} {} {} {}", value.w, value.x, value.y, value.z);
}

std::string text(float value) {
    return fmt::format("{}", value);
}

std::string text(bool value) {
    return value ? "on" : "off";
}

/// Values that are not animated have a text that no value has.
template <class T>
std::string text(const std::optional<T>& value) {
    return value ? text(*value) : "-";
}

std::string text(const sandbox::Track& track, int frame) {
    const sandbox::Pose pose = sandbox::pose_at(track, frame);
    return fmt::format("{}:{};{};{};{};{};{}\n", track.node, text(pose.translation), text(pose.rotation),
                       text(pose.scale), text(pose.intensity), text(pose.colour), text(pose.enabled));
}

}  // namespace

std::string frame_hash(std::string_view scene_hash, const sandbox::Script& script, int frame) {
    std::uint64_t state = fnv1a(scene_hash);
    const int shown = sandbox::frame_of(script, frame);
    for (const sandbox::Track& track : script.tracks) {
        state = fnv1a(text(track, shown), state);
    }
    return fmt::format("{:016x}", state);
}

}  // namespace candela::study
