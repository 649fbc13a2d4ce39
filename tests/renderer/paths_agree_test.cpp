// Every shading path gives the picture of forward with all lights: a table of scenes and settings. A row has
// only the lights that it is about, so that a list that misses one is noticed.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("paths agree") {

using namespace candela;

namespace {

/// Whole tiles, and tiles that are cut by both edges of the picture.
constexpr glm::uvec2 few_tiles{52, 36};

struct Row {
    std::string name;
    Scene scene;
    Configuration configuration = direct_only();
    glm::uvec2 size = few_tiles;
};

using Rows = std::vector<Row>;

constexpr glm::vec3 forwards{0, 0, -1};

struct Point {
    glm::vec3 position;
    float range;
};

Scene room_with(const std::vector<Point>& points, const Camera& camera = {}) {
    Scene scene = cluttered_room();
    scene.world.set(scene.camera, camera);
    for (const Point& point : points) {
        add(scene.world, at(point.position), PointLight{.range = point.range});
    }
    return scene;
}

Scene room_with_ranged_lights() {
    Scene scene = cluttered_room();
    add_ranged_lights(scene.world, 40, 0.8F);
    return scene;
}

/// Lights around and behind the camera, and across the planes of the view frustum.
Rows lights_around_the_view() {
    return {{"around the eye", room_with({{eye, 2.0F}, {eye + glm::vec3(0.1F, -0.05F, 0.02F), 1.0F}})},
            // The second one does not reach visible surfaces.
            {"behind the eye", room_with({{eye - 0.3F * forwards, 1.2F}, {eye - 0.4F * forwards, 0.3F}})},
            {"beside the view, reaching into it",
             room_with({{{1.9F, 0.0F, 1.4F}, 1.5F}, {{0.0F, -1.9F, 1.6F}, 2.0F}})},
            {"across the near plane", room_with({{eye + 0.5F * forwards, 0.4F},
                                                 {eye + 0.3F * forwards, 0.5F},
                                                 {eye + 0.8F * forwards, 0.35F}},
                                                {.near_plane = 0.5F})},
            {"beyond the far plane",
             room_with({{eye + 2.2F * forwards, 1.0F}, {eye + 3.4F * forwards, 2.0F}}, {.far_plane = 2.0F})},
            {"reaching across the whole world", room_with({{{0, 1, 0}, 1e6F}})}};
}

Scene light_of_a_millimetre() {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(4.0F, diffuse(glm::vec3(0.5F)))});
    scene.camera = add(scene.world, looking({1.0F, 0.004F, 1.0F}, {1.0F, 0.0F, 1.0F}, {0, 0, -1}),
                       Camera{.near_plane = 1e-4F});
    add(scene.world, at({1.0005F, 0.0005F, 1.0F}), PointLight{.range = 1e-3F});
    return scene;
}

Scene camera_in_a_wall(const Transform& wall) {
    Scene scene = room_with({{eye + glm::vec3(0.2F, 0.3F, 0.05F), 0.4F}});
    add_ranged_lights(scene.world, 30, 0.8F);
    add(scene.world, wall, MeshInstance{box_inwards(1.0F, diffuse({0.5F, 0.7F, 0.5F}, true))});
    return scene;
}

Scene orthographic(float near_plane, float far_plane) {
    Scene scene = room_with_ranged_lights();
    add(scene.world, at(eye + glm::vec3(0.0F, 0.0F, 0.4F)), PointLight{.range = 1.0F});
    scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                         .half_height = 1.2F,
                                         .near_plane = near_plane,
                                         .far_plane = far_plane});
    return scene;
}

Scene narrow_and_wide_spots() {
    constexpr float pi = std::numbers::pi_v<float>;
    Scene scene = cluttered_room();
    std::mt19937 engine(5);
    std::uniform_real_distribution<float> number(-1.5F, 1.5F);
    const auto place = [&] {
        const float x = number(engine), y = number(engine);
        return glm::vec3(x, y, number(engine));
    };
    for (const float outer : {0.02F, 0.1F, 0.5F, pi / 4.0F, 0.8F, 1.3F, pi / 2.0F}) {
        for (const float inner : {0.0F, 0.99F * outer}) {
            for (const float range : {0.5F, 3.0F, 1e6F}) {
                const glm::vec3 from = place();
                add(scene.world, looking(from, place()),
                    SpotLight{.intensity = 0.5F, .range = range, .inner_cone = inner, .outer_cone = outer});
            }
        }
    }
    return scene;
}

Rows cameras_and_lights() {
    return {{"a light with a range of one millimetre", light_of_a_millimetre()},
            {"a camera inside a wall", camera_in_a_wall({.translation = eye, .scale = {3.0F, 3.0F, 0.1F}})},
            {"a camera in the plane of a wall",
             camera_in_a_wall({.translation = eye - glm::vec3(0, 0.1F, 0), .scale = {0.5F, 0.1F, 0.5F}})},
            {"orthographic", orthographic(0.0F, 10.0F)},
            {"orthographic, between near planes", orthographic(1.0F, 2.5F)},
            {"spots", narrow_and_wide_spots()},
            {"spots, in a high picture", narrow_and_wide_spots(), direct_only(), {25, 50}}};
}

