#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include <candela/scene/tangents.hpp>
#include "tests/reference/pictures.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("reference: bumpy surfaces") {

using namespace candela;
using reference::Estimate;

namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr glm::uvec2 size{9, 9};  // the middle pixel looks along the camera's axis
constexpr std::size_t middle = 9 * 4 + 4;

/// A texture that is the same everywhere.
std::shared_ptr<const Image> texture(glm::u8vec4 texel) {
    return std::make_shared<const Image>(
        Image{.width = 1, .height = 1, .texels = {texel}, .encoding = Encoding::linear});
}

/// What a channel of 8 bits says in a normal texture.
float decoded(int channel) {
    return 2.0F * float(channel) / 255.0F - 1.0F;
}

constexpr glm::u8vec4 tilt(220, 80, 200, 255);

/// The tilted normal in the space of tangent, bitangent and normal.
glm::vec3 tilted(float scale = 1.0F) {
    return glm::normalize(glm::vec3(scale * decoded(tilt.r), scale * decoded(tilt.g), decoded(tilt.b)));
}

Material bumpy(float scale = 1.0F) {
    Material material = *diffuse(glm::vec3(0.5F), true);
    material.normal_texture = texture(tilt);
    material.normal_scale = scale;
    return material;
}

/// A square of 2 m × 2 m around the origin that faces +Y. Its u grows along X and its v along Z, or as
/// `direction` says.
std::shared_ptr<const Mesh> patch(Material material, glm::vec2 direction = {1.0F, 1.0F}) {
    Mesh mesh = *square(1.0F, std::make_shared<const Material>(std::move(material)));
    for (Vertex& vertex : mesh.primitives[0].vertices) vertex.uv *= direction;
    derive_tangents(mesh.primitives[0]);
    return std::make_shared<const Mesh>(std::move(mesh));
}

constexpr glm::vec3 to_light(0.48F, 0.8F, 0.36F);

/// The patch from above, or from below, under parallel light of π lx that goes through it from the viewer's
/// side.
Scene lit(std::shared_ptr<const Mesh> mesh, Transform pose = {}, bool from_above = true) {
    const float side = from_above ? 1.0F : -1.0F;
    Scene scene;
    add(scene.world, pose, MeshInstance{std::move(mesh)});
    scene.camera = add(scene.world, looking({0, 3.0F * side, 0}, {0, 0, 0}, {0, 0, -1}), Camera{});
    scene.light = add(scene.world, looking(side * to_light, {0, 0, 0}), DirectionalLight{.illuminance = pi});
    return scene;
}

Estimate traced(const Scene& scene, std::uint32_t samples = 2) {
    return trace(reference::Scene(scene.world), scene.camera, {.size = size, .samples = samples});
}

/// The direct light at the middle pixel. It is grey here.
double seen(const Scene& scene, std::uint32_t samples = 2) {
    return static_cast<double>(traced(scene, samples).direct.pixels[middle].g);
}

/// The radiance of a surface of albedo 1/2 with this normal.
doctest::Approx under_the_light(glm::vec3 normal) {
    // Tangents are rounded to 16 bits.
    return doctest::Approx(0.5F * glm::dot(normal, to_light)).epsilon(1e-4);
}

}  // namespace

TEST_CASE("a normal texture turns the normal that light is weighted with") {
    const glm::vec3 n = tilted();
    // The tangent is +X, the bitangent, up in the picture, -Z.
    CHECK(seen(lit(patch(bumpy()))) == under_the_light({n.x, n.z, -n.y}));
    const glm::vec3 steeper = tilted(2.0F);
    CHECK(seen(lit(patch(bumpy(2.0F)))) == under_the_light({steeper.x, steeper.z, -steeper.y}));
    CHECK(seen(lit(patch(bumpy(0.0F)))) == under_the_light({0, 1, 0}));
}

TEST_CASE("where texture coordinates are mirrored, it tilts the other way") {
    const glm::vec3 n = tilted();
    CHECK(seen(lit(patch(bumpy(), {-1, 1}))) == under_the_light({-n.x, n.z, -n.y}));
    CHECK(seen(lit(patch(bumpy(), {1, -1}))) == under_the_light({n.x, n.z, n.y}));
}

