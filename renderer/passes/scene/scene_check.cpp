#include "renderer/passes/scene/scene_check.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <string>

#include <candela/scene/hierarchy.hpp>
#include <candela/scene/scene_error.hpp>

namespace candela {

template <class T, class Find>
const Fault& SceneCheck::known_fault(const std::shared_ptr<const T>& of, Find find) {
    forget_destroyed();
    Finding& finding = findings_[of.get()];
    if (finding.of.expired()) finding = {of, find(*of)};
    return finding.fault;
}

const Fault& SceneCheck::fault_in(const MeshInstance& instance) {
    static const Fault no_mesh = "there is no mesh";
    if (!instance.mesh) return no_mesh;
    return known_fault(instance.mesh, [this](const Mesh& mesh) {
        Fault fault = fault_of(mesh, strictness_);
        return fault ? fault : too_bright(mesh);
    });
}

Fault SceneCheck::fault_in(const DeformedMesh& deformed, const Mesh& mesh) {
    Fault fault = fault_of_fit(deformed, mesh);
    if (fault) return fault;
    return known_fault(deformed.vertices, [this](const DeformedMesh::Vertices& vertices) {
        return fault_of(vertices, strictness_);
    });
}

bool SceneCheck::accepts(const WorldReader& world, Entity entity, const MeshInstance& instance) {
    if (!judge(world, entity, component_name<MeshInstance>(), fault_in(instance))) return false;
    const auto* const deformed = world.find<DeformedMesh>(entity);
    return deformed == nullptr ||
           judge(world, entity, component_name<DeformedMesh>(), fault_in(*deformed, *instance.mesh));
}

bool SceneCheck::accepts_at(const WorldReader& world, Entity entity, const MeshInstance& instance,
                            const glm::mat4& matrix) {
    if (!accepts_at(world, entity, matrix)) return false;
    Finding& finding = findings_.at(instance.mesh.get());
    if (!finding.reach) finding.reach = reach_of(*instance.mesh);
    return judge(world, entity, {}, fault_of_extent(matrix, *finding.reach));
}

Fault SceneCheck::fault_in(const Environment& environment) {
    Fault fault = fault_of(environment);
    if (!fault) fault = too_bright(environment);
    if (fault || !environment.picture) return fault;
    return known_fault(environment.picture, [](const SkyPicture& picture) { return fault_of(picture); });
}

void SceneCheck::forget_destroyed() {
    if (findings_.size() < forget_at_) return;
    std::erase_if(findings_, [](const auto& entry) { return entry.second.of.expired(); });
    forget_at_ = 2 * findings_.size() + 64;
}

bool SceneCheck::judge(const WorldReader& world, Entity entity, std::string_view part, const Fault& fault) {
    if (!fault) return true;
    const std::string whose = describe(world, entity) + (part.empty() ? "" : fmt::format(", {}", part));
    if (strictness_ == Strictness::strict) throw SceneError(fmt::format("{}: {}", whose, *fault));
    log_->warn(whose, fmt::format("left out, because {}", *fault));
    return false;
}

}  // namespace candela
