#include "engine/import/gltf_skins.hpp"

#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <candela/scene/scene_error.hpp>
#include "engine/import/naming.hpp"

namespace candela::gltf {

namespace {

/// Where exporters make weights add up to 1, rounding errors are left of some that are 0, also below it.
glm::vec4 without_rounding(const glm::vec4& weights) {
    constexpr float rounding = std::numeric_limits<float>::epsilon();
    return glm::mix(weights, glm::vec4(0.0F), glm::lessThan(glm::abs(weights), glm::vec4(rounding)));
}

ReadSkin read_skin(const Document& document, const Json& source, ImportBudget& budget) {
    ReadSkin skin;
    source.at("joints").get_to(skin.joints);
    const int matrices = index_in(source, "inverseBindMatrices");
    if (matrices < 0) return skin;
    const std::size_t count = element_count(document, matrices);
    if (count < skin.joints.size()) {
        throw SceneError(
            fmt::format("it has {} joints, but {} inverse bind matrices", skin.joints.size(), count));
    }
    budget.add_memory(skin.joints.size() * sizeof(glm::mat4));
    skin.inverse_bind_matrices = std::make_shared<const std::vector<glm::mat4>>(
        read_reals<glm::mat4>(document, matrices, Selection(skin.joints.size()), uses::matrices));
    return skin;
}

/// The accessor of "JOINTS_0" and the like; -1 for none.
int accessor_of(const Json& primitive, const char* kind, std::size_t set) {
    return index_in(primitive.at("attributes"), fmt::format("{}_{}", kind, set));
}

}  // namespace

std::vector<std::optional<ReadSkin>> read_skins(const Document& document, const std::vector<bool>& used,
                                                ImportBudget& budget) {
    std::vector<std::optional<ReadSkin>> skins(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        skins[i] = naming(fmt::format("skin {}", i),
                          [&] { return read_skin(document, document.all("skins")[i], budget); });
    }
    return skins;
}

std::vector<std::vector<Influences>> read_influences(const Document& document, const Json& primitive,
                                                     const Selection& selection, ImportBudget& budget) {
    std::vector<std::vector<Influences>> sets;
    while (true) {
        const int joints = accessor_of(primitive, "JOINTS", sets.size());
        const int weights = accessor_of(primitive, "WEIGHTS", sets.size());
        if (joints < 0 && weights < 0) return sets;
        if (joints < 0 || weights < 0) {
            throw SceneError(fmt::format("it has only one of JOINTS_{0} and WEIGHTS_{0}", sets.size()));
        }
        check_count(document, primitive, joints, "sets of joints");
        check_count(document, primitive, weights, "sets of weights");
        budget.add_memory(selection.count() *
                          (sizeof(Influences) + sizeof(glm::u16vec4) + sizeof(glm::vec4)));
        const std::vector<glm::u16vec4> read_of_joints = read_joints(document, joints, selection);
        const auto read_of_weights = read_reals<glm::vec4>(document, weights, selection, uses::weights);
        std::vector<Influences>& set = sets.emplace_back();
        set.reserve(selection.count());
        for (std::size_t i = 0; i < selection.count(); ++i) {
            set.push_back({read_of_joints[i], without_rounding(read_of_weights[i])});
        }
    }
}

}  // namespace candela::gltf
