#include "engine/scene/check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <span>
#include <variant>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/readable.hpp"

namespace candela {
namespace {

/// Of coordinates and scales. Squares of areas, as in the length of a cross product, must not overflow.
constexpr float most = 1e9F;

/// Of light in any unit. Its square times the area of a texel must not overflow, nor sums over all lights.
constexpr float brightest = 1e32F;

/// Radians. In a narrower cone, the rounding of directions would show.
constexpr float narrowest_cone = 1e-4F;

bool is_too_large(glm::vec3 vector) {
    return std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)}) > most;
}

/// How large a value may be.
enum class Limit : std::uint8_t { finite, infinite };

bool is_finite(std::span<const float> values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

template <class Vector>
bool is_finite(const Vector& vector) {
    return is_finite(std::span(&vector[0], static_cast<std::size_t>(Vector::length())));
}

bool is_amount(float value, Limit limit = Limit::finite) {
    return value >= 0.0F && (limit == Limit::infinite || std::isfinite(value));
}

bool is_amount(glm::vec3 colour) {
    return is_amount(colour.r) && is_amount(colour.g) && is_amount(colour.b);
}

Fault negative_or_infinite(std::string_view what) {
    return fmt::format("{} is negative or not finite", what);
}

Fault fault_of_brightness(std::string_view what, glm::vec3 light) {
    if (std::max({light.r, light.g, light.b}) > brightest) {
        return fmt::format("{} is above {:g}", what, brightest);
    }
    return {};
}

/// Of what all kinds of lights have.
template <class Light>
Fault fault_of_strength_and_range(const Light& light) {
    const LightTraits<Light>& kind = light_traits<Light>;
    if (!is_amount(light.colour)) return negative_or_infinite("the colour");
    if (!is_amount(strength_of(light))) {
        return negative_or_infinite(fmt::format("the {}", kind.strength_name));
    }
    if (!is_amount(light.colour * strength_of(light))) {
        return fmt::format("the product of colour and {} is not finite", kind.strength_name);
    }
    if (kind.range != nullptr && !is_amount(light.*kind.range, Limit::infinite)) {
        return "the range is negative or not a number";
    }
    return {};
}

/// Of what only this kind of light has.
template <class Light>
Fault fault_of_shape(const Light& /*light*/) {
    return {};
}

Fault fault_of_shape(const SpotLight& light) {
    if (!is_amount(light.inner_cone) || !is_amount(light.outer_cone)) return negative_or_infinite("a cone");
    if (light.outer_cone < narrowest_cone) {
        return fmt::format("the outer cone of {} is narrower than {:g} radians", light.outer_cone,
                           narrowest_cone);
    }
    return {};
}

/// `count` texels of an image of this size.
Fault fault_of_size(std::uint32_t width, std::uint32_t height, std::size_t count) {
    if (width == 0 || height == 0 || count != std::size_t{width} * height) {
        return fmt::format("{} texels for {} × {}", count, width, height);
    }
    return {};
}

Fault fault_of(const std::shared_ptr<const Image>& image, Encoding encoding, std::string_view name) {
    if (!image) return {};
    if (const Fault fault = fault_of_size(image->width, image->height, image->texels.size())) {
        return fmt::format("{} has {}", name, *fault);
    }
    if (image->encoding == encoding) return {};
    return fmt::format("{} is not encoded as {}", name,
                       encoding == Encoding::srgb ? "sRGB" : "linear values");
}

bool is_share(float x) {
    return x >= 0.0F && x <= 1.0F;
}

/// Of what makes a material glossy.
Fault fault_of_gloss(const Material& material) {
    if (!is_share(material.metalness)) return "the metalness is not between 0 and 1";
    if (!is_share(material.roughness)) return "the roughness is not between 0 and 1";
    if (!is_share(material.specular)) return "the specular strength is not between 0 and 1";
    if (!is_share(material.transmission)) return "the transmission is not between 0 and 1";
    if (!is_amount(material.specular_colour)) return negative_or_infinite("the specular colour");
    if (!is_amount(material.ior) || (material.ior > 0.0F && material.ior < 1.0F)) {
        return "the index of refraction is neither 0 nor a finite number of at least 1";
    }
    return {};
}

/// Of what makes a material bumpy.
Fault fault_of_bumps(const Material& material) {
    if (!std::isfinite(material.normal_scale)) return "the scale of the normal texture is not finite";
    if (!is_share(material.occlusion_strength)) return "the strength of occlusion is not between 0 and 1";
    if (Fault fault = fault_of(material.normal_texture, Encoding::linear, "the normal texture")) return fault;
    return fault_of(material.occlusion_texture, Encoding::linear, "the occlusion texture");
}

Fault fault_of(const Material& material) {
    if (!is_amount(glm::vec3(material.base_colour)) || !is_amount(material.base_colour.a)) {
        return negative_or_infinite("the base colour");
    }
    if (!is_amount(material.emissive)) return negative_or_infinite("the emission");
    if (!is_amount(material.alpha_cutoff, Limit::infinite)) {
        return "the alpha cutoff is negative or not a number";
    }
    if (Fault fault = fault_of_gloss(material)) return fault;
    if (Fault fault = fault_of_bumps(material)) return fault;
    if (Fault fault = fault_of(material.base_colour_texture, Encoding::srgb, "the base colour texture")) {
        return fault;
    }
    if (Fault fault =
            fault_of(material.metal_roughness_texture, Encoding::linear, "the metal-roughness texture")) {
        return fault;
    }
    return fault_of(material.emissive_texture, Encoding::srgb, "the emissive texture");
}

Fault fault_of(const Vertex& vertex, Strictness strictness) {
    if (!is_finite(vertex.position)) return "its position is not finite";
    if (is_too_large(vertex.position)) {
        return fmt::format("its position is farther than {:g} metres from the origin", most);
    }
    if (!is_finite(vertex.normal)) return "its normal is not finite";
    if (!is_finite(vertex.uv)) return "its texture coordinates are not finite";
    constexpr float tolerance = 0.01F;  // more than the rounding of normals that are stored in bytes
    if (strictness == Strictness::strict && std::abs(glm::length(vertex.normal) - 1.0F) > tolerance) {
        return fmt::format("its normal is {} long", glm::length(vertex.normal));
    }
    return {};
}

Fault fault_of(const std::vector<Vertex>& vertices, Strictness strictness) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (const Fault fault = fault_of(vertices[i], strictness)) {
            return fmt::format("vertex {}: {}", i, *fault);
        }
    }
    return {};
}

