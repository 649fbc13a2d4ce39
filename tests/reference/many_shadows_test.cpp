#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "tests/reference/pictures.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/study/measures.hpp"

TEST_SUITE("reference: many shadowed lights") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{49, 36};

void add_quad(Primitive& primitive, glm::vec3 centre, float half, float facing) {
    const auto first = static_cast<std::uint32_t>(primitive.vertices.size());
    for (const auto& [x, z] : {std::pair{-half, -half}, {-half, half}, {half, half}, {half, -half}}) {
        primitive.vertices.push_back({centre + glm::vec3(x, 0.0F, z * facing), {0.0F, facing, 0.0F}, {}});
    }
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) primitive.indices.push_back(first + corner);
}

MeshInstance mesh_of(Primitive primitive, std::shared_ptr<const Material> material) {
    primitive.material = std::move(material);
    return MeshInstance{std::make_shared<const Mesh>(Mesh{"", {std::move(primitive)}})};
}

/// A level roof of 4 m × 4 m, 1 m high, of quads that overlap and are smaller than the texels of the shadow
/// maps below: these decide nowhere, so that each light needs a ray.
MeshInstance roof() {
    constexpr int across = 40;
    constexpr float width = 4.0F / across;
    Primitive primitive;
    for (int x = 0; x < across; ++x) {
        for (int z = 0; z < across; ++z) {
            const glm::vec2 at = (glm::vec2(x, z) + 0.5F) * width - 2.0F;
            add_quad(primitive, {at.x, 1.0F, at.y}, 0.51F * width, -1.0F);
        }
    }
    return mesh_of(std::move(primitive), diffuse(glm::vec3(0.5F), true));
}

/// Two panes in one mesh, the upper one last.
MeshInstance panes() {
    Material glass;
    glass.base_colour = glm::vec4(0.7F, 0.5F, 0.6F, 0.5F);
    glass.alpha_mode = AlphaMode::blend;
    Primitive primitive;
    add_quad(primitive, {0.0F, 0.05F, 0.0F}, 0.7F, 1.0F);
    add_quad(primitive, {0.1F, 0.15F, 0.0F}, 0.5F, 1.0F);
    return mesh_of(std::move(primitive), std::make_shared<const Material>(std::move(glass)));
}

/// A floor under the roof, that many spot lights far above it, and below it a lamp that lights the floor.
Scene roofed(std::uint32_t spots) {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(1.0F, diffuse(glm::vec3(0.7F)))});
    add(scene.world, Transform{}, panes());
    add(scene.world, Transform{}, roof());
    for (std::uint32_t i = 0; i < spots; ++i) {
        const float angle =
            2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(spots);
        add(scene.world,
            looking({0.5F * std::cos(angle), 20.0F, 0.5F * std::sin(angle)}, {0.0F, 0.0F, 0.01F}),
            SpotLight{.intensity = 40.0F, .range = 30.0F, .inner_cone = 0.5F, .outer_cone = 0.7F});
    }
    add(scene.world, at({0.0F, 0.6F, 0.0F}), PointLight{.intensity = 0.3F});
    scene.camera = add(scene.world, looking({0.0F, 0.8F, 1.9F}, {0.0F, 0.1F, 0.0F}), Camera{});
    return scene;
}

class ManyShadows : public RenderFixture {
 protected:
    /// Every shading path shows what the tracer finds.
    void check(std::uint32_t spots) {
        CAPTURE(spots);
        const Scene scene = roofed(spots);
        const reference::Estimate truth =
            trace(reference::Scene(scene.world), scene.camera, {.size = size, .samples = 2, .bounces = 0});
        for (const ShadingPath path : all_shading_paths) {
            CAPTURE(to_string(path));
            Configuration configuration = linear_configuration(path);
            configuration.show = Show::direct;
            configuration.shadows.map_resolution = 16;
            configuration.shadows.cube_resolution = 16;
            configure(configuration);
            const tools::Picture picture = reference::flipped(render(scene, size));
            // Albedos are half floats with an error of 2⁻¹¹, of which a pixel here shows up to three.
            CHECK(study::measure(picture, truth.direct, truth.hit).rel_mse <= 3 * 2.4e-7);
        }
    }
};

}  // namespace

TEST_CASE_FIXTURE(ManyShadows, "each light has its ray, however many there are") {
    for (const std::uint32_t spots : {9U, 100U, 512U, 2048U}) check(spots);
}

TEST_CASE_FIXTURE(ManyShadows, "the same in one draw or dispatch, as on a driver that stops no loops") {
    pretend(renderer, false, endless_loops);
    // A software driver runs through the loops of so many lights at once, of four times as many it does not.
    for (const std::uint32_t spots : {9U, 100U, 512U}) check(spots);
}

TEST_CASE_FIXTURE(ManyShadows, "panes are lit by all lights, also if no loop can run through them at once") {
    Scene scene = roofed(1);
    for (int i = 0; i < 17'000; ++i) {
        const float x = static_cast<float>(i % 130) / 130.0F - 0.5F;
        const float z = static_cast<float>(i / 130) / 130.0F - 0.5F;
        add(scene.world, at({x, 0.5F, z}), PointLight{.intensity = 1e-3F, .casts_shadow = false});
    }
    Configuration configuration = linear_configuration();
    configuration.show = Show::direct;
    pretend(renderer, true);
    configure(configuration);
    const Picture whole = render(scene, size);
    pretend(renderer, true, software_loops / 3);
    renderer.invalidate();
    const Picture in_parts = render(scene, size);
    CHECK(in_parts.pixels != whole.pixels);  // sums in another order
    // 17,000 additions in single precision, each of which rounds by 2⁻²⁴, in random directions.
    CHECK(worst_error(in_parts, whole, 1e-3) <= 1e-4);
}

}  // TEST_SUITE("reference: many shadowed lights")
