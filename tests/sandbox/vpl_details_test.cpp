#include "sandbox/panels/vpl_details.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

TEST_SUITE("vpl details") {

namespace {

/// On a floor at y = 0, with a cube over it at the right, and lights.
struct Lit {
    World world;
    tools::SceneRays surfaces;
    VplDot vpl{.position = {0.0F, 0.0F, 0.0F}, .normal = {0.0F, 1.0F, 0.0F}};

    Lit() {
        add_mesh(world, square(10.0F),
                 {.rotation = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1.0F, 0.0F, 0.0F))});
        add_mesh(world, cube(0.5F), {.translation = {2.0F, 2.0F, 0.0F}});
    }
    std::vector<LightOfVpl> lights() {
        surfaces.update_and_wait(world);
        return lights_of(world, surfaces, vpl);
    }
};

constexpr float rounding = 1e-2F;  // a VPL's rays start a millimetre above it

}  // namespace

TEST_CASE("lights are found by the irradiance of the inverse square and the cosine, the strongest first") {
    Lit lit;
    // 1 cd at 45 degrees and a distance of 2·sqrt(2): cos / r² = 0.7071 / 8. Straight above at 2 m: 1 / 4.
    const Entity aside = add_point_light(lit.world, {-2.0F, 2.0F, 0.0F});
    const Entity above = add_point_light(lit.world, {0.0F, 2.0F, 0.0F});
    add_point_light(lit.world, {4.0F, 4.0F, 0.0F});   // behind the cube
    add_point_light(lit.world, {1.0F, -2.0F, 0.0F});  // below the floor
    const auto lights = lit.lights();
    REQUIRE(lights.size() == 2);
    CHECK(lights[0].light == above);
    CHECK(std::abs(lights[0].illuminance / 0.25F - 1.0F) < rounding);
    CHECK(lights[1].light == aside);
    CHECK(std::abs(lights[1].illuminance / (std::sqrt(0.5F) / 8.0F) - 1.0F) < rounding);
    lit.world.edit<PointLight>(above, [](PointLight& light) { light.range = 1.9F; });
    CHECK(lit.lights().size() == 1);
}

TEST_CASE("spot lights shine within their cones, suns from far away, and not through the roof") {
    Lit lit;
    const Entity spot = lit.world.create();
    lit.world.set(spot, Transform{.translation = {0.0F, 2.0F, 0.0F}});
    lit.world.set(spot, SpotLight{.inner_cone = 0.2F, .outer_cone = 0.3F});
    CHECK(lit.lights().empty());  // it shines along -z
    const glm::quat down = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1.0F, 0.0F, 0.0F));
    lit.world.edit<Transform>(spot, [&](Transform& transform) { transform.rotation = down; });
    REQUIRE(lit.lights().size() == 1);
    CHECK(std::abs(lit.lights().front().illuminance / 0.25F - 1.0F) < rounding);
    lit.world.remove<SpotLight>(spot);
    lit.world.set(spot, DirectionalLight{.illuminance = 3.0F});
    REQUIRE(lit.lights().size() == 1);
    CHECK(std::abs(lit.lights().front().illuminance / 3.0F - 1.0F) < rounding);
    lit.vpl.position = {2.0F, 0.0F, 0.0F};
    CHECK(lit.lights().empty());
}

TEST_CASE("the nearest VPLs are others, in the order of their distances") {
    std::vector<VplDot> vpls(5);
    for (std::size_t i = 0; i < vpls.size(); ++i) vpls[i].position.x = static_cast<float>(i * i);
    const auto near = nearest_vpls(vpls, 2, 3);  // at 4; the others at 0, 1, 9 and 16
    REQUIRE(near.size() == 3);
    CHECK(near[0].index == 1);
    CHECK(near[0].distance == 3.0F);
    CHECK(near[1].index == 0);
    CHECK(near[2].index == 3);
    CHECK(nearest_vpls(vpls, 0, 9).size() == 4);
    CHECK(nearest_vpls({vpls[0]}, 0, 9).empty());
    CHECK(vpl_at(vpls, {3.0F, 0.0F, 0.1F}) == 2);
    CHECK_FALSE(vpl_at({}, glm::vec3(0.0F)));
}

TEST_CASE("the details name the light") {
    Lit lit;
    const Entity lamp = add_point_light(lit.world, {0.0F, 2.0F, 0.0F});
    lit.world.set(lamp, Name{"lamp"});
    static_cast<void>(lit.lights());
    const std::string words = details_of(lit.world, lit.surfaces, {lit.vpl, VplDot{}}, 0);
    CHECK(words.find("\n    lamp: 0.25") != std::string::npos);
    CHECK(words.find("\n    VPL 1: 0 m") != std::string::npos);
}
}  // TEST_SUITE("vpl details")

}  // namespace candela::sandbox