/// Of vertices with this material.
Fault fault_of_tangents(const std::vector<Vertex>& vertices, const Material& material) {
    if (!material.normal_texture) return {};
    const auto without = std::ranges::find(vertices, glm::i16vec4(0), &Vertex::tangent);
    if (without == vertices.end()) return {};
    return fmt::format("vertex {} has no tangent, which its normal texture needs: see derive_tangents",
                       without - vertices.begin());
}

Fault fault_of_second_uvs(const Primitive& primitive) {
    const std::size_t count = primitive.second_uvs.size();
    const bool may_be_empty = !uses_second_uvs(*primitive.material);
    if (count != primitive.vertices.size() && !(count == 0 && may_be_empty)) {
        return fmt::format("{} second texture coordinates for {} vertices", count, primitive.vertices.size());
    }
    const auto wrong =
        std::ranges::find_if_not(primitive.second_uvs, [](glm::vec2 uv) { return is_finite(uv); });
    if (wrong == primitive.second_uvs.end()) return {};
    return fmt::format("vertex {}: its second texture coordinates are not finite",
                       wrong - primitive.second_uvs.begin());
}

Fault fault_of(const Primitive& primitive, Strictness strictness) {
    if (!primitive.material) return "it has no material";
    if (const Fault fault = fault_of(*primitive.material)) {
        return fmt::format("material \"{}\": {}", readable(primitive.material->name), *fault);
    }
    if (primitive.indices.size() % 3 != 0) {
        return fmt::format("its {} indices make no whole number of triangles", primitive.indices.size());
    }
    const auto largest = std::ranges::max_element(primitive.indices);
    if (largest != primitive.indices.end() && *largest >= primitive.vertices.size()) {
        return fmt::format("index {}, but there are {} vertices", *largest, primitive.vertices.size());
    }
    if (Fault fault = fault_of(primitive.vertices, strictness)) return fault;
    if (Fault fault = fault_of_second_uvs(primitive)) return fault;
    return fault_of_tangents(primitive.vertices, *primitive.material);
}

Fault fault_of_lens(const Camera& camera) {
    constexpr float pi = std::numbers::pi_v<float>;
    const glm::mat4& m = camera.matrix;
    switch (camera.projection) {
        case Camera::Projection::orthographic:
            if (!(camera.half_height > 0.0F && std::isfinite(camera.half_height))) {
                return fmt::format("the half height of {} is not positive and finite", camera.half_height);
            }
            break;
        case Camera::Projection::custom: {
            const bool perspective = m[3][3] == 0.0F && m[2][3] < 0.0F;
            const bool orthographic = m[3][3] != 0.0F && m[2][3] == 0.0F;
            const bool skewed = m[0][1] != 0.0F || m[1][0] != 0.0F || m[0][3] != 0.0F || m[1][3] != 0.0F;
            if (!is_finite(std::span(&m[0][0], 16)) || m[0][0] == 0.0F || m[1][1] == 0.0F || skewed ||
                !(perspective || orthographic)) {
                return "the matrix is not a projection without skew";
            }
            // The fronts of triangles would be taken for their backs.
            if ((m[0][0] < 0.0F) != (m[1][1] < 0.0F)) return "the matrix mirrors the picture";
            break;
        }
        case Camera::Projection::perspective:
            if (!(camera.vertical_fov > 0.0F && camera.vertical_fov < pi)) {
                return fmt::format("the vertical field of view of {} is not between 0 and pi",
                                   camera.vertical_fov);
            }
            break;
    }
    return {};
}

