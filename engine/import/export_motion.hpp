#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/scene/animation.hpp>
#include <candela/scene/components.hpp>
#include "engine/import/export_draft.hpp"

namespace candela::gltf {

// What moves, in a draft. All functions throw SceneError that says what is faulty.

/// The attributes of a primitive's influences, as "JOINTS_0".
void add_influences(const Primitive& primitive, Draft& draft, Json& attributes);

/// The morph targets of a primitive; null if it has none.
[[nodiscard]] Json describe_targets(const Primitive& primitive, Draft& draft);

/// The number of morph targets of the primitives that have triangles.
[[nodiscard]] std::size_t count_targets(const Mesh& mesh);

/// As many weights as targets.
[[nodiscard]] Json describe_weights(std::vector<float> weights, std::size_t targets);

/// Entities whose nodes what moves in the world needs.
[[nodiscard]] std::vector<Entity> moving_entities(const World& world);

/// Adds skins and animations. `nodes` are the sorted entities that become nodes; it and the world must
/// outlive the object.
class MotionWriter {
 public:
    MotionWriter(const World& world, std::span<const Entity> nodes, Draft& draft)
        : world_(world), nodes_(nodes), draft_(draft) {}

    /// The index of the skin; none if a joint is no node.
    std::optional<std::size_t> index_of(const Skin& skin);

    /// Adds the clips of a player, without channels whose targets are no nodes. Returns whether all are.
    bool add_clips(const Animations& animations);

 private:
    using Floats = std::shared_ptr<const std::vector<float>>;

    [[nodiscard]] std::optional<std::size_t> node_of(Entity entity) const;
    [[nodiscard]] std::size_t components_of(const AnimationChannel& channel, Entity target) const;
    [[nodiscard]] Json describe_sampler(const AnimationSampler& sampler, std::size_t components,
                                        bool is_weights);
    bool add_clip(const AnimationClip& clip, std::span<const Entity> targets);

    const World& world_;
    std::span<const Entity> nodes_;
    Draft& draft_;
    std::vector<std::pair<Skin, std::size_t>> skins_;
    std::map<Floats, std::size_t> times_;                           // accessors
    std::map<std::pair<Floats, std::size_t>, std::size_t> values_;  // accessors, by their components
};

}  // namespace candela::gltf
