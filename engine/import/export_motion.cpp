#include "engine/import/export_motion.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/animation/sample.hpp"
#include "engine/import/gltf_constants.hpp"

namespace candela::gltf {

namespace {

static_assert(sizeof(Influences) == 24 && offsetof(Influences, weights) == 8);

void check_finite(std::span<const float> numbers) {
    const auto is_finite = [](float number) { return std::isfinite(number); };
    if (!std::ranges::all_of(numbers, is_finite)) throw SceneError("a number is not finite");
}

const char* type_of(std::size_t components) {
    if (components == 1) return "SCALAR";
    if (components == 16) return "MAT4";
    return components == 3 ? "VEC3" : "VEC4";
}

/// An accessor of all numbers.
std::size_t add_numbers(std::span<const float> numbers, std::size_t components, Draft& draft,
                        Json members = Json::object()) {
    check_finite(numbers);
    return draft.add_accessor(draft.add_view(std::as_bytes(numbers)), floating_point, type_of(components),
                              numbers.size() / components, std::move(members));
}

void check_count(std::size_t items, const Primitive& primitive, const char* plural) {
    if (items != primitive.vertices.size()) {
        throw SceneError(fmt::format("{} {} for {} vertices", items, plural, primitive.vertices.size()));
    }
}

void add_offsets(const std::vector<glm::vec3>& offsets, const char* name, const Primitive& primitive,
                 Draft& draft, Json& target) {
    if (offsets.empty()) return;
    check_count(offsets.size(), primitive, "offsets of a morph target");
    const bool are_positions = std::string_view(name) == "POSITION";
    target[name] = add_numbers({&offsets[0].x, 3 * offsets.size()}, 3, draft,
                               are_positions ? bounds_of(offsets) : Json::object());
}

}  // namespace

void add_influences(const Primitive& primitive, Draft& draft, Json& attributes) {
    for (std::size_t i = 0; i < primitive.influences.size(); ++i) {
        const std::vector<Influences>& set = primitive.influences[i];
        check_count(set.size(), primitive, "influences");
        for (const Influences& each : set) {
            check_finite({&each.weights.x, 4});
        }
        const std::size_t view = draft.add_view(
            std::as_bytes(std::span(set)), {{"byteStride", sizeof(Influences)}, {"target", vertices_target}});
        const auto add = [&](const char* kind, std::size_t offset, int component_type) {
            attributes[fmt::format("{}_{}", kind, i)] =
                draft.add_accessor(view, component_type, "VEC4", set.size(), {{"byteOffset", offset}});
        };
        add("JOINTS", offsetof(Influences, joints), unsigned_short);
        add("WEIGHTS", offsetof(Influences, weights), floating_point);
    }
}

Json describe_targets(const Primitive& primitive, Draft& draft) {
    Json targets;
    for (const MorphTarget& target : primitive.targets) {
        Json json = Json::object();
        add_offsets(target.positions, "POSITION", primitive, draft, json);
        add_offsets(target.normals, "NORMAL", primitive, draft, json);
        add_offsets(target.tangents, "TANGENT", primitive, draft, json);
        if (json.empty()) {  // glTF has no empty targets
            const std::vector<glm::vec3> none(primitive.vertices.size(), glm::vec3(0.0F));
            add_offsets(none, "POSITION", primitive, draft, json);
        }
        targets.push_back(std::move(json));
    }
    return targets;
}

std::size_t count_targets(const Mesh& mesh) {
    std::optional<std::size_t> targets;
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.indices.empty()) continue;
        const std::size_t count = primitive.targets.size();
        if (targets.value_or(count) != count) {
            throw SceneError(fmt::format("its primitives have {} and {} morph targets", *targets, count));
        }
        targets = count;
    }
    return targets.value_or(0);
}

Json describe_weights(std::vector<float> weights, std::size_t targets) {
    weights.resize(targets);
    Json json = Json::array();
    for (const float weight : weights) {
        json.push_back(to_json(weight));
    }
    return json;
}

std::vector<Entity> moving_entities(const World& world) {
    std::vector<Entity> entities;
    const auto add = [&](const std::vector<Entity>& more) {
        std::ranges::copy_if(more, std::back_inserter(entities),
                             [&](Entity entity) { return world.alive(entity); });
    };
    for (const auto& [entity, skin] : world.view<Skin>()) {
        add(skin.joints);
    }
    for (const auto& [entity, player] : world.view<AnimationPlayer>()) {
        if (player.animations) add(player.animations->targets);
    }
    return entities;
}

