#include "engine/import/gltf_instances.hpp"

#include <optional>
#include <string_view>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_nodes.hpp"
#include "engine/import/naming.hpp"

namespace candela::gltf {

namespace {

constexpr std::string_view attributes_path = "extensions.EXT_mesh_gpu_instancing.attributes";

}  // namespace

std::size_t count_instances(const Document& document, const Json& node) {
    const Json* const attributes = find_member(node, attributes_path);
    if (!attributes) return 0;
    std::optional<std::size_t> count;
    for (const Json& accessor : *attributes) {
        const std::size_t elements = element_count(document, accessor.get<int>());
        if (count.value_or(elements) != elements) {
            throw SceneError(fmt::format("its instances have {} values of one attribute and {} of another",
                                         *count, elements));
        }
        count = elements;
    }
    return count.value_or(0);
}

std::vector<Transform> read_instances(const Document& document, const Json& node, std::size_t count) {
    const Json& attributes = *find_member(node, attributes_path);
    const Selection all(count);
    std::vector<Transform> transforms(count);
    if (const int translations = index_in(attributes, "TRANSLATION"); translations >= 0) {
        const auto vectors = read_reals<glm::vec3>(document, translations, all, uses::vectors_of_instances);
        for (std::size_t i = 0; i < count; ++i) transforms[i].translation = vectors[i];
    }
    if (const int rotations = index_in(attributes, "ROTATION"); rotations >= 0) {
        const auto parts = read_reals<glm::vec4>(document, rotations, all, uses::rotations_of_instances);
        for (std::size_t i = 0; i < count; ++i) {
            transforms[i].rotation =
                naming(fmt::format("instance {}", i), [&] { return unit_rotation(glm::dvec4(parts[i])); });
        }
    }
    if (const int scales = index_in(attributes, "SCALE"); scales >= 0) {
        const auto vectors = read_reals<glm::vec3>(document, scales, all, uses::vectors_of_instances);
        for (std::size_t i = 0; i < count; ++i) transforms[i].scale = vectors[i];
    }
    return transforms;
}

}  // namespace candela::gltf
