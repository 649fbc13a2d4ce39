#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace candela::gltf {

// Numbers that stand for names in glTF 2.0.
inline constexpr int unsigned_byte = 5121;
inline constexpr int unsigned_short = 5123;
inline constexpr int unsigned_int = 5125;
inline constexpr int floating_point = 5126;
inline constexpr int mode_triangles = 4;
inline constexpr int mode_triangle_strip = 5;
inline constexpr int vertices_target = 34962;
inline constexpr int indices_target = 34963;
inline constexpr int wrap_repeat = 10497;
inline constexpr int wrap_clamp_to_edge = 33071;
inline constexpr int wrap_mirrored_repeat = 33648;

// What the import reads of a glTF document. Indices are -1 for none. Offsets, lengths and strides are in
// bytes.

struct BufferView {
    int buffer = -1;
    std::size_t offset = 0;
    std::size_t length = 0;
    std::size_t stride = 0;  ///< 0: the elements are next to each other
};

/// A run of elements in a buffer view.
struct ElementSource {
    int buffer_view = -1;
    std::size_t offset = 0;
    int component_type = 0;
};

/// Elements that replace some of an accessor's. Their components have the accessor's type.
struct SparseElements {
    std::size_t count = 0;
    ElementSource indices;
    ElementSource values;
};

struct Accessor {
    ElementSource source;     ///< without a buffer view all elements are zero
    int components = 0;       ///< of SCALAR 1, of VEC2 to VEC4 2 to 4; 0 for matrices, which no attribute has
    std::size_t count = 0;    ///< elements
    bool normalized = false;  ///< integers stand for fractions of the largest
    std::optional<SparseElements> sparse;
};

struct EncodedImage {
    std::string name;
    std::string uri;  ///< empty if it is in a buffer view
    int buffer_view = -1;
};

struct Sampler {
    int wrap_s = wrap_repeat;
    int wrap_t = wrap_repeat;
};

struct Texture {
    int sampler = -1;
    int image = -1;
};

/// How a material uses a texture: a textureInfo with its KHR_texture_transform.
struct TextureUse {
    int texture = -1;
    int coordinate_set = 0;
    glm::vec2 scale{1.0F};
    glm::vec2 offset{0.0F};
    double rotation = 0.0;  ///< radians, counter-clockwise as seen with v pointing down
};

struct MaterialSource {
    std::string name;
    std::array<double, 4> base_colour{1.0, 1.0, 1.0, 1.0};
    TextureUse base_colour_texture;
    std::array<double, 3> emissive{};
    double emissive_strength = 1.0;  ///< KHR_materials_emissive_strength
    TextureUse emissive_texture;
    std::string alpha_mode = "OPAQUE";
    double alpha_cutoff = 0.5;
    bool double_sided = false;
    bool unlit = false;  ///< KHR_materials_unlit
};

struct PrimitiveSource {
    std::map<std::string, int> attributes;  ///< accessors by name
    int indices = -1;
    int material = -1;
    int mode = mode_triangles;
    bool has_targets = false;  ///< morph targets
};

struct MeshSource {
    std::string name;
    std::vector<PrimitiveSource> primitives;
};

struct CameraSource {
    std::string name;
    bool is_perspective = true;
    double vertical_fov = 0.0;  ///< radians
    double half_height = 0.0;   ///< metres
    double near_plane = 0.0;
    double far_plane = 0.0;  ///< 0: none
};

/// KHR_lights_punctual, with CANDELA_light.
struct LightSource {
    std::string name;
    std::string type;
    std::vector<double> colour;  ///< three, or empty: white
    double intensity = 1.0;
    double range = 0.0;  ///< 0: endless
    double inner_cone = 0.0;
    double outer_cone = 0.0;
    bool casts_shadow = true;
};

/// CANDELA_environment. Its picture is in a file, or in a buffer view, or it has none.
struct EnvironmentSource {
    std::string name = "environment";
    glm::vec3 radiance{1.0F};
    float rotation = 0.0F;
    std::string uri;
    int buffer_view = -1;
};

struct SceneSource {
    std::vector<int> nodes;
    std::optional<EnvironmentSource> environment;
};

struct Model {
    std::vector<BufferView> buffer_views;
    std::vector<Accessor> accessors;
    std::vector<EncodedImage> images;
    std::vector<Sampler> samplers;
    std::vector<Texture> textures;
    std::vector<MaterialSource> materials;
    std::vector<MeshSource> meshes;
    std::vector<CameraSource> cameras;
    std::vector<LightSource> lights;
    std::vector<SceneSource> scenes;
    int default_scene = -1;
};

}  // namespace candela::gltf
