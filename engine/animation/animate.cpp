#include <candela/scene/animate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include "engine/animation/sample.hpp"

namespace candela {

namespace {

/// Applies one clip at one time.
class ClipWriter {
 public:
    ClipWriter(const WorldWriter& world, Entity player, AnimationFaults& faults)
        : world_(world), player_(player), faults_(faults) {}

    void write() {
        const auto& player = world_.get<AnimationPlayer>(player_);
        const AnimationClip* const clip = played_clip(player);
        if (!clip) return report(fmt::format("its clip {} does not exist", player.clip));
        if (!std::isfinite(player.time)) return report("its time is not finite");
        for (std::size_t i = 0; i < clip->channels.size(); ++i) {
            const std::optional<std::string> fault = write_channel(player, *clip, clip->channels[i]);
            if (fault) report(fmt::format("channel {} of its clip {}: {}", i, player.clip, *fault));
        }
        finish_transform();
    }

 private:
    void report(const std::string& fault) {
        faults_.push_back(fmt::format("{}: {}", describe(world_, player_), fault));
    }

    /// Returns what is wrong with it.
    std::optional<std::string> write_channel(const AnimationPlayer& player, const AnimationClip& clip,
                                             const AnimationChannel& channel) {
        const std::vector<Entity>& targets = player.animations->targets;
        if (channel.target >= targets.size() || !world_.alive(targets[channel.target])) {
            return fmt::format("its target {} no longer exists", channel.target);
        }
        if (channel.sampler >= clip.samplers.size()) {
            return fmt::format("its sampler {} does not exist", channel.sampler);
        }
        const AnimationSampler& sampler = clip.samplers[channel.sampler];
        if (!sampler.times || sampler.times->empty() || !sampler.values) return "its sampler has no keys";
        const Entity target = targets[channel.target];
        const std::size_t keys = values_needed(sampler, 1);
        const std::size_t components = channel.property == AnimatedProperty::morph_weights
                                           ? sampler.values->size() / keys
                                           : (channel.property == AnimatedProperty::rotation ? 4 : 3);
        if (components == 0 || sampler.values->size() != keys * components) {
            return fmt::format("its sampler has {} numbers for {} keys", sampler.values->size(),
                               sampler.times->size());
        }
        const KeyPosition at = position_in(sampler, player.time);
        if (channel.property == AnimatedProperty::morph_weights) {
            MorphWeights weights{std::vector<float>(components)};
            sample(sampler, at, false, weights.values);
            world_.set(target, std::move(weights));
        } else {
            begin_transform(target);
            write_part(sampler, at, channel.property);
        }
        return {};
    }

    void write_part(const AnimationSampler& sampler, const KeyPosition& at, AnimatedProperty property) {
        if (property == AnimatedProperty::rotation) {
            std::array<float, 4> value{};
            sample(sampler, at, true, value);
            transform_.rotation = glm::quat(value[3], value[0], value[1], value[2]);
            return;
        }
        std::array<float, 3> value{};
        sample(sampler, at, false, value);
        glm::vec3& part =
            property == AnimatedProperty::translation ? transform_.translation : transform_.scale;
        part = {value[0], value[1], value[2]};
    }

    /// Channels of one target usually follow each other, and mostly have the same keys: its Transform is set
    /// once, and the keys are looked for once.
    void begin_transform(Entity target) {
        if (target == target_) return;
        finish_transform();
        target_ = target;
        const auto* const transform = world_.find<Transform>(target);
        transform_ = transform ? *transform : Transform{};
    }

    void finish_transform() {
        if (target_) world_.set(target_, transform_);
        target_ = {};
    }

    KeyPosition position_in(const AnimationSampler& sampler, double seconds) {
        if (sampler.times.get() != times_) {
            times_ = sampler.times.get();
            position_ = find_keys(*times_, seconds);
        }
        return position_;
    }

    WorldWriter world_;
    Entity player_;
    AnimationFaults& faults_;
    Entity target_{};  // whose Transform is being written
    Transform transform_;
    const std::vector<float>* times_ = nullptr;  // in which the position was looked for
    KeyPosition position_;
};

/// Of a player whose clip exists.
void advance(AnimationPlayer& player, double seconds) {
    const double end = played_clip(player)->duration;
    player.time += seconds * player.speed;
    if (!std::isfinite(player.time)) return;
    if (player.looping) {
        const bool is_within = player.time >= 0.0 && player.time < end;
        if (is_within) return;
        player.time = end > 0.0 ? std::fmod(player.time, end) : 0.0;
        if (player.time < 0.0) player.time = std::min(player.time + end, std::nextafter(end, 0.0));
        return;
    }
    const bool has_ended = player.speed < 0.0 ? player.time <= 0.0 : player.time >= end;
    if (has_ended) player.playing = false;
    player.time = std::clamp(player.time, 0.0, end);
}

}  // namespace

AnimationFaults advance_animations(const WorldWriter& world, double seconds) {
    std::vector<Entity> playing;
    for (const auto& [entity, player] : world.view<AnimationPlayer>()) {
        if (player.playing) playing.push_back(entity);
    }
    AnimationFaults faults;
    for (const Entity entity : playing) {
        if (played_clip(world.get<AnimationPlayer>(entity))) {
            world.edit<AnimationPlayer>(entity, [&](AnimationPlayer& player) { advance(player, seconds); });
        }
        ClipWriter(world, entity, faults).write();
    }
    return faults;
}

AnimationFaults apply_animation(const WorldWriter& world, Entity player) {
    static_cast<void>(world.get<AnimationPlayer>(player));
    AnimationFaults faults;
    ClipWriter(world, player, faults).write();
    return faults;
}

}  // namespace candela
