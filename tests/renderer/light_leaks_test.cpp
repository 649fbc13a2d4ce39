#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("light leaks") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{160, 120};  // pixels are smaller than texels, and many of them are on creases
constexpr glm::uvec2 small{48, 36};

std::ptrdiff_t lit_pixels(const Picture& picture) {
    return std::ranges::count_if(picture.pixels,
                                 [](const glm::vec3& pixel) { return pixel != glm::vec3(0.0F); });
}

/// Above the ceiling, beside a wall, beyond an edge, and beyond a corner of the room.
constexpr std::array<glm::vec3, 5> outside{{{0.3F, 1.5F, 0.2F},
                                            {1.6F, 0.1F, -0.3F},
                                            {-1.02F, 0.5F, -0.4F},
                                            {0.2F, -1.3F, -1.4F},
                                            {1.2F, 1.3F, 1.4F}}};

/// Views of edges and corners of the room from its inside.
const std::array<Transform, 3> views{looking({0.0F, 0.0F, 0.9F}, {0.0F, 0.0F, 0.0F}),
                                     looking({0.7F, -0.2F, 0.6F}, {-0.9F, 0.8F, -0.7F}),
                                     looking({-0.5F, 0.9F, 0.3F}, {1.0F, -1.0F, 0.2F})};

Configuration direct_light(ShadingPath path) {
    Configuration configuration = linear_configuration(path);
    configuration.show = Show::direct;
    configuration.indirect = false;
    return configuration;
}

Configuration vpl_light(VplPlacement placement, VplVisibility method) {
    Configuration configuration = linear_configuration();
    configuration.show = Show::indirect;
    configuration.vpls = {.placement = placement, .count = 128, .bounces = 4};
    configuration.visibility = {.method = method, .map_resolution = 64};
    return configuration;
}

/// Moves everything.
void translate(World& world, glm::vec3 offset) {
    std::vector<Entity> all;
    for (const auto& [entity, transform] : world.view<Transform>()) all.push_back(entity);
    for (const Entity entity : all) {
        world.edit<Transform>(entity, [&](Transform& transform) { transform.translation += offset; });
    }
}

/// A closed room above a ground that a lamp outside lights: the room's walls hide both from its inside. The
/// camera is outside.
Scene room_above_ground() {
    Scene scene = furnace_box(0.5F);
    scene.world.set(scene.light, at({1.8F, -0.5F, 0.3F}));
    add(scene.world, at({0.0F, -1.5F, 0.0F}), MeshInstance{square(4.0F, diffuse(glm::vec3(0.8F)))});
    scene.world.set(scene.camera, looking({2.5F, 0.5F, 0.5F}, {2.0F, -1.5F, 0.3F}));
    return scene;
}

/// A box with these lower and upper corners.
void add_box(World& world, glm::vec3 lower, glm::vec3 upper,
             const std::shared_ptr<const Material>& material) {
    add(world, Transform{.translation = 0.5F * (lower + upper), .scale = 0.5F * (upper - lower)},
        MeshInstance{box_outwards(1.0F, material)});
}

/// A room of 4 m × 2.5 m × 3 m, around whose walls, slabs of 20 cm that only touch each other, lies
/// a ground in the sun, of the scene's light. There is a lamp of 60 cd in the room.
Scene room_in_the_sun() {
    constexpr float thickness = 0.2F;
    Scene scene;
    const auto material = diffuse(glm::vec3(0.8F));
    const glm::vec3 in_low(-2.0F, 0.0F, -1.5F), in_high(2.0F, 2.5F, 1.5F);
    const glm::vec3 low = in_low - thickness, high = in_high + thickness;
    add_box(scene.world, low, {high.x, in_low.y, high.z}, material);
    add_box(scene.world, {low.x, in_high.y, low.z}, high, material);
    add_box(scene.world, {low.x, in_low.y, low.z}, {in_low.x, in_high.y, high.z}, material);
    add_box(scene.world, {in_high.x, in_low.y, low.z}, {high.x, in_high.y, high.z}, material);
    add_box(scene.world, {in_low.x, in_low.y, low.z}, {in_high.x, in_high.y, in_low.z}, material);
    add_box(scene.world, {in_low.x, in_low.y, in_high.z}, {in_high.x, in_high.y, high.z}, material);
    add(scene.world, at({0.0F, low.y, 0.0F}), MeshInstance{square(12.0F, diffuse(glm::vec3(0.7F)))});
    add(scene.world, at({0.0F, 2.0F, 0.0F}), PointLight{.intensity = 60.0F});
    scene.light = add(scene.world, looking({2.0F, 3.0F, 1.0F}, {}), DirectionalLight{.illuminance = 1e5F});
    scene.camera =
        add(scene.world, looking({1.5F, 1.3F, 1.2F}, {-1.0F, 1.0F, -1.0F}), Camera{.vertical_fov = 1.4F});
    return scene;
}

