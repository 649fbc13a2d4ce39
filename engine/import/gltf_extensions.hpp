#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace candela::gltf {

inline constexpr const char* lights_extension = "KHR_lights_punctual";
inline constexpr const char* emissive_strength_extension = "KHR_materials_emissive_strength";
inline constexpr const char* environment_extension = "CANDELA_environment";
inline constexpr const char* light_extension = "CANDELA_light";
/// All extensions that are supported.
inline constexpr std::array<std::string_view, 6> supported_extensions{
    lights_extension,      emissive_strength_extension, "KHR_texture_transform",
    "KHR_materials_unlit", environment_extension,       light_extension};

[[nodiscard]] inline bool is_supported(std::string_view extension) {
    return std::ranges::find(supported_extensions, extension) != supported_extensions.end();
}

}  // namespace candela::gltf
