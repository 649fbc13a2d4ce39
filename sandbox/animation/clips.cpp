#include "sandbox/animation/clips.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <candela/scene/scene_error.hpp>
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

std::optional<std::size_t> find_clip(const AnimationPlayer& player, const std::string& wanted) {
    const auto clips = clips_of(player);
    for (std::size_t clip = 0; clip < clips.size(); ++clip) {
        if (clips[clip]->name == wanted) return clip;
    }
    const std::optional<std::size_t> index = parse_index(wanted);
    return index && *index < clips.size() ? index : std::nullopt;
}

std::string list_clips(const World& world) {
    std::vector<std::string> names;
    for (const Entity entity : animation_players(world)) {
        const auto& player = world.get<AnimationPlayer>(entity);
        for (std::size_t clip = 0; clip < clips_of(player).size(); ++clip) {
            names.push_back(fmt::format("{} '{}'", clip, clip_name(player, clip)));
        }
    }
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

double duration_of(const AnimationPlayer& player) {
    const AnimationClip* const clip = played_clip(player);
    return clip ? static_cast<double>(clip->duration) : 0.0;
}

void resume(AnimationPlayer& player) {
    player.playing = true;
    if (!player.looping && player.time >= duration_of(player)) player.time = 0.0;
}

}  // namespace

std::vector<Entity> animation_players(const World& world) {
    std::vector<Entity> players;
    for (auto [entity, player] : world.view<AnimationPlayer>()) players.push_back(entity);
    std::sort(players.begin(), players.end());
    return players;
}

std::span<const std::shared_ptr<const AnimationClip>> clips_of(const AnimationPlayer& player) {
    if (!player.animations) return {};
    return player.animations->clips;
}

std::string clip_name(const AnimationPlayer& player, std::size_t clip) {
    const std::string& name = clips_of(player)[clip]->name;
    return name.empty() ? fmt::format("clip {}", clip) : name;
}

void choose_clip(World& world, const std::string& wanted) {
    bool found = false;
    for (const Entity entity : animation_players(world)) {
        const std::optional<std::size_t> clip = find_clip(world.get<AnimationPlayer>(entity), wanted);
        if (!clip) continue;
        world.edit<AnimationPlayer>(entity, [&](AnimationPlayer& player) { player.clip = *clip; });
        found = true;
    }
    if (!found) throw SceneError(fmt::format("no clip '{}'; the scene has {}", wanted, list_clips(world)));
}

bool plays_clips(const World& world) {
    return std::ranges::any_of(animation_players(world), [&](Entity entity) {
        const auto& player = world.get<AnimationPlayer>(entity);
        return player.playing && player.speed != 0.0 && duration_of(player) > 0.0;
    });
}

void toggle_clips(World& world) {
    const bool pauses = plays_clips(world);
    for (const Entity entity : animation_players(world)) {
        world.edit<AnimationPlayer>(entity, [&](AnimationPlayer& player) {
            player.playing = false;
            if (!pauses) resume(player);
        });
    }
}

ClipPlayback::ClipPlayback() : systems_(std::make_unique<GraphRuntime>()) {
    FrameGraph graph;
    handles_ = add_animation(graph);
    systems_->switch_to(compile(std::move(graph)).take());
    systems_->set(handles_.seconds, seconds_);
    World empty;
    systems_->run(empty);  // starts the clock, and says that nothing is faulty yet
}

void ClipPlayback::step(World& world) {
    const std::vector<Entity> players = animation_players(world);
    const auto set_playing = [&](bool on) {
        for (const Entity entity : players) {
            world.edit<AnimationPlayer>(entity, [&](AnimationPlayer& player) { player.playing = on; });
        }
    };
    set_playing(true);
    advance(world, seconds_a_frame);
    set_playing(false);
}

void ClipPlayback::seek(World& world, Entity player, double time) {
    world.edit<AnimationPlayer>(player, [&](AnimationPlayer& edited) { edited.time = time; });
    of_seek_ = apply_animation(world, player);
    systems_->run(world);
}

void ClipPlayback::advance(World& world, double seconds) {
    if (seconds != 0.0) of_seek_.clear();
    seconds_ += seconds;
    systems_->set(handles_.seconds, seconds_);
    systems_->run(world);
}

AnimationFaults ClipPlayback::faults() const {
    AnimationFaults all = of_seek_;
    for (const auto handle : {handles_.animation_faults, handles_.mesh_faults}) {
        const AnimationFaults& faults = systems_->value(handle);
        all.insert(all.end(), faults.begin(), faults.end());
    }
    return all;
}

}  // namespace candela::sandbox
