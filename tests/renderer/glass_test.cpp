// Material::transmission against closed forms.

#include <doctest/doctest.h>

#include <numbers>

#include "tests/glass.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("glass") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{9, 9};
constexpr glm::vec3 green(0.2F, 0.9F, 0.5F);
constexpr glm::vec3 red(0.8F, 0.4F, 0.25F);
const glm::dvec3 wall(wall_radiance);

/// Colours are rounded to half floats, 5e-4, and the table of mirror_shares has a similar error.
bool is_close(glm::vec3 found, glm::dvec3 expected) {
    const glm::dvec3 error = glm::abs(glm::dvec3(found) - expected);
    const glm::dvec3 most = 0.002 * expected + 1e-6;
    return error.r <= most.r && error.g <= most.g && error.b <= most.b;
}

class Glass : public PathFixture {
 protected:
    /// In the middle.
    glm::vec3 seen(const Scene& scene) { return render(scene, size).at(size.x / 2, size.y / 2); }

    glm::vec3 through(const Material& material, float angle = 0.0F) {
        Scene scene = bright_wall(angle);
        add_pane(scene.world, 0.0F, material);
        return seen(scene);
    }
};

Material blended(glm::vec3 emitted, float alpha) {
    Material material = *emitter(emitted);
    material.alpha_mode = AlphaMode::blend;
    material.base_colour.a = alpha;
    return material;
}

}  // namespace

TEST_CASE_FIXTURE(Glass, "the light behind, times colour and transmission, and what is not mirrored") {
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(path);
        configure(linear_configuration(path));
        CHECK(is_close(seen(bright_wall()), wall));
        for (const float transmission : {0.4F, 1.0F}) {
            for (const float specular : {0.0F, 0.5F, 1.0F}) {
                const glm::vec3 found = through(glass(green, transmission, specular));
                CHECK(is_close(found, wall * let_through(green, transmission, specular)));
            }
        }
    }
    configure(linear_configuration());
    // At 1 rad Schlick's factor differs from that of the front.
    CHECK(is_close(through(glass(green, 1.0F, 1.0F), 1.0F), wall * let_through(green, 1.0F, 1.0F, 1.0)));
}

TEST_CASE_FIXTURE(Glass, "panes multiply, and show blended surfaces and cover them in the right order") {
    configure(linear_configuration());
    const glm::dvec3 a = let_through(green, 1.0F, 1.0F);
    const glm::dvec3 b = let_through(red, 0.7F);
    const glm::vec3 light(1.0F, 4.0F, 0.5F);
    for (const bool near_first : {true, false}) {
        const auto seen_through = [&](const Material& near, const Material& far) {
            Scene scene = bright_wall();
            if (near_first) add_pane(scene.world, 0.5F, near);
            add_pane(scene.world, -0.5F, far);
            if (!near_first) add_pane(scene.world, 0.5F, near);
            return seen(scene);
        };
        CHECK(is_close(seen_through(glass(green, 1.0F, 1.0F), glass(red, 0.7F)), a * b * wall));
        CHECK(is_close(seen_through(glass(red, 0.7F), blended(light, 0.3F)),
                       b * (0.3 * glm::dvec3(light) + 0.7 * wall)));
        CHECK(is_close(seen_through(blended(light, 0.3F), glass(red, 0.7F)),
                       0.3 * glm::dvec3(light) + 0.7 * (b * wall)));
    }
}

TEST_CASE_FIXTURE(Glass, "alpha blends only if the material says so, and cuts holes only with a mask") {
    configure(linear_configuration());
    Material material = glass(green, 1.0F);
    material.base_colour.a = 0.25F;
    const glm::dvec3 tint = let_through(green, 1.0F);
    CHECK(is_close(through(material), wall * tint));
    material.alpha_mode = AlphaMode::blend;
    CHECK(is_close(through(material), wall * (0.75 + 0.25 * tint)));
    material.alpha_mode = AlphaMode::mask;
    CHECK(is_close(through(material), wall));
    material.alpha_cutoff = 0.2F;
    CHECK(is_close(through(material), wall * tint));
}

TEST_CASE_FIXTURE(Glass, "metal lets no light through, and the back of single-sided glass is not there") {
    configure(linear_configuration());
    Material metal = glass(green, 1.0F);
    metal.metalness = 1.0F;
    CHECK(is_close(through(metal), glm::dvec3(0.0)));
    Scene scene = bright_wall();
    const Entity pane = add_pane(scene.world, 0.0F, glass(green, 1.0F));
    scene.world.edit<Transform>(
        pane, [](Transform& pose) { pose.rotation = glm::angleAxis(-1.57079633F, glm::vec3(1, 0, 0)); });
    CHECK(is_close(seen(scene), wall));
}

TEST_CASE_FIXTURE(Glass, "what passes is not reflected") {
    const auto reflected = [&](float transmission) {
        Scene scene;
        add_pane(scene.world, 0.0F, glass(red, transmission));
        add(scene.world, at({0, 0, 2}), PointLight{.intensity = 8.0F});
        scene.camera = add(scene.world, looking({0, 0, 1}, {0, 0, 0}), Camera{.vertical_fov = 0.01F});
        return seen(scene);
    };
    configure(direct_only());
    const glm::dvec3 whole = glm::dvec3(red) / std::numbers::pi * 8.0 / 4.0;
    CHECK(is_close(reflected(0.0F), whole));
    CHECK(is_close(reflected(0.75F), 0.25 * whole));
    CHECK(is_close(reflected(1.0F), glm::dvec3(0.0)));
}

TEST_CASE_FIXTURE(Glass, "it stops no light") {
    for (const ShadingPath path : {ShadingPath::deferred, ShadingPath::forward}) {
        configure(linear_configuration(path));
        Scene scene = ground();
        scene.world.set(scene.light, at({0, 4, 0}));
        scene.world.set(scene.light, PointLight{.intensity = 10.0F});
        const Picture expected = render(scene, {32, 24});
        add(scene.world, at({0, 3.5F, 0}),
            MeshInstance{square(2.0F, std::make_shared<const Material>(glass(red, 1.0F)))});
        renderer.invalidate();
        CHECK(render(scene, {32, 24}) == expected);
    }
}

TEST_CASE_FIXTURE(Glass, "all paths agree") {
    Scene scene = cornell_box();
    Material material = glass(green, 0.8F, 1.0F);
    material.roughness = 0.4F;
    add(scene.world, Transform{.translation = {0, 1, 0.3F}, .rotation = upright_at(0.0F).rotation},
        MeshInstance{square(0.4F, std::make_shared<const Material>(material))});
    check_paths(scene, {48, 48}, linear_configuration());
}

}  // TEST_SUITE("glass")