class LightLeakTests : public RenderFixture {
 protected:
    /// Renders every view with the light at every place outside, as it is placed by `pose`.
    void check_dark(const Configuration& configuration, Scene& scene, Transform (*pose)(glm::vec3 lamp)) {
        configure(configuration);
        CAPTURE(to_string(configuration.path));
        for (const glm::vec3 lamp : outside) {
            for (const Transform& view : views) {
                scene.world.set(scene.light, pose(lamp));
                scene.world.set(scene.camera, view);
                CAPTURE(lamp.x);
                CAPTURE(view.translation.x);
                CHECK(lit_pixels(render(scene, size)) == 0);
            }
        }
    }

    /// Checks that the room has at most this share of the brightness of the ground outside.
    void check_dark_at(glm::vec3 offset, const Configuration& configuration, double most) {
        CAPTURE(to_string(configuration.show));
        CAPTURE(to_string(configuration.visibility.method));
        CAPTURE(to_string(configuration.vpls.placement));
        Configuration of_ground = configuration;
        of_ground.show = Show::direct;
        configure(of_ground);
        Scene scene = room_above_ground();
        translate(scene.world, offset);
        const double bright = mean(render(scene, small));
        REQUIRE(bright > 0.01);
        configure(configuration);
        for (const Transform& view : views) {
            CAPTURE(view.translation.x);
            Transform moved = view;
            moved.translation += offset;
            scene.world.set(scene.camera, moved);
            CHECK(mean(render(scene, small)) <= most * bright);
        }
    }
};

Transform towards_room(glm::vec3 lamp) {
    return looking(lamp, {0.0F, 0.0F, 0.0F});
}

}  // namespace

TEST_CASE_FIXTURE(LightLeakTests, "no pixel of a closed room of single walls is lit by a lamp outside") {
    Scene scene = furnace_box(0.5F);
    for (const ShadingPath path : {ShadingPath::deferred, ShadingPath::forward}) {
        const Configuration configuration = direct_light(path);
        check_dark(configuration, scene, [](glm::vec3 lamp) { return at(lamp); });
        Scene other = scene;
        other.world.remove<PointLight>(other.light);
        // A cube map, a flat map, and that of parallel light.
        other.world.set(other.light, SpotLight{.inner_cone = 1.2F, .outer_cone = 1.3F});
        check_dark(configuration, other, towards_room);
        other.world.set(other.light, SpotLight{.inner_cone = 0.8F, .outer_cone = 0.9F});
        check_dark(configuration, other, towards_room);
        other.world.remove<SpotLight>(other.light);
        other.world.set(other.light, DirectionalLight{.illuminance = 5.0F});
        check_dark(configuration, other, towards_room);
    }
}

TEST_CASE_FIXTURE(LightLeakTests, "a closed room stays dark, at the origin and 100 km away") {
    for (const glm::vec3 offset : {glm::vec3(0.0F), glm::vec3(1e5F, -1e5F, 1e5F)}) {
        CAPTURE(offset.x);
        CAPTURE(offset.y);
        check_dark_at(offset, direct_light(ShadingPath::deferred), 0.0);
        Configuration indirect = linear_configuration();
        indirect.show = Show::indirect;
        indirect.visibility = {.method = VplVisibility::rays, .map_resolution = 64};
        indirect.vpls.count = 128;
        indirect.vpls.placement = VplPlacement::paths;
        check_dark_at(offset, indirect, 0.0);
        // Far away, coordinates are multiples of 8 mm. The points of surfels within half of that of a
        // wall's foot are rounded onto the other wall: 0.4 % of those of a wall of 2 m.
        const double most_of_surfels = offset == glm::vec3(0.0F) ? 0.0 : 4e-3;
        indirect.vpls.placement = VplPlacement::surfels;
        check_dark_at(offset, indirect, most_of_surfels);
        // A texel of a map that sees past a wall's edge lights what is just behind that edge.
        indirect.visibility.method = VplVisibility::maps;
        check_dark_at(offset, indirect, std::max(5e-4, most_of_surfels));
    }
}