Fault fault_of_planes(const Camera& camera) {
    if (is_orthographic(camera)) {
        if (!is_amount(camera.near_plane)) {
            return fmt::format("the near plane at {} is behind the camera or not finite", camera.near_plane);
        }
        if (!std::isfinite(camera.far_plane)) {
            return fmt::format("the far plane at {} is not finite", camera.far_plane);
        }
    } else if (!(camera.near_plane > 0.0F && std::isfinite(camera.near_plane))) {
        return fmt::format("the near plane at {} is not in front of the camera", camera.near_plane);
    }
    if (!(camera.far_plane > camera.near_plane)) {
        return fmt::format("the far plane at {} is not beyond the near plane at {}", camera.far_plane,
                           camera.near_plane);
    }
    return {};
}

}  // namespace

Fault fault_of(const Mesh& mesh, Strictness strictness) {
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        if (const Fault fault = fault_of(mesh.primitives[i], strictness)) {
            return fmt::format("primitive {} of mesh \"{}\": {}", i, readable(mesh.name), *fault);
        }
    }
    return {};
}

Fault fault_of(const DeformedMesh::Vertices& vertices, Strictness strictness) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (const Fault fault = fault_of(vertices[i], strictness)) {
            return fmt::format("primitive {}: {}", i, *fault);
        }
    }
    return {};
}

Fault fault_of_fit(const DeformedMesh& deformed, const Mesh& mesh) {
    if (!deformed.vertices) return "there are no vertices";
    if (deformed.vertices->size() != mesh.primitives.size()) {
        return fmt::format("{} lists of vertices, but mesh \"{}\" has {} primitives",
                           deformed.vertices->size(), readable(mesh.name), mesh.primitives.size());
    }
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const std::vector<Vertex>& vertices = (*deformed.vertices)[i];
        if (vertices.size() != mesh.primitives[i].vertices.size()) {
            return fmt::format("{} vertices, but primitive {} of mesh \"{}\" has {}", vertices.size(), i,
                               readable(mesh.name), mesh.primitives[i].vertices.size());
        }
        if (const Fault fault = fault_of_tangents(vertices, *mesh.primitives[i].material)) {
            return fmt::format("primitive {}: {}", i, *fault);
        }
    }
    return {};
}

Fault fault_of(const SkyPicture& picture) {
    if (const Fault fault = fault_of_size(picture.width, picture.height, picture.texels.size())) {
        return "the picture has " + *fault;
    }
    const auto wrong =
        std::ranges::find_if_not(picture.texels, [](glm::vec3 texel) { return is_amount(texel); });
    if (wrong != picture.texels.end()) {
        const auto i = static_cast<std::size_t>(wrong - picture.texels.begin());
        return fmt::format(
            "the picture holds a radiance that is negative or not finite, in column {} of row {}",
            i % picture.width, i / picture.width);
    }
    return {};
}

Fault fault_of(const AnyLight& light) {
    return std::visit(
        [](const auto& of_kind) {
            const Fault fault = fault_of_strength_and_range(of_kind);
            return fault ? fault : fault_of_shape(of_kind);
        },
        light);
}

Fault fault_of(const Environment& environment) {
    if (!is_amount(environment.radiance)) return negative_or_infinite("the radiance");
    if (!std::isfinite(environment.rotation)) return "the rotation is not finite";
    return {};
}

Fault fault_of(const Camera& camera) {
    const Fault fault = fault_of_lens(camera);
    return fault ? fault : fault_of_planes(camera);
}

Fault fault_of(const glm::mat4& world) {
    for (int column = 0; column < 4; ++column) {
        if (!is_finite(world[column])) return "the world matrix is not finite";
        if (column < 3 && is_too_large(world[column])) {
            return fmt::format("the world matrix scales by more than {:g}", most);
        }
    }
    if (is_too_large(world[3])) return fmt::format("it is farther than {:g} metres from the origin", most);
    return {};
}

Fault too_bright(const AnyLight& light) {
    return std::visit(
        []<class Light>(const Light& of_kind) {
            return fault_of_brightness(
                fmt::format("the product of colour and {}", light_traits<Light>.strength_name),
                of_kind.colour * strength_of(of_kind));
        },
        light);
}

Fault too_bright(const Environment& environment) {
    return fault_of_brightness("the radiance", environment.radiance);
}

Fault too_bright(const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const Material& material = *mesh.primitives[i].material;
        if (const Fault fault = fault_of_brightness("the emission", material.emissive)) {
            return fmt::format("primitive {} of mesh \"{}\": material \"{}\": {}", i, readable(mesh.name),
                               readable(material.name), *fault);
        }
    }
    return {};
}

float reach_of(const Mesh& mesh) {
    float reach = 0.0F;
    for (const Primitive& primitive : mesh.primitives) {
        for (const Vertex& vertex : primitive.vertices) {
            reach = std::max(reach, glm::length(vertex.position));
        }
    }
    return reach;
}

Fault fault_of_extent(const glm::mat4& world, float reach) {
    for (int row = 0; row < 3; ++row) {
        const glm::vec3 scale(world[0][row], world[1][row], world[2][row]);
        if (!(std::abs(world[3][row]) + glm::length(scale) * reach <= most)) {
            return fmt::format("it reaches farther than {:g} metres from the origin", most);
        }
    }
    return {};
}

}  // namespace candela
