#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <candela/api.hpp>
#include <candela/ecs/world_reader.hpp>
#include <candela/scene/lights.hpp>

namespace candela {

// The components of a scene; lights are in lights.hpp. All are plain values that compare by value. Large data
// (meshes, images) is shared and immutable, so comparing pointers is enough to detect a change. Conventions
// are those of glTF: right-handed, +Y up, cameras and lights point along their local -Z, lengths in metres,
// linear RGB.

/// Display name of the entity; not unique.
struct Name {
    std::string value;
    bool operator==(const Name&) const = default;
};

/// Local-to-parent transform: scale, then rotation, then translation (metres). A null `parent` means world
/// space.
struct Transform {
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
    Entity parent{};
    bool operator==(const Transform&) const = default;
};

/// How texture coordinates outside [0, 1] are mapped back.
enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };

/// What the red, green and blue channels of an image are; alpha is always linear.
enum class Encoding : std::uint8_t {
    srgb,   ///< colours
    linear  ///< other values, in [0, 1]
};

/// An 8-bit image, rows top to bottom, tightly packed.
struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<glm::u8vec4> texels;  ///< width × height
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    Encoding encoding = Encoding::srgb;
};

/// What a material's alpha means (glTF's alphaMode).
enum class AlphaMode : std::uint8_t {
    opaque,  ///< alpha is ignored
    mask,    ///< where alpha is below the cutoff there is no surface: it is not visible and blocks no light
    blend    ///< alpha is the fraction of the light behind the surface that it blocks; see add_transparent
};

/// Which images of a material lie on its surfaces by Primitive::second_uvs; the others by Vertex::uv. So does
/// that of the base colour in any case: holes of alpha masks need no second coordinates.
struct SecondUvUse {
    bool emissive = false;
    bool metal_roughness = false;
    bool normal = false;
    bool occlusion = false;
    bool operator==(const SecondUvUse&) const = default;
};

/// A surface of glTF's metallic-roughness model (glTF 2.0, appendix B). Its base colour and alpha are
/// `base_colour` × the decoded texture × the colour of the vertices, each channel in [0, 1]. By default it is
/// Lambertian, and the base colour is its albedo. The back of a single-sided surface is not drawn and
/// reflects no light, but it still blocks light.
struct Material {
    std::string name;
    glm::vec4 base_colour{1.0F};                       ///< linear
    std::shared_ptr<const Image> base_colour_texture;  ///< sRGB; null: none
    /// Share of the surface that is metal, in [0, 1], × the texture's blue channel. Metal reflects its base
    /// colour in the mirror direction; the rest reflects it in all directions.
    float metalness = 0.0F;
    /// Square root of α of the GGX distribution of microfacets, in [0, 1], × the texture's green channel.
    float roughness = 1.0F;
    std::shared_ptr<const Image> metal_roughness_texture;  ///< linear; null: none
    /// What is not metal reflects in the mirror direction too: this share, in [0, 1], of what an interface of
    /// `ior` to air does, times `specular_colour` where it faces the viewer (KHR_materials_specular).
    float specular = 0.0F;
    glm::vec3 specular_colour{1.0F};  ///< linear, >= 0
    float ior = 1.5F;  ///< index of refraction, >= 1; 0: reflects all light (KHR_materials_ior)
    /// Share, in [0, 1], of the light reflected in all directions that passes through instead, times the base
    /// colour: thin glass, which bends no light (KHR_materials_transmission). What lies behind is sharp,
    /// whatever the roughness. See add_transparent.
    float transmission = 0.0F;
    /// Normals in the space of the vertices' tangents, from 0 to 1 for -1 to 1; linear, null: none. They turn
    /// what the surface reflects, but cast no shadows. x and y are multiplied by `normal_scale`. All vertices
    /// need tangents then, as derive_tangents of tangents.hpp makes them.
    std::shared_ptr<const Image> normal_texture;
    float normal_scale = 1.0F;
    /// The red channel is the share of indirect light that reaches the surface; linear, null: 1. Only
    /// `occlusion_strength` of what is missing is taken away, in [0, 1].
    std::shared_ptr<const Image> occlusion_texture;
    float occlusion_strength = 1.0F;
    /// Radiance that the surface emits, linear, in cd/m² (or W/(sr m²), like the lights' units), each channel
    /// >= 0 and finite: from the front, and from the back if it is double-sided. Multiplied by the texture.
    glm::vec3 emissive{0.0F};
    std::shared_ptr<const Image> emissive_texture;  ///< sRGB; null: none; alpha is ignored
    SecondUvUse second_uvs{};
    bool double_sided = false;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5F;  ///< of AlphaMode::mask, >= 0
};

