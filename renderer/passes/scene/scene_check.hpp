#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <unordered_map>

#include <glm/mat4x4.hpp>

#include <candela/ecs/world_reader.hpp>
#include <candela/scene/components.hpp>
#include "engine/scene/check.hpp"
#include "renderer/gpu/log.hpp"

namespace candela {

/// Decides which parts of a world are rendered. What has a fault is left out with a warning, or, if checked,
/// is a SceneError; both name the entity and the fault. Meshes and pictures are immutable, so that each is
/// checked only when it is seen for the first time.
class SceneCheck {
 public:
    /// `log` must outlive the object.
    SceneCheck(Log& log, bool checked)
        : log_(&log), strictness_(checked ? Strictness::strict : Strictness::usual) {}

    /// Whether a component of the entity is rendered: an Environment or a light.
    template <Component C>
    [[nodiscard]] bool accepts(const WorldReader& world, Entity entity, const C& component) {
        return judge(world, entity, component_name<C>(), fault_in(component));
    }
    /// A MeshInstance is rendered only if the entity's DeformedMesh, if any, has no fault either.
    [[nodiscard]] bool accepts(const WorldReader& world, Entity entity, const MeshInstance& instance);
    /// Whether anything of the entity is rendered, with this local-to-world matrix.
    [[nodiscard]] bool accepts_at(const WorldReader& world, Entity entity, const glm::mat4& matrix) {
        return judge(world, entity, {}, fault_of(matrix));
    }
    /// The same for a MeshInstance, which has been accepted.
    [[nodiscard]] bool accepts_at(const WorldReader& world, Entity entity, const MeshInstance& instance,
                                  const glm::mat4& matrix);

 private:
    /// What was found in a mesh, vertices or a picture; void if that no longer exists.
    struct Finding {
        std::weak_ptr<const void> of;
        Fault fault;
        std::optional<float> reach{};  // of a mesh: see reach_of; nullopt if it was not needed yet
    };

    template <class Light>
    [[nodiscard]] static Fault fault_in(const Light& light) {
        Fault fault = fault_of(light);
        return fault ? fault : too_bright(light);
    }
    [[nodiscard]] const Fault& fault_in(const MeshInstance& instance);
    [[nodiscard]] Fault fault_in(const DeformedMesh& deformed, const Mesh& mesh);
    [[nodiscard]] Fault fault_in(const Environment& environment);
    /// The fault of a mesh, vertices or a picture, found by `find` if it is not known.
    template <class T, class Find>
    [[nodiscard]] const Fault& known_fault(const std::shared_ptr<const T>& of, Find find);
    void forget_destroyed();
    /// An empty `part` is the whole entity.
    [[nodiscard]] bool judge(const WorldReader& world, Entity entity, std::string_view part,
                             const Fault& fault);

    Log* log_;
    Strictness strictness_;
    std::unordered_map<const void*, Finding> findings_;
    std::size_t forget_at_ = 64;  // number of findings at which those of destroyed meshes are removed
};

}  // namespace candela
