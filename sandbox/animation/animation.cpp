#include "sandbox/animation/animation.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include <candela/scene/components.hpp>
#include "sandbox/candela_private.hpp"

namespace candela::sandbox {

namespace {

/// The last key that is not after `frame`, else the first key. `keys` must not be empty.
template <class T>
auto key_at(const Keys<T>& keys, int frame) {
    const auto is_later = [](int at, const Key<T>& key) { return at < key.frame; };
    const auto later = std::upper_bound(keys.begin(), keys.end(), frame, is_later);
    return later == keys.begin() ? later : std::prev(later);
}

template <class T>
std::optional<T> held_at(const Keys<T>& keys, int frame) {
    return keys.empty() ? std::nullopt : std::optional<T>(key_at(keys, frame)->value);
}

// Between equal keys a value is bit-identical, so that it does not count as a change.
float between(float from, float to, float part) {
    return from + part * (to - from);
}
glm::vec3 between(const glm::vec3& from, const glm::vec3& to, float part) {
    return from + part * (to - from);
}
/// Spherical interpolation along the shorter arc: Shoemake, "Animating Rotation with Quaternion Curves"
/// (1985).
glm::quat between(const glm::quat& from, const glm::quat& to, float part) {
    return from == to ? from : glm::normalize(glm::slerp(from, to, part));
}

template <class T>
std::optional<T> value_at(const Keys<T>& keys, Interpolation interpolation, int frame) {
    if (keys.empty()) return std::nullopt;
    const auto last = key_at(keys, frame);
    const auto next = std::next(last);
    // At the frame of a key, the value is bit-identical to that of the key.
    const bool holds = interpolation == Interpolation::step || next == keys.end() || frame <= last->frame;
    if (holds) return last->value;
    const float part =
        static_cast<float>(frame - last->frame) / static_cast<float>(next->frame - last->frame);
    const bool smooth = interpolation == Interpolation::smooth;
    return between(last->value, next->value, smooth ? glm::smoothstep(0.0F, 1.0F, part) : part);
}

[[noreturn]] void fail(const Script& script, std::size_t track, const char* member,
                       const std::string& error) {
    throw std::runtime_error(fmt::format("{}: tracks[{}].{}: '{}' {}", script.path.string(), track, member,
                                         readable(script.tracks[track].node), error));
}

std::vector<Entity> find_nodes(const World& world, const std::string& wanted) {
    std::vector<Entity> found;
    for (auto [entity, name] : world.view<Name>()) {
        if (name.value == wanted) found.push_back(entity);
    }
    return found;
}

/// Candela or lux; nullopt if the entity is not a light.
std::optional<float> light_strength(const World& world, Entity entity) {
    std::optional<float> strength;
    visit_lights_of(world, entity,
                    [&](const auto& light) { strength = strength.value_or(strength_of(light)); });
    return strength;
}

/// The name of an animated member that only lights have, or null.
const char* light_member(const Track& track) {
    if (!track.intensity.empty()) return "intensity";
    if (!track.colour.empty()) return "colour";
    return track.enabled.empty() ? nullptr : "enabled";
}

template <class T>
void put(const std::optional<T>& value, T& target) {
    if (value) target = *value;
}

void apply_transform(World& world, Entity entity, const Pose& pose) {
    if (!pose.translation && !pose.rotation && !pose.scale) return;
    Transform transform;
    if (const auto* present = world.find<Transform>(entity)) transform = *present;
    put(pose.translation, transform.translation);
    put(pose.rotation, transform.rotation);
    put(pose.scale, transform.scale);
    world.set(entity, transform);
}

/// `strength`: of the light while it is on, in the unit of its kind.
void apply_light(World& world, Entity entity, const Pose& pose, float strength) {
    edit_lights_of(world, entity, [&](auto& light) {
        put(pose.colour, light.colour);
        if (pose.intensity || pose.enabled) {
            strength_of(light) = pose.enabled.value_or(true) ? strength : 0.0F;
        }
    });
}

}  // namespace

Pose pose_at(const Track& track, int frame) {
    return {.translation = value_at(track.translation, track.interpolation, frame),
            .rotation = value_at(track.rotation, track.interpolation, frame),
            .scale = value_at(track.scale, track.interpolation, frame),
            .intensity = value_at(track.intensity, track.interpolation, frame),
            .colour = value_at(track.colour, track.interpolation, frame),
            .enabled = held_at(track.enabled, frame)};
}

int frame_of(const Script& script, int frame) {
    return script.loop ? frame % script.frames : std::min(frame, script.frames - 1);
}

Animation::Animation(Script script, const World& world) : script_(std::move(script)) {
    driven_.reserve(script_.tracks.size());
    for (std::size_t i = 0; i < script_.tracks.size(); ++i) {
        const Track& track = script_.tracks[i];
        const std::vector<Entity> nodes = find_nodes(world, track.node);
        if (nodes.empty()) fail(script_, i, "node", "is no node of the scene");
        if (nodes.size() > 1) fail(script_, i, "node", fmt::format("is the name of {} nodes", nodes.size()));
        const std::optional<float> strength = light_strength(world, nodes.front());
        const char* of_light = light_member(track);
        if (of_light != nullptr && !strength) fail(script_, i, of_light, "is no light");
        driven_.push_back({nodes.front(), strength.value_or(0.0F)});
    }
}

void Animation::apply(World& world, int frame) const {
    const int shown = frame_of(script_, frame);
    for (std::size_t i = 0; i < driven_.size(); ++i) {
        const Pose pose = pose_at(script_.tracks[i], shown);
        const Entity entity = driven_[i].entity;
        const float strength = pose.intensity.value_or(driven_[i].strength);
        apply_transform(world, entity, pose);
        apply_light(world, entity, pose, strength);
    }
}

bool Animation::drives(Entity entity) const {
    for (std::size_t i = 0; i < driven_.size(); ++i) {
        const Track& track = script_.tracks[i];
        const bool transforms = !track.translation.empty() || !track.rotation.empty() || !track.scale.empty();
        if (transforms && driven_[i].entity == entity) return true;
    }
    return false;
}

bool Animation::moves(const World& world, Entity entity) const {
    while (entity) {
        if (drives(entity)) return true;
        const auto* transform = world.find<Transform>(entity);
        entity = transform == nullptr ? Entity{} : transform->parent;
    }
    return false;
}

}  // namespace candela::sandbox