/// Whether surfaces of the material may emit light.
[[nodiscard]] inline bool emits(const Material& material) {
    return material.emissive != glm::vec3(0.0F);
}

/// Whether surfaces of the material may reflect light in other ways than all surfaces of a Lambertian one do.
[[nodiscard]] inline bool is_glossy(const Material& material) {
    return material.metalness > 0.0F || material.specular > 0.0F;
}

/// Whether what lies behind surfaces of the material may be seen through them. They stop no light: they cast
/// no shadows and light no others.
[[nodiscard]] inline bool is_seen_through(const Material& material) {
    return material.alpha_mode == AlphaMode::blend || material.transmission > 0.0F;
}

/// Whether the material has images of details of its surfaces' shape.
[[nodiscard]] inline bool is_bumpy(const Material& material) {
    return material.normal_texture != nullptr || material.occlusion_texture != nullptr;
}

/// Whether the material has images that need Primitive::second_uvs.
[[nodiscard]] inline bool uses_second_uvs(const Material& material) {
    const SecondUvUse& use = material.second_uvs;
    return (use.emissive && material.emissive_texture) ||
           (use.metal_roughness && material.metal_roughness_texture) ||
           (use.normal && material.normal_texture) || (use.occlusion && material.occlusion_texture);
}

/// Vertex of a mesh in its local space. `normal` is unit length; `uv` has its origin at the image's top left.
/// `colour` multiplies the material's base colour and alpha; linear, 65535 is 1. `tangent` is the direction
/// of increasing u of the normal texture, as a unit vector, and w is 1 or -1: w cross(normal, tangent) is the
/// direction of decreasing v. 32767 is 1. Only normal textures need it; zero means that there is none.
struct Vertex {
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec2 uv;
    glm::u16vec4 colour{65535};
    glm::i16vec4 tangent{0};
    bool operator==(const Vertex&) const = default;
};

/// Four of the joints that move a vertex, as indices into Skin::joints of animation.hpp, and how much: >= 0,
/// and relative to the sum of all weights of the vertex. Joints of weight 0 do nothing.
struct Influences {
    glm::u16vec4 joints{0};
    glm::vec4 weights{0.0F};
    bool operator==(const Influences&) const = default;
};

/// Offsets of the vertices, of which MorphWeights add a part. Each list is empty or has one for each vertex.
struct MorphTarget {
    std::vector<glm::vec3> positions;  ///< metres
    std::vector<glm::vec3> normals;
    std::vector<glm::vec3> tangents;  ///< of the tangents' directions, as vectors of length 1
    bool operator==(const MorphTarget&) const = default;
};

/// Indexed triangles of one material, counter-clockwise seen from the front. `indices.size()` is a multiple
/// of 3 and every index is below `vertices.size()`.
struct Primitive {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::shared_ptr<const Material> material;  ///< never null
    /// Lists with one item for each vertex, which has the joints of all lists. None: no skeleton moves it.
    std::vector<std::vector<Influences>> influences{};
    std::vector<MorphTarget> targets{};
    /// Other texture coordinates, by vertex, as Vertex::uv; needed if uses_second_uvs(*material), else empty
    /// or not looked at. A DeformedMesh keeps them.
    std::vector<glm::vec2> second_uvs{};
};

/// Immutable geometry, shared by its instances.
struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> morph_weights{};  ///< that instances have by default, one for each morph target
};

/// Whether the mesh may emit light.
[[nodiscard]] inline bool emits(const Mesh& mesh) {
    return std::ranges::any_of(mesh.primitives,
                               [](const Primitive& primitive) { return emits(*primitive.material); });
}