TEST_CASE("a mirrored instance is its mirror image, and a turned one is turned") {
    const glm::vec3 n = tilted();
    CHECK(seen(lit(patch(bumpy()), {.scale = {-1, 1, 1}})) == under_the_light({-n.x, n.z, -n.y}));
    const glm::quat turn = glm::angleAxis(pi / 2.0F, glm::vec3(0, 1, 0));  // +X becomes -Z, -Z becomes -X
    CHECK(seen(lit(patch(bumpy()), {.rotation = turn})) == under_the_light({-n.y, n.z, -n.x}));
}

TEST_CASE("seen from behind, a bump is a dent") {
    const glm::vec3 n = tilted();
    // Light, viewer and normal are those of the front, turned round.
    CHECK(seen(lit(patch(bumpy()), {}, false)) == under_the_light({n.x, n.z, -n.y}));
}

TEST_CASE("a light behind the triangle does not light it, however its normal is tilted") {
    Scene scene = lit(patch(bumpy(4.0F)));
    scene.world.set(scene.light, looking({1, -0.1F, 0}, {0, 0, 0}));
    CHECK(seen(scene) == 0.0);
}

TEST_CASE("a smooth surface is turned as a whole") {
    Material metal = *diffuse(glm::vec3(0.8F));
    metal.metalness = 1.0F;
    metal.roughness = 0.3F;
    const auto picture = [&](bool by_texture) {
        Material material = metal;
        if (by_texture) material.normal_texture = texture(tilt);
        Mesh mesh = *patch(material);
        const glm::vec3 n = tilted();
        for (Vertex& vertex : mesh.primitives[0].vertices) {
            if (!by_texture) vertex.normal = {n.x, n.z, -n.y};
        }
        return seen(lit(std::make_shared<const Mesh>(std::move(mesh))));
    };
    CHECK(picture(true) > 0.0);
    CHECK(picture(true) == doctest::Approx(picture(false)).epsilon(1e-3));
}

TEST_CASE("occlusion dims the light of the sky, by the strength that it has") {
    const auto with = [](std::uint8_t red, float strength) {
        Material material = *diffuse(glm::vec3(0.5F));
        material.occlusion_texture = texture({red, 255, 255, 255});
        material.occlusion_strength = strength;
        Scene scene = lit(patch(material));
        scene.world.remove<DirectionalLight>(scene.light);
        add(scene.world, Environment{.radiance = glm::vec3(2.0F), .picture = nullptr});
        return seen(scene, 64);
    };
    // The same random numbers. What the sky gives without occlusion is tested with the closed forms.
    const double open = with(255, 1.0F);
    CHECK(open > 0.0);
    CHECK(with(51, 1.0F) == doctest::Approx(0.2 * open));
    CHECK(with(51, 0.5F) == doctest::Approx(0.6 * open));
    CHECK(with(51, 0.0F) == doctest::Approx(open));
}

TEST_CASE("occlusion leaves the light of lights and what the surface emits as they are") {
    Material material = *diffuse(glm::vec3(0.5F));
    material.occlusion_texture = texture({0, 255, 255, 255});
    CHECK(seen(lit(patch(material))) == under_the_light({0, 1, 0}));
    material.emissive = glm::vec3(3.0F);
    CHECK(seen(lit(patch(material))) == doctest::Approx(3.0F + 0.5F * to_light.y));
}

TEST_CASE("occlusion dims indirect light") {
    const auto indirect = [](std::shared_ptr<const Image> occlusion) {
        Scene scene = furnace_box(0.5F);
        Material material = *diffuse(glm::vec3(0.5F));
        material.occlusion_texture = std::move(occlusion);
        scene.world.set(scene.camera, looking({0, 0.5F, 0}, {0, -1, 0}, {0, 0, -1}));
        add(scene.world, at({0, -0.9F, 0}), MeshInstance{patch(material)});
        return traced(scene, 16).indirect.pixels[middle].g;
    };
    // The same random numbers: other surfaces see this one without occlusion.
    CHECK(indirect(texture({51, 255, 255, 255})) == doctest::Approx(0.2F * indirect(nullptr)));
}

}  // TEST_SUITE("reference: bumpy surfaces")
