#include "engine/import/gltf_animations.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/gltf_morphs.hpp"
#include "engine/import/naming.hpp"

namespace candela::gltf {

namespace {

using Floats = std::shared_ptr<const std::vector<float>>;

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

std::optional<AnimatedProperty> property_of(const Json& path) {
    const auto property = path.get<AnimatedProperty>();  // an unknown one becomes the first
    return path == property ? std::optional(property) : std::nullopt;
}

void check_times(const std::vector<float>& times) {
    if (times.front() < 0.0F) throw SceneError("the time of its first key is negative");
    const auto wrong = std::ranges::adjacent_find(times, std::greater_equal<>());
    if (wrong != times.end()) {
        throw SceneError(fmt::format("the times of its keys {} and {} do not ascend", wrong - times.begin(),
                                     wrong - times.begin() + 1));
    }
}

class AnimationReader {
 public:
    AnimationReader(Document& document, const std::vector<StagedEntity>& staged, ImportBudget& budget)
        : document_(document), budget_(budget), places_(document.all("nodes").size(), nowhere) {
        for (std::size_t i = 0; i < staged.size(); ++i) {
            if (staged[i].is_node) places_[static_cast<std::size_t>(staged[i].node)] = i;
        }
    }

    ReadAnimations read() {
        const Json& animations = document_.all("animations");
        for (std::size_t i = 0; i < animations.size(); ++i) {
            AnimationClip clip =
                naming(fmt::format("animation {}", i), [&] { return read_clip(animations[i], i); });
            if (clip.channels.empty()) continue;
            read_.clips.push_back(std::make_shared<const AnimationClip>(std::move(clip)));
        }
        document_.warnings.insert(document_.warnings.end(), omissions_.begin(), omissions_.end());
        return std::move(read_);
    }

 private:
    AnimationClip read_clip(const Json& source, std::size_t index) {
        AnimationClip clip;
        clip.name = text_in(source, "name", fmt::format("animation {}", index));
        std::map<std::pair<int, std::size_t>, std::size_t> known;  // by sampler, and its components
        for (const Json& channel : source.at("channels")) {
            const std::optional<int> node = node_of(channel);
            if (!node) continue;
            const AnimatedProperty property = *property_of(channel.at("target").at("path"));
            const std::size_t components = components_of(*node, property);
            if (components == 0) {
                omissions_.insert("animations of weights of nodes without morph targets are ignored");
                continue;
            }
            const int sampler = channel.at("sampler").get<int>();
            const Json& samplers = source.at("samplers");
            if (static_cast<std::size_t>(sampler) >= samplers.size()) {
                throw SceneError(fmt::format("a channel has sampler {}, but there are {} samplers", sampler,
                                             samplers.size()));
            }
            const auto [found, is_new] = known.emplace(std::pair(sampler, components), clip.samplers.size());
            if (is_new) {
                clip.samplers.push_back(naming(fmt::format("sampler {}", sampler), [&] {
                    return read_sampler(samplers[static_cast<std::size_t>(sampler)], property, components);
                }));
            }
            clip.channels.push_back({target_of(*node), property, found->second});
            clip.duration = std::max(clip.duration, clip.samplers[found->second].times->back());
        }
        // Those of a target follow each other: it is then changed once.
        std::ranges::stable_sort(clip.channels, {}, &AnimationChannel::target);
        return clip;
    }

    /// The node that the channel moves, if it can.
    std::optional<int> node_of(const Json& channel) {
        const Json& target = channel.at("target");
        const int node = index_in(target, "node");
        if (!property_of(target.at("path"))) {
            omissions_.insert(
                "animations of other values than translation, rotation, scale and weights are ignored");
        } else if (node < 0) {
            omissions_.insert("animations without a node are ignored");
        } else if (places_[static_cast<std::size_t>(node)] == nowhere) {
            omissions_.insert("animations of nodes that are not in the scene are ignored");
        } else if (document_.at("nodes", node).contains("matrix") && target.at("path") != "weights") {
            omissions_.insert("animations of nodes with a matrix are ignored");
        } else {
            return node;
        }
        return std::nullopt;
    }

    std::size_t components_of(int node, AnimatedProperty property) {
        if (property == AnimatedProperty::rotation) return 4;
        if (property != AnimatedProperty::morph_weights) return 3;
        const int mesh = index_in(document_.at("nodes", node), "mesh");
        if (mesh < 0) return 0;
        const auto found = morph_targets_.find(mesh);
        if (found != morph_targets_.end()) return found->second;
        return morph_targets_.emplace(mesh, count_targets(document_.at("meshes", mesh))).first->second;
    }

    std::size_t target_of(int node) {
        const std::size_t place = places_[static_cast<std::size_t>(node)];
        const auto [found, is_new] = targets_.emplace(place, read_.targets.size());
        if (is_new) read_.targets.push_back(place);
        return found->second;
    }

    AnimationSampler read_sampler(const Json& source, AnimatedProperty property, std::size_t components) {
        AnimationSampler sampler;
        sampler.interpolation = value_in(source, "interpolation", Interpolation::linear);
        sampler.times = times_of(source.at("input").get<int>());
        const int output = source.at("output").get<int>();
        const bool is_weights = property == AnimatedProperty::morph_weights;
        const std::size_t parts = sampler.interpolation == Interpolation::cubic_spline ? 3 : 1;
        const std::size_t wanted = sampler.times->size() * parts * (is_weights ? components : 1);
        const std::size_t count = element_count(document_, output);
        if (count != wanted) {
            throw SceneError(fmt::format("its {} keys need {} elements, but accessor {} has {}",
                                         sampler.times->size(), wanted, output, count));
        }
        const std::size_t width = is_weights ? 1 : components;
        Floats& values = values_[{output, width}];
        if (!values) {
            budget_.add_memory(std::uint64_t{count} * (2 * width * sizeof(float)));
            const bool may_be_integers = is_weights || property == AnimatedProperty::rotation;
            values = std::make_shared<const std::vector<float>>(
                read_key_values(document_, output, width, may_be_integers));
        }
        sampler.values = values;
        return sampler;
    }

    /// Samplers usually share them.
    Floats times_of(int accessor) {
        Floats& times = times_[accessor];
        if (!times) {
            const std::size_t count = element_count(document_, accessor);
            budget_.add_memory(count * sizeof(float));
            times = std::make_shared<const std::vector<float>>(
                read_reals<float>(document_, accessor, Selection(count), uses::times));
            check_times(*times);
        }
        return times;
    }

    Document& document_;
    ImportBudget& budget_;
    std::vector<std::size_t> places_;  // of nodes, among the staged entities
    ReadAnimations read_;
    std::map<std::size_t, std::size_t> targets_;  // places among the targets, by place of the entity
    std::map<int, std::size_t> morph_targets_;    // by mesh
    std::map<int, Floats> times_;                 // by accessor
    std::map<std::pair<int, std::size_t>, Floats> values_;  // by accessor and its components
    std::set<std::string> omissions_;
};

}  // namespace

ReadAnimations read_animations(Document& document, const std::vector<StagedEntity>& staged,
                               ImportBudget& budget) {
    return AnimationReader(document, staged, budget).read();
}

}  // namespace candela::gltf