/// Whether surfaces of the mesh may be glossy.
[[nodiscard]] inline bool is_glossy(const Mesh& mesh) {
    return std::ranges::any_of(mesh.primitives,
                               [](const Primitive& primitive) { return is_glossy(*primitive.material); });
}

/// Whether light passes through surfaces of the mesh as through glass.
[[nodiscard]] inline bool is_glass(const Mesh& mesh) {
    return std::ranges::any_of(
        mesh.primitives, [](const Primitive& primitive) { return primitive.material->transmission > 0.0F; });
}

/// Whether surfaces of the mesh may be bumpy.
[[nodiscard]] inline bool is_bumpy(const Mesh& mesh) {
    return std::ranges::any_of(mesh.primitives,
                               [](const Primitive& primitive) { return is_bumpy(*primitive.material); });
}

/// Whether surfaces of the mesh have images that need Primitive::second_uvs.
[[nodiscard]] inline bool uses_second_uvs(const Mesh& mesh) {
    return std::ranges::any_of(
        mesh.primitives, [](const Primitive& primitive) { return uses_second_uvs(*primitive.material); });
}

/// A mesh placed by the entity's Transform. `mesh` is never null.
struct MeshInstance {
    std::shared_ptr<const Mesh> mesh;
    bool operator==(const MeshInstance&) const = default;
};

/// Radiance from all directions as an equirectangular picture, rows top to bottom, tightly packed: the top
/// row is +Y, the centre of the picture is -Z, and +X lies a quarter of the width to the right of it.
struct SkyPicture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<glm::vec3> texels;  ///< width × height; linear RGB, >= 0 and finite
};

/// Light from infinitely far away, from all directions that no surface hides; also the background. Of several
/// in a world, only one counts: see environment_of. The entity's Transform is ignored.
struct Environment {
    /// Linear, in cd/m² (or W/(sr m²), like the lights' units), each channel >= 0 and finite. Multiplied by
    /// the picture.
    glm::vec3 radiance{0.0F};
    std::shared_ptr<const SkyPicture> picture;  ///< null: the same radiance from everywhere
    float rotation = 0.0F;                      ///< of the picture, radians around +Y, from +Z towards +X
    bool operator==(const Environment&) const = default;
};

/// The first environment in the world's view whose radiance is not zero and that `accepts`, if given,
/// accepts; radiance 0 if there is none.
[[nodiscard]] CANDELA_API Environment
environment_of(const WorldReader& world, const std::function<bool(Entity, const Environment&)>& accepts = {});

/// The direction that a point of the sky's picture shows, without rotation: a unit vector. `at` is in [0,
/// 1]², (0, 0) the top left corner.
[[nodiscard]] CANDELA_API glm::vec3 sky_direction(glm::vec2 at);
/// The inverse.
[[nodiscard]] CANDELA_API glm::vec2 sky_position(glm::vec3 direction);

/// Viewpoint at the entity's origin looking along its -Z, +Y up.
struct Camera {
    enum class Projection : std::uint8_t { perspective, orthographic, custom };
    Projection projection = Projection::perspective;
    float vertical_fov = 0.785398163F;  ///< radians, perspective only; the width follows the target's aspect
    float half_height = 1.0F;           ///< metres, orthographic only (glTF's ymag)
    float near_plane = 0.01F;           ///< metres; > 0, or 0 too if orthographic
    float far_plane = std::numeric_limits<float>::infinity();  ///< metres; finite if orthographic
    /// Custom only: a projection that neither skews nor mirrors, as by glm::frustum or glm::ortho, for
    /// stereo, tiles and shifted lenses. Only what determines x and y is used; depth follows from the planes
    /// above. The aspect of the target does not change it.
    glm::mat4 matrix{1.0F};
    bool operator==(const Camera&) const = default;
};

/// Whether the camera's projection is orthographic, by its kind or by its matrix.
[[nodiscard]] inline bool is_orthographic(const Camera& camera) {
    return camera.projection == Camera::Projection::orthographic ||
           (camera.projection == Camera::Projection::custom && camera.matrix[3][3] != 0.0F);
}

}  // namespace candela