TEST_CASE_FIXTURE(LightLeakTests, "what a plane hides gets no light from VPLs behind it") {
    // Ground, a plate above it and a ceiling just above the plate. Seen from below the plate is culled, but
    // it is in the way of light.
    constexpr float gap = 0.005F;
    const glm::quat downwards = glm::angleAxis(glm::pi<float>(), glm::vec3(1, 0, 0));
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(1.0F, diffuse(glm::vec3(0.8F)))});
    add(scene.world, at({0, 1, 0}), MeshInstance{square(4.0F, diffuse(glm::vec3(0.8F)))});
    add(scene.world, Transform{.translation = {0, 1.0F + gap, 0}, .rotation = downwards},
        MeshInstance{square(4.0F, diffuse(glm::vec3(0.8F)))});
    scene.light = add(scene.world, at({0.1F, 0.5F, 0.2F}), PointLight{});
    scene.camera = add(scene.world, looking({0.0F, 0.6F, 0.0F}, {0.0F, 2.0F, 0.0F}, {0, 0, 1}), Camera{});
    const auto light_by = [&](VplVisibility method) {
        configure(vpl_light(VplPlacement::paths, method));
        return mean(render(scene, small));
    };
    const double unhidden = light_by(VplVisibility::none);
    REQUIRE(unhidden > 0.0);
    CHECK(light_by(VplVisibility::rays) == 0.0);
    CHECK(light_by(VplVisibility::maps) == 0.0);
}

TEST_CASE_FIXTURE(LightLeakTests,
                  "a room behind a thin wall of a lit one gets half a thousandth of its light at most") {
    for (const float thickness : {0.01F, 0.001F}) {
        CAPTURE(thickness);
        Scene scene = furnace_box(0.5F);
        const glm::vec3 beyond(2.0F + thickness, 0.0F, 0.0F);
        add(scene.world, at(beyond), MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.8F)))});
        scene.world.set(scene.light, at(beyond + glm::vec3(0.2F, 0.3F, -0.1F)));
        for (const VplPlacement placement : {VplPlacement::surfels, VplPlacement::paths}) {
            CAPTURE(to_string(placement));
            for (const VplVisibility method : {VplVisibility::maps, VplVisibility::rays}) {
                CAPTURE(to_string(method));
                configure(vpl_light(placement, method));
                scene.world.set(scene.camera, looking(beyond + glm::vec3(0.0F, 0.0F, 0.9F), beyond));
                const double bright = mean(render(scene, small));
                REQUIRE(bright > 0.1);
                // Texels that see both the wall and the floor in front of it let some light through.
                const bool maps = method == VplVisibility::maps;
                const double most = maps ? 5e-4 * bright : 0.0;
                for (const Transform& view : {looking({-0.5F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}),
                                              looking({0.2F, -0.2F, 0.1F}, {1.0F, -1.0F, 0.7F})}) {
                    scene.world.set(scene.camera, view);
                    CHECK(mean(render(scene, maps ? size : size / 2U)) <= most);
                }
            }
        }
    }
}

TEST_CASE_FIXTURE(LightLeakTests, "the sun outside of a room with a lamp adds nothing to its light") {
    Configuration configuration = vpl_light(VplPlacement::surfels, VplVisibility::maps);
    configuration.vpls.count = 512;
    configure(configuration);
    Scene scene = room_in_the_sun();
    const Picture in_sun = render(scene, size);
    scene.world.set(scene.light, DirectionalLight{.illuminance = 0.0F});
    const Picture alone = render(scene, size);
    REQUIRE(mean(alone) > 1.0);
    // A hundredth is less than an eye sees. The sun may make the guide choose other surfels.
    CHECK(mean(in_sun) <= 1.01 * mean(alone));
    std::size_t brighter = 0;
    for (std::size_t i = 0; i < alone.pixels.size(); ++i) {
        if (in_sun.pixels[i].g > 1.01F * alone.pixels[i].g) ++brighter;
    }
    CHECK(brighter == 0);
}

TEST_CASE_FIXTURE(GlFixture, "a scene so far from the origin that rounding shows is warned of once") {
    std::vector<std::string> lines;
    TestedRenderer renderer(context->get_proc(),
                            {.log = [&](std::string_view line) { lines.emplace_back(line); }});
    REQUIRE(renderer.configure(linear_configuration()).empty());
    const RenderTarget target(device, {16, 12});
    for (const float away : {0.0F, 1e3F, 1e5F, 1.1e5F}) {
        Scene scene = room_above_ground();
        translate(scene.world, {away, 0.0F, 0.0F});
        renderer.render(scene.world, scene.camera, target.target());
        CHECK(lines.size() == (away < 1e5F ? 0 : 1));
    }
    CHECK(lines.front() ==
          "the scene is so far from the origin that positions are rounded to 7.8 mm: light may leak "
          "where surfaces meet and through thin walls");
}

}  // TEST_SUITE("light leaks")
