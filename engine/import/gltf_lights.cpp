#include "engine/import/gltf_lights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/export_draft.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/gltf_values.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

constexpr float half_pi = std::numbers::pi_v<float> / 2.0F;

/// The "type" of each kind.
template <class Light>
constexpr std::string_view type_of;
template <>
constexpr std::string_view type_of<PointLight> = "point";
template <>
constexpr std::string_view type_of<SpotLight> = "spot";
template <>
constexpr std::string_view type_of<DirectionalLight> = "directional";

/// Writes what only this kind of light has.
template <class Light>
void write_shape(const Light& /*light*/, WrittenLight& /*written*/) {}

void write_shape(const SpotLight& light, WrittenLight& written) {
    const float outer = std::min(light.outer_cone, half_pi);
    const float inner = std::min(light.inner_cone, std::nextafter(outer, 0.0F));
    if (inner != light.inner_cone || outer != light.outer_cone) {
        written.warning =
            "its cones are narrowed: the outer one to 90 degrees, the inner one to the outer one";
    }
    written.json["spot"] = {{"innerConeAngle", to_json(inner)}, {"outerConeAngle", to_json(outer)}};
}

template <class Light>
void read_shape(const Json& /*source*/, int /*index*/, Light& /*light*/) {}

void read_shape(const Json& source, int index, SpotLight& light) {
    light.inner_cone = value_in(source, "spot.innerConeAngle", 0.0F);
    light.outer_cone = std::min(value_in(source, "spot.outerConeAngle", half_pi / 2.0F), half_pi);
    if (light.inner_cone >= light.outer_cone) {
        throw SceneError(fmt::format("light {}: its inner cone of {} is not inside its outer cone of {}",
                                     index, light.inner_cone, light.outer_cone));
    }
}

/// glTF's colours are at most 1. Without a range the light reaches everywhere; glTF allows no range of zero.
template <class Light>
WrittenLight write(const Light& light) {
    const LightTraits<Light>& kind = light_traits<Light>;
    const float most = std::max({1.0F, light.colour.r, light.colour.g, light.colour.b});
    WrittenLight written{.json = {{"type", type_of<Light>},
                                  {"color", to_json(light.colour / most)},
                                  {"intensity", to_json(strength_of(light) * most)}},
                         .warning = {}};
    if (!light.casts_shadow) written.json["extensions"][light_extension] = {{"castsShadow", false}};
    if (kind.range != nullptr && std::isfinite(light.*kind.range)) {
        written.json["range"] = to_json(std::max(light.*kind.range, std::numeric_limits<float>::min()));
    }
    write_shape(light, written);
    return written;
}

template <class Light>
Light read(const Json& source, int index) {
    const LightTraits<Light>& kind = light_traits<Light>;
    Light light;
    light.colour = vector_in(source, "color", glm::vec3(1.0F));
    strength_of(light) = value_in(source, "intensity", 1.0F);
    light.casts_shadow = value_in(source, "extensions.CANDELA_light.castsShadow", true);
    if (kind.range != nullptr) {
        light.*kind.range = value_in(source, "range", std::numeric_limits<float>::infinity());
    }
    read_shape(source, index, light);
    return light;
}

}  // namespace

WrittenLight write_light(const AnyLight& light) {
    return std::visit([](const auto& of_kind) { return write(of_kind); }, light);
}

AnyLight read_light(const Json& source, int index) {
    const auto type = source.at("type").get<std::string>();
    std::optional<AnyLight> light;
    for_each_light_kind([&]<class Light>(const LightTraits<Light>&) {
        if (type == type_of<Light>) light = read<Light>(source, index);
    });
    if (!light) throw SceneError(fmt::format("light {} has the unknown type \"{}\"", index, readable(type)));
    return *light;
}

}  // namespace candela::gltf
