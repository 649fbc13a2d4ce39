#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include <nlohmann/json.hpp>

#include <candela/scene/animation.hpp>
#include <candela/scene/components.hpp>

namespace candela {

// What glTF 2.0 calls the values of enumerations, in files that are read and written.
NLOHMANN_JSON_SERIALIZE_ENUM(Wrap, {{Wrap::repeat, 10497},
                                    {Wrap::clamp_to_edge, 33071},
                                    {Wrap::mirrored_repeat, 33648}})
NLOHMANN_JSON_SERIALIZE_ENUM(AlphaMode, {{AlphaMode::opaque, "OPAQUE"},
                                         {AlphaMode::mask, "MASK"},
                                         {AlphaMode::blend, "BLEND"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Interpolation, {{Interpolation::linear, "LINEAR"},
                                             {Interpolation::step, "STEP"},
                                             {Interpolation::cubic_spline, "CUBICSPLINE"}})
NLOHMANN_JSON_SERIALIZE_ENUM(AnimatedProperty, {{AnimatedProperty::translation, "translation"},
                                                {AnimatedProperty::rotation, "rotation"},
                                                {AnimatedProperty::scale, "scale"},
                                                {AnimatedProperty::morph_weights, "weights"}})

namespace gltf {

// Numbers that stand for names in glTF 2.0.
inline constexpr int signed_byte = 5120;
inline constexpr int unsigned_byte = 5121;
inline constexpr int signed_short = 5122;
inline constexpr int unsigned_short = 5123;
inline constexpr int unsigned_int = 5125;
inline constexpr int floating_point = 5126;
inline constexpr int mode_triangles = 4;
inline constexpr int mode_triangle_strip = 5;
inline constexpr int vertices_target = 34962;
inline constexpr int indices_target = 34963;

inline constexpr const char* lights_extension = "KHR_lights_punctual";
inline constexpr const char* emissive_strength_extension = "KHR_materials_emissive_strength";
inline constexpr const char* ior_extension = "KHR_materials_ior";
inline constexpr const char* specular_extension = "KHR_materials_specular";
inline constexpr const char* transmission_extension = "KHR_materials_transmission";
inline constexpr const char* quantization_extension = "KHR_mesh_quantization";
inline constexpr const char* basisu_extension = "KHR_texture_basisu";
inline constexpr const char* webp_extension = "EXT_texture_webp";
inline constexpr const char* meshopt_extension = "EXT_meshopt_compression";
inline constexpr const char* draco_extension = "KHR_draco_mesh_compression";
inline constexpr const char* instancing_extension = "EXT_mesh_gpu_instancing";
inline constexpr const char* environment_extension = "CANDELA_environment";
inline constexpr const char* light_extension = "CANDELA_light";
/// All extensions that are supported. KHR_texture_basisu is one of them because a texture has a fallback, or
/// else a warning of its own; KHR_materials_variants because a file's other materials are its defaults.
inline constexpr auto supported_extensions = std::to_array<std::string_view>(
    {lights_extension, emissive_strength_extension, ior_extension, specular_extension, transmission_extension,
     "KHR_materials_unlit", "KHR_texture_transform", quantization_extension, basisu_extension, webp_extension,
     meshopt_extension, draco_extension, instancing_extension, "KHR_materials_variants",
     environment_extension, light_extension});

/// Those that add layers or depth to materials, whose other members then say what surfaces mainly look like.
inline constexpr auto approximated_extensions = std::to_array<std::string_view>(
    {"KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission",
     "KHR_materials_dispersion", "KHR_materials_iridescence", "KHR_materials_sheen", "KHR_materials_volume"});

/// Whether Candela was built with what reads it.
[[nodiscard]] inline bool is_built(std::string_view extension) {
    if (extension == meshopt_extension) return CANDELA_MESHOPT != 0;
    return extension != draco_extension || CANDELA_DRACO != 0;
}

[[nodiscard]] inline bool is_supported(std::string_view extension) {
    return is_built(extension) &&
           std::ranges::find(supported_extensions, extension) != supported_extensions.end();
}

[[nodiscard]] inline bool is_approximated(std::string_view extension) {
    return std::ranges::find(approximated_extensions, extension) != approximated_extensions.end();
}

}  // namespace gltf
}  // namespace candela