std::optional<std::size_t> MotionWriter::node_of(Entity entity) const {
    const auto found = std::ranges::lower_bound(nodes_, entity);
    if (found == nodes_.end() || *found != entity) return std::nullopt;
    return static_cast<std::size_t>(found - nodes_.begin());
}

std::optional<std::size_t> MotionWriter::index_of(const Skin& skin) {
    for (const auto& [known, index] : skins_) {
        if (known == skin) return index;
    }
    Json joints = Json::array();
    for (const Entity joint : skin.joints) {
        const std::optional<std::size_t> node = node_of(joint);
        if (!node) return std::nullopt;
        joints.push_back(*node);
    }
    if (joints.empty()) return std::nullopt;
    Json json = {{"joints", std::move(joints)}};
    if (const auto& matrices = skin.inverse_bind_matrices) {
        if (matrices->size() != skin.joints.size()) {
            throw SceneError(fmt::format("its skin has {} joints, but {} inverse bind matrices",
                                         skin.joints.size(), matrices->size()));
        }
        json["inverseBindMatrices"] =
            add_numbers({&matrices->front()[0][0], 16 * matrices->size()}, 16, draft_);
    }
    skins_.emplace_back(skin, draft_.add("skins", std::move(json)));
    return skins_.back().second;
}

std::size_t MotionWriter::components_of(const AnimationChannel& channel, Entity target) const {
    if (channel.property == AnimatedProperty::rotation) return 4;
    if (channel.property != AnimatedProperty::morph_weights) return 3;
    const auto* const instance = world_.find<MeshInstance>(target);
    return instance && instance->mesh ? count_targets(*instance->mesh) : 0;
}

Json MotionWriter::describe_sampler(const AnimationSampler& sampler, std::size_t components,
                                    bool is_weights) {
    const auto [time, is_new_time] = times_.emplace(sampler.times, 0);
    if (is_new_time) {
        time->second = add_numbers(*sampler.times, 1, draft_,
                                   {{"min", Json::array({to_json(sampler.times->front())})},
                                    {"max", Json::array({to_json(sampler.times->back())})}});
    }
    const std::size_t width = is_weights ? 1 : components;
    const auto [value, is_new_value] = values_.emplace(std::pair(sampler.values, width), 0);
    if (is_new_value) value->second = add_numbers(*sampler.values, width, draft_);
    return {{"input", time->second}, {"output", value->second}, {"interpolation", sampler.interpolation}};
}

bool MotionWriter::add_clip(const AnimationClip& clip, std::span<const Entity> targets) {
    Json channels = Json::array();
    Json samplers = Json::array();
    bool is_complete = true;
    for (const AnimationChannel& channel : clip.channels) {
        const bool exists = channel.target < targets.size();
        const auto node = exists ? node_of(targets[channel.target]) : std::nullopt;
        const std::size_t components = node ? components_of(channel, targets[channel.target]) : 0;
        if (components == 0) {
            is_complete = false;
            continue;
        }
        if (channel.sampler >= clip.samplers.size()) throw SceneError("a sampler does not exist");
        const AnimationSampler& sampler = clip.samplers[channel.sampler];
        if (!sampler.times || sampler.times->empty() || !sampler.values ||
            sampler.values->size() != values_needed(sampler, components)) {
            throw SceneError("a sampler does not have the numbers that its keys need");
        }
        const bool is_weights = channel.property == AnimatedProperty::morph_weights;
        channels.push_back(
            {{"sampler", samplers.size()}, {"target", {{"node", *node}, {"path", channel.property}}}});
        samplers.push_back(describe_sampler(sampler, components, is_weights));
    }
    if (channels.empty()) return is_complete;
    Json json = {{"channels", std::move(channels)}, {"samplers", std::move(samplers)}};
    if (!clip.name.empty()) json["name"] = to_json(clip.name);
    draft_.add("animations", std::move(json));
    return is_complete;
}

bool MotionWriter::add_clips(const Animations& animations) {
    bool is_complete = true;
    for (const std::shared_ptr<const AnimationClip>& clip : animations.clips) {
        if (!clip) throw SceneError("a clip does not exist");
        is_complete &= add_clip(*clip, animations.targets);
    }
    return is_complete;
}

}  // namespace candela::gltf