Rows shapes_of_targets() {
    Rows rows;
    for (const glm::uvec2 size : {glm::uvec2(109, 71), glm::uvec2(1, 1), glm::uvec2(4096, 1),
                                  glm::uvec2(1, 300), glm::uvec2(16, 16), glm::uvec2(17, 15)}) {
        rows.push_back({"a target", room_with_ranged_lights(), direct_only(), size});
    }
    return rows;
}

Rows sizes_of_cells() {
    Rows rows;
    for (const std::uint32_t tile_size : {16U, 32U, 64U}) {
        for (const std::uint32_t slices : {2U, 64U}) {
            Configuration configuration = direct_only();
            configuration.lists = {.tile_size = tile_size, .slices = slices};
            rows.push_back({"tiles of " + std::to_string(tile_size) + ", slices " + std::to_string(slices),
                            room_with_ranged_lights(),
                            configuration,
                            {100, 70}});
        }
    }
    return rows;
}

Rows shipped_with_many_lights() {
    return {{"glass", shipped_scene("glass")},
            {"hall-256", shipped_scene("hall-256")},
            {"fins", shipped_scene("fins")}};
}

/// The Cornell box with further spot, directional and point lights of all colours in turn.
Scene lights_of_all_kinds() {
    Scene scene = cornell_box();
    constexpr int count = 13;
    const auto spread = [](int i, float step) { return std::fmod(static_cast<float>(i) * step, 1.0F); };
    for (int i = 1; i < count; ++i) {
        const glm::vec3 position(1.6F * spread(i, 0.618F) - 0.8F, 0.2F + 1.6F * spread(i, 0.382F),
                                 1.6F * spread(i, 0.755F) - 0.8F);
        const glm::vec3 colour(spread(i, 0.57F), spread(i, 0.31F), spread(i, 0.83F));
        constexpr float strength = 4.0F / count;
        const Transform pose = looking(position, {0.1F, 0.9F, 0.05F});
        if (i % 3 == 0) {
            add(scene.world, pose, PointLight{.colour = colour, .intensity = strength, .range = 1.5F});
        } else if (i % 3 == 1) {
            add(scene.world, pose,
                SpotLight{.colour = colour, .intensity = strength, .inner_cone = 0.2F, .outer_cone = 0.6F});
        } else {
            add(scene.world, pose, DirectionalLight{.colour = colour, .illuminance = strength});
        }
    }
    return scene;
}

std::shared_ptr<const Material> pane(int i) {
    Material material;
    material.base_colour = {0.9F, 0.15F * static_cast<float>(i), 0.4F, 0.2F + 0.1F * static_cast<float>(i)};
    material.double_sided = i % 2 == 0;
    material.alpha_mode = AlphaMode::blend;
    return std::make_shared<const Material>(std::move(material));
}

std::shared_ptr<const Material> mask() {
    Material material = *diffuse({0.2F, 0.6F, 0.9F}, true);
    material.alpha_mode = AlphaMode::mask;
    material.base_colour_texture = std::make_shared<const Image>(
        Image{.width = 2,
              .height = 2,
              .texels = {{255, 255, 255, 255}, {255, 0, 0, 0}, {255, 0, 0, 0}, {0, 255, 0, 255}}});
    return std::make_shared<const Material>(std::move(material));
}

/// The Cornell box with a mask, panes that cross each other, and small lights everywhere, also in front of
/// the walls, so that most lists do not contain all lights.
Scene panes_and_masks() {
    Scene scene = cornell_box();
    add(scene.world,
        Transform{.translation = {-0.3F, 1.0F, 0.3F},
                  .rotation = glm::angleAxis(1.2F, glm::normalize(glm::vec3(1, 0.4F, 0)))},
        MeshInstance{square(0.4F, mask())});
    for (int i = 0; i < 6; ++i) {
        const auto step = static_cast<float>(i);
        const glm::vec3 axis = glm::normalize(glm::vec3(1.0F, 0.3F * step, 0.2F));
        add(scene.world,
            Transform{.translation = {0.3F * step - 0.7F, 0.5F + 0.2F * step, 0.2F * step - 0.4F},
                      .rotation = glm::angleAxis(0.9F + 0.3F * step, axis)},
            MeshInstance{square(0.3F, pane(i))});
    }
    for (int i = 0; i < 40; ++i) {
        const auto spread = [i](float step) { return std::fmod(static_cast<float>(i) * step, 1.0F); };
        add(scene.world,
            at({1.6F * spread(0.618F) - 0.8F, 0.2F + 1.6F * spread(0.382F), 1.6F * spread(0.755F) - 0.8F}),
            PointLight{.colour = {1.0F, spread(0.57F), 0.5F},
                       .intensity = 0.1F,
                       .range = 0.5F,
                       .casts_shadow = false});
    }
    return scene;
}

