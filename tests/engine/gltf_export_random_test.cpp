#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/tangents.hpp>
#include "tests/engine/saved_world.hpp"

TEST_SUITE("glTF export") {

using namespace candela;
using namespace candela::test;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Any finite float, from its bits.
float any_float() {
    const auto bits = *rc::gen::arbitrary<std::uint32_t>();
    float number = 0.0F;
    std::memcpy(&number, &bits, sizeof number);
    return std::isfinite(number) ? number : 0.0F;
}

float any_positive() {
    return std::max(std::abs(any_float()), std::numeric_limits<float>::min());
}

/// In [0, 1].
float any_fraction() {
    return float(*rc::gen::inRange(0, 10'000'001)) / 1e7F;
}

/// Of a size at which the product of two is finite.
float any_amount() {
    return std::ldexp(any_fraction(), *rc::gen::inRange(-40, 40));
}

glm::vec3 any_colour() {
    return {any_fraction(), any_fraction(), any_fraction()};
}

glm::vec3 any_direction() {
    const glm::vec3 direction(any_fraction() - 0.5F, any_fraction() - 0.5F, any_fraction() + 0.01F);
    return glm::normalize(direction);
}

bool any_bool() {
    return *rc::gen::arbitrary<bool>();
}

float any_range() {
    return any_bool() ? infinity : any_positive();
}

std::string any_name() {
    return *rc::gen::element<std::string>("", "lamp", "lamp", "\"quoted\"", "back\\slash", "a\nb\tc", "Ärger",
                                          "ランプ", "💡", std::string("nul\0nul", 7), "../a/b", " ", "%20");
}

glm::quat any_rotation() {
    return glm::angleAxis(any_fraction() * 6.0F, any_direction());
}

glm::vec3 any_scale() {
    const auto any = [] { return *rc::gen::element(1.0F, 0.0F, -1.0F, 0.1F, 1e-20F, any_float()); };
    return {any(), any(), any()};
}

Camera any_camera() {
    Camera camera;
    camera.near_plane = any_fraction() + 0.001F;
    camera.far_plane = camera.near_plane + 1.0F + any_amount();
    if (any_bool()) {
        camera.projection = Camera::Projection::orthographic;
        camera.half_height = any_positive();
        return camera;
    }
    camera.vertical_fov = 0.001F + 3.14F * any_fraction();
    camera.far_plane = any_bool() ? infinity : camera.far_plane;
    return camera;
}

SpotLight any_spot_light() {
    SpotLight light{any_colour(), any_positive(), any_range(), 0.0F, 0.0F, any_bool()};
    light.outer_cone = 0.01F + 1.56F * any_fraction();
    light.inner_cone = light.outer_cone * 0.999F * any_fraction();
    return light;
}

/// What instances, primitives and materials share.
struct Stock {
    std::vector<std::shared_ptr<const Image>> images{nullptr};
    std::vector<std::shared_ptr<const Image>> linear_images{nullptr};
    std::vector<std::shared_ptr<const Material>> materials;
    std::vector<std::shared_ptr<const Mesh>> meshes;
};

template <class T>
const T& any_of(const std::vector<T>& stock) {
    return stock[*rc::gen::inRange<std::size_t>(0, stock.size())];
}

Material any_material(const Stock& stock) {
    Material material;
    material.name = any_name();
    material.base_colour = glm::vec4(any_colour(), any_fraction());
    material.base_colour_texture = any_of(stock.images);
    if (any_bool()) {
        material.emissive = glm::vec3(any_amount(), any_amount(), any_positive());
        material.emissive_texture = any_of(stock.images);
    }
    material.metalness = any_fraction();
    material.roughness = any_fraction();
    material.metal_roughness_texture = any_of(stock.linear_images);
    material.normal_texture = any_of(stock.linear_images);
    if (material.normal_texture && any_bool()) material.normal_scale = any_float();
    material.occlusion_texture = any_of(stock.linear_images);
    if (material.occlusion_texture && any_bool()) material.occlusion_strength = any_fraction();
    if (any_bool()) material.transmission = any_fraction();
    material.specular = any_fraction();
    if (any_bool()) material.specular_colour = glm::vec3(any_amount(), any_amount(), any_positive());
    if (any_bool()) material.ior = any_bool() ? 0.0F : 1.0F + any_amount();
    material.double_sided = any_bool();
    material.alpha_mode = *rc::gen::element(AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend);
    material.alpha_cutoff = any_bool() ? 0.5F : any_amount();
    // The import calls those coordinates the first that the first texture has.
    if (material.base_colour_texture) {
        material.second_uvs = {.emissive = material.emissive_texture && any_bool(),
                               .metal_roughness = material.metal_roughness_texture && any_bool(),
                               .normal = material.normal_texture && any_bool(),
                               .occlusion = material.occlusion_texture && any_bool()};
    }
    return material;
}

/// Only materials with a normal texture have tangents.
Vertex any_vertex(bool is_white, bool has_tangent) {
    Vertex vertex{{any_amount(), any_amount(), -any_amount()}, any_direction(), {any_float(), any_float()}};
    if (!is_white) {
        vertex.colour =
            glm::u16vec4(*rc::gen::arbitrary<std::uint16_t>(), *rc::gen::arbitrary<std::uint16_t>(),
                         *rc::gen::arbitrary<std::uint16_t>(), *rc::gen::arbitrary<std::uint16_t>());
    }
    if (has_tangent) {
        vertex.tangent = packed_tangent(glm::vec4(any_direction(), any_bool() ? 1.0F : -1.0F));
    }
    return vertex;
}

/// Its triangles have areas, because the import drops those that have none.
Primitive any_primitive(const Stock& stock) {
    Primitive primitive;
    primitive.material = any_of(stock.materials);
    const bool has_tangents = primitive.material->normal_texture != nullptr;
    const bool is_white = any_bool();
    const auto triangles = *rc::gen::inRange<std::uint32_t>(1, 4);
    for (std::uint32_t corner = 0; corner < 3 * triangles; ++corner) {
        primitive.vertices.push_back(any_vertex(is_white, has_tangents));
        primitive.vertices.back().position[static_cast<int>(corner % 3)] += 1e13F;
        primitive.indices.push_back(corner);
    }
    primitive.vertices.push_back(any_vertex(is_white, has_tangents));  // one that no triangle uses
    for (Vertex& vertex : primitive.vertices) {
        vertex.position *= 1e-6F;  // at most 1e9 metres
        if (uses_second_uvs(*primitive.material)) primitive.second_uvs.emplace_back(any_float(), any_float());
    }
    return primitive;
}

Stock any_stock() {
    Stock stock;
    const auto any_wrap = [] {
        return *rc::gen::element(Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge);
    };
    for (std::uint32_t i = 1; i < 4; ++i) {
        stock.images.push_back(image(3 * i, i, *rc::gen::arbitrary<unsigned int>(), any_wrap(), any_wrap()));
        Image linear = *image(i, 2 * i, *rc::gen::arbitrary<unsigned int>(), any_wrap(), any_wrap());
        linear.encoding = Encoding::linear;
        stock.linear_images.push_back(std::make_shared<const Image>(std::move(linear)));
    }
    for (int i = 0; i < 3; ++i) {
        stock.materials.push_back(std::make_shared<const Material>(any_material(stock)));
    }
    for (int i = 0; i < 2; ++i) {
        Mesh mesh{any_name(), {}};
        for (int k = 0; k <= i; ++k) {
            mesh.primitives.push_back(any_primitive(stock));
        }
        stock.meshes.push_back(std::make_shared<const Mesh>(std::move(mesh)));
    }
    return stock;
}

void equip(World& world, Entity entity, const Stock& stock) {
    if (any_bool()) world.set(entity, MeshInstance{any_of(stock.meshes)});
    if (any_bool()) world.set(entity, any_camera());
    switch (*rc::gen::inRange(0, 4)) {
        case 0:
            world.set(entity, PointLight{any_colour(), any_positive(), any_range(), any_bool()});
            break;
        case 1:
            world.set(entity, any_spot_light());
            break;
        case 2:
            world.set(entity, DirectionalLight{any_colour(), any_positive(), any_bool()});
            break;
        default:
            break;
    }
}

/// The order of the entities is that in which an import makes them: after an entity come all below it.
World any_world() {
    World world;
    const Stock stock = any_stock();
    std::vector<Entity> branch{Entity{}};  // from the null entity, parent of the roots, to the last entity
    for (int i = *rc::gen::inRange(0, 8); i > 0; --i) {
        branch.resize(*rc::gen::inRange<std::size_t>(1, branch.size() + 1));
        const Entity entity = add(world, any_name(), branch.back());
        world.edit<Transform>(entity, [](Transform& transform) {
            transform.translation = {any_float(), any_float(), any_float()};
            transform.rotation = any_rotation();
            transform.scale = any_scale();
        });
        equip(world, entity, stock);
        branch.push_back(entity);
    }
    if (any_bool()) {
        const Entity sky = world.create();
        world.set(sky, Name{any_name()});
        world.set(sky, Environment{glm::vec3(any_amount(), any_amount(), any_positive()),
                                   any_bool() ? sky_picture() : nullptr, any_amount()});
    }
    return world;
}

}  // namespace

TEST_CASE("any world is the same after it was saved and opened" * doctest::test_suite("random")) {
    CHECK(rc::check("worlds are equal", [] { RC_ASSERT(difference_after(any_world()) == ""); }));
}

}  // TEST_SUITE("glTF export")
