#include "sandbox/animation/drag_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

namespace {

constexpr double frame_time = 1.0 / DragRecorder::frames_per_second;
constexpr double longest_gap = 0.25;  // seconds

std::size_t count_named(const World& world, const std::string& wanted) {
    std::size_t count = 0;
    for (const auto& [entity, name] : world.view<Name>()) count += name.value == wanted ? 1 : 0;
    return count;
}

/// Its name, if a script can name it.
std::string scriptable_name(const World& world, Entity entity) {
    const Name* name = world.find<Name>(entity);
    if (name == nullptr || name->value.empty()) {
        throw std::runtime_error(
            fmt::format("{} has no name: a script could not name what moves", describe(world, entity)));
    }
    const std::size_t count = count_named(world, name->value);
    if (count > 1) {
        throw std::runtime_error(
            fmt::format("'{}' is the name of {} objects: a script could not tell which of them moves",
                        name->value, count));
    }
    return name->value;
}

float difference(float a, float b) {
    return std::abs(a - b);
}
float difference(const glm::vec3& a, const glm::vec3& b) {
    return glm::distance(a, b);
}
/// The angle between two rotations, radians.
float difference(const glm::quat& a, const glm::quat& b) {
    // Exact also for small angles, unlike the arc cosine of the dot product.
    const glm::quat nearer = glm::dot(a, b) < 0.0F ? -b : b;
    return 4.0F * std::asin(std::min(1.0F, 0.5F * glm::length(a - nearer)));
}

float mixed(float a, float b, double part) {
    return static_cast<float>(a + (static_cast<double>(b) - a) * part);
}
glm::vec3 mixed(const glm::vec3& a, const glm::vec3& b, double part) {
    return {mixed(a.x, b.x, part), mixed(a.y, b.y, part), mixed(a.z, b.z, part)};
}
glm::quat mixed(const glm::quat& a, const glm::quat& b, double part) {
    return a == b ? a : glm::normalize(glm::slerp(a, b, static_cast<float>(part)));
}

float largest(float value) {
    return std::abs(value);
}
float largest(const glm::vec3& value) {
    return glm::length(value);
}

/// The frames from which all others follow to within the tolerance: Douglas and Peucker's algorithm (1973),
/// with differences at the same time.
template <class T>
Keys<T> reduce(const std::vector<T>& values, float tolerance) {
    std::vector<bool> is_key(values.size(), false);
    is_key.front() = is_key.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> ahead{{0, values.size() - 1}};
    while (!ahead.empty()) {
        const auto [first, last] = ahead.back();
        ahead.pop_back();
        std::size_t farthest = first;
        float distance = tolerance;
        for (std::size_t i = first + 1; i < last; ++i) {
            const double part = static_cast<double>(i - first) / static_cast<double>(last - first);
            const float away = difference(mixed(values[first], values[last], part), values[i]);
            if (away > distance) {
                distance = away;
                farthest = i;
            }
        }
        if (farthest == first) continue;
        is_key[farthest] = true;
        ahead.emplace_back(first, farthest);
        ahead.emplace_back(farthest, last);
    }
    Keys<T> keys;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (is_key[i]) keys.push_back({static_cast<int>(i), values[i]});
    }
    return keys;
}

/// The keys of one value of the frames; none if it never changes.
template <class Frame, class T>
Keys<T> keys_of(const std::vector<Frame>& frames, T Frame::*member, float tolerance) {
    std::vector<T> values;
    values.reserve(frames.size());
    for (const Frame& frame : frames) values.push_back(frame.*member);
    const auto changes = std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>());
    return changes == values.end() ? Keys<T>() : reduce(values, tolerance);
}

/// This part of the largest value.
template <class Frame, class T>
float tolerance_of(const std::vector<Frame>& frames, T Frame::*member, float part) {
    float most = 0.0F;
    for (const Frame& frame : frames) most = std::max(most, largest(frame.*member));
    return part * most;
}

}  // namespace

DragRecorder::DragRecorder(const World& world, Entity entity, Tolerance tolerance)
    : name_(scriptable_name(world, entity)), entity_(entity), tolerance_(tolerance) {}

void DragRecorder::record(const World& world, double seconds) {
    Record now;
    now.seconds = seconds;
    if (const auto* transform = world.find<Transform>(entity_)) {
        now.translation = transform->translation;
        now.rotation = transform->rotation;
        now.scale = transform->scale;
    }
    visit_lights_of(world, entity_, [&](const auto& light) {
        now.intensity = strength_of(light);
        now.colour = light.colour;
    });
    if (!records_.empty()) {
        now.seconds = std::max(seconds, records_.back().seconds);
        if (now.seconds - records_.back().seconds > longest_gap) {
            records_.push_back(records_.back());
            records_.back().seconds = now.seconds - frame_time;
        }
    }
    records_.push_back(now);
}

/// What was recorded, at each frame of the script. The last frame is not before the last record.
std::vector<DragRecorder::Record> DragRecorder::frames() const {
    std::vector<Record> frames;
    const double begin = records_.front().seconds;
    const double length = records_.back().seconds - begin;
    const auto last = static_cast<std::size_t>(std::ceil(length * frames_per_second - 1e-6));  // a rounding
    std::size_t next = 0;
    for (std::size_t i = 0; i <= last; ++i) {
        const double at = begin + static_cast<double>(i) * frame_time;
        while (next < records_.size() && records_[next].seconds <= at) ++next;
        const Record& before = records_[next == 0 ? 0 : next - 1];
        const Record& after = records_[std::min(next, records_.size() - 1)];
        const double gap = after.seconds - before.seconds;
        const double part = gap > 0.0 ? (at - before.seconds) / gap : 1.0;
        frames.push_back(
            {at, mixed(before.translation, after.translation, part),
             mixed(before.rotation, after.rotation, part), mixed(before.scale, after.scale, part),
             mixed(before.intensity, after.intensity, part), mixed(before.colour, after.colour, part)});
    }
    return frames;
}

Script DragRecorder::finish() const {
    Script script;
    Track track;
    track.node = name_;
    if (!records_.empty()) {
        const std::vector<Record> all = frames();
        script.frames = static_cast<int>(all.size());
        const auto part = [&](auto member) { return tolerance_of(all, member, tolerance_.part); };
        track.translation = keys_of(all, &Record::translation, tolerance_.distance);
        track.rotation = keys_of(all, &Record::rotation, tolerance_.angle);
        track.scale = keys_of(all, &Record::scale, part(&Record::scale));
        track.intensity = keys_of(all, &Record::intensity, part(&Record::intensity));
        track.colour = keys_of(all, &Record::colour, part(&Record::colour));
    }
    script.tracks.push_back(std::move(track));
    return script;
}

}  // namespace candela::sandbox