Scene shadows_in_clutter() {
    Scene scene = cluttered_room();
    add(scene.world, at({0.5F, 1.0F, 0.0F}), PointLight{.range = 3.0F});
    add(scene.world, looking({-1, 1, 1}, {0, 0, 0}), SpotLight{.intensity = 4.0F, .range = 4.0F});
    add(scene.world, looking({1, 1.5F, 1}, {0, 0, 0}), DirectionalLight{.illuminance = 0.3F});
    return scene;
}

Configuration vpls(VplVisibility method, Interleave interleave = Interleave::one) {
    Configuration configuration = linear_configuration();
    configuration.visibility = {.method = method, .map_resolution = 16};
    configuration.interleave = interleave;
    return configuration;
}

Rows shadows_and_vpls() {
    using enum VplVisibility;
    Configuration paths = vpls(maps);
    paths.vpls.placement = VplPlacement::paths;
    paths.vpls.bounces = 2;
    return {{"lights of all kinds", lights_of_all_kinds(), vpls(none)},
            {"VPLs on paths", cornell_box(), paths},
            {"shadows in clutter", shadows_in_clutter(), vpls(none)},
            {"panes and masks", panes_and_masks(), vpls(none), {80, 60}},
            {"many lights and VPLs", shipped_scene("hall-256"), vpls(none)},
            {"glass, interleaved by 2", shipped_scene("glass"), vpls(maps, Interleave::two)},
            {"glass, interleaved by 4", shipped_scene("glass"), vpls(maps, Interleave::four)},
            {"glass, interleaved by 8", shipped_scene("glass"), vpls(maps, Interleave::eight)}};
}

Rows lamps_and_skies() {
    using enum VplVisibility;
    return {{"lamp", shipped_scene("lamp"), vpls(maps)},
            {"lamp, interleaved", shipped_scene("lamp"), vpls(maps, Interleave::four)},
            {"court", shipped_scene("court"), vpls(maps)},
            {"court, interleaved", shipped_scene("court"), vpls(maps, Interleave::four)}};
}

class PathsAgree : public PathFixture {
 protected:
    void check_all(const Rows& rows) {
        for (const Row& row : rows) {
            CAPTURE(row.name);
            check_paths(row.scene, row.size, row.configuration);
            CHECK(renderer.report().lights.without_map == 0);
        }
    }
};

}  // namespace

TEST_CASE_FIXTURE(PathsAgree, "paths agree: lights around the view, and across its planes") {
    check_all(lights_around_the_view());
}

TEST_CASE_FIXTURE(PathsAgree, "paths agree: cameras in walls, without perspective, tiny lights, spots") {
    check_all(cameras_and_lights());
}

TEST_CASE_FIXTURE(PathsAgree, "paths agree: targets of all shapes, cells of all sizes") {
    check_all(shapes_of_targets());
    check_all(sizes_of_cells());
}

TEST_CASE_FIXTURE(PathsAgree, "paths agree: many lights, also ten thousand in one tile") {
    check_all(shipped_with_many_lights());
    constexpr int count = 10'000;
    std::vector<Point> points;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 spread = glm::fract(static_cast<float>(i) * glm::vec3(0.618F, 0.382F, 0.755F));
        points.push_back({glm::vec3(-1.6F, -1.0F, -1.95F) + 0.2F * spread, 0.15F});
    }
    // One of 3 × 2 tiles sees the corner of the room where the lights are.
    check_paths(room_with(points), {33, 17}, direct_only());
    const LightReport lights = renderer.report().lights;
    CHECK(lights.global == 0);
    CHECK(lights.tile_max == count);
}

TEST_CASE_FIXTURE(PathsAgree, "paths agree: shadows, VPLs and blended surfaces") {
    check_all(shadows_and_vpls());
}

TEST_CASE_FIXTURE(PathsAgree, "paths agree: lamps and skies") {
    check_all(lamps_and_skies());
}

TEST_CASE_FIXTURE(PathsAgree, "paths agree: VPLs with visibility by rays") {
    // At the edge of a shadow, the rounding of a position decides about a whole VPL.
    const Scene scene = cornell_box();
    Configuration configuration = vpls(VplVisibility::rays);
    Picture reference;
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        configuration.path = path;
        configure(configuration);
        const Picture picture = render(scene, few_tiles);
        if (path == ShadingPath::forward) reference = picture;
        std::size_t off = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            const glm::vec3 difference = glm::abs(picture.pixels[i] - reference.pixels[i]);
            off += glm::length(difference) > 1e-3F * glm::length(reference.pixels[i]) ? 1 : 0;
        }
        CHECK(off <= picture.pixels.size() / 500);
    }
    CHECK(mean(reference) > 0.0);
}

}  // TEST_SUITE("paths agree")
