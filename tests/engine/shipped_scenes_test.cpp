#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/bvh/box.hpp"
#include "sandbox/files/shipped_file.hpp"
#include "tests/engine/gltf_builder.hpp"
#include "tests/engine/scene_probe.hpp"

TEST_SUITE("shipped scenes") {

using namespace candela;
using namespace candela::test;
namespace fs = std::filesystem;

namespace {

fs::path scenes() {
    return sandbox::shipped_file("scenes", "");
}

fs::path shipped(const std::string& name) {
    return scenes() / (name + ".gltf");
}

std::vector<fs::path> shipped_files() {
    std::vector<fs::path> files;
    for (const fs::directory_entry& file : fs::directory_iterator(scenes())) {
        if (file.path().extension() == ".gltf") files.push_back(file.path());
    }
    return files;
}

/// Runs the generator. The arguments must not need quoting.
void generate(const fs::path& out, const std::string& arguments) {
    const fs::path script = scenes() / "generate.py";
    const std::string command =
        fmt::format("python3 '{}' --out '{}' {} > /dev/null", script.string(), out.string(), arguments);
    REQUIRE(std::system(command.c_str()) == 0);
}

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// By the divergence theorem; negative if the triangles face inwards.
double enclosed_volume(const std::vector<Triangle>& triangles) {
    double volume = 0.0;
    for (const Triangle& t : triangles) {
        volume += glm::dot(glm::dvec3(t.a), glm::cross(glm::dvec3(t.b), glm::dvec3(t.c))) / 6.0;
    }
    return volume;
}

/// The fraction of a coarse picture's pixels that show the front of a surface.
double covered(const Loaded& scene, const Target& target) {
    const glm::ivec2 size(32, 24);
    int shown = 0;
    for (int i = 0; i < size.x * size.y; ++i) {
        const glm::vec3 direction = through_pixel(scene, {i % size.x, i / size.x}, size);
        shown += target.shows_front(scene.camera()[3], direction) ? 1 : 0;
    }
    return double(shown) / (size.x * size.y);
}

/// The distance to the nearest surface in metres, estimated with 100 rays. A light that almost touches a
/// surface would make a highlight so bright that it dominates every measure of error.
float room_around(const Target& target, const glm::vec3& place) {
    float nearest = std::numeric_limits<float>::infinity();
    for (const glm::vec3& direction : directions(100)) {
        const std::optional<Hit> hit = target.first(place, direction);
        nearest = std::min(nearest, hit ? hit->t : nearest);
    }
    return nearest;
}

/// Properties of a scene that published figures rely on.
struct Facts {
    std::string name;
    std::uint64_t triangles;
    std::size_t points, spots, suns;
    glm::vec3 lower, upper;
    std::vector<std::string> cameras{"camera"};
};

void check_facts(const Loaded& scene, const Facts& facts) {
    CHECK(scene.report.warnings.empty());
    CHECK(scene.report.triangles == facts.triangles);
    CHECK(count<PointLight>(scene) == facts.points);
    CHECK(count<SpotLight>(scene) == facts.spots);
    CHECK(count<DirectionalLight>(scene) == facts.suns);
    CHECK(count<Camera>(scene) == facts.cameras.size());
    for (const std::string& camera : facts.cameras) {
        REQUIRE(scene.called(camera).size() == 1);
        CHECK(scene.world.find<Camera>(scene.called(camera)[0]) != nullptr);
    }
    CHECK(scene.first_camera() == scene.called(facts.cameras[0])[0]);

    const Target target{all_triangles(scene)};
    Box box;
    for (const Triangle& triangle : target.triangles) {
        box.grow(bounds(triangle));
    }
    // Coordinates are floats of up to 500 m, rotations have seven digits.
    CHECK(glm::distance(box.lower, facts.lower) < 1e-4F);
    CHECK(glm::distance(box.upper, facts.upper) < 1e-4F);
    // Lights of the open scenes, too, are inside the scene's bounding box.
    for (const glm::vec3& light : light_positions(scene)) {
        CHECK(glm::all(glm::greaterThan(light, facts.lower)));
        CHECK(glm::all(glm::lessThan(light, facts.upper)));
        CHECK(room_around(target, light) > 0.1F);
    }
    // The Cornell box is framed for a square picture, which is 3/4 of this one.
    CHECK(covered(scene, target) > 0.7);
}

/// Whether each vertex normal is on the front side of the triangles that use it.
bool normals_agree(const Primitive& primitive) {
    std::vector<Triangle> triangles;
    append(triangles, primitive, glm::mat4(1.0F));
    for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
        const Triangle& t = triangles[i / 3];
        const glm::vec3 normal = primitive.vertices[primitive.indices[i]].normal;
        if (glm::dot(glm::cross(t.b - t.a, t.c - t.a), normal) <= 0.0F) return false;
    }
    return true;
}

/// How many lights reach a point, ignoring shadows.
int lights_reaching(const Loaded& scene, const glm::vec3& point) {
    int reaching = 0;
    for (auto [entity, light] : scene.world.view<PointLight>()) {
        reaching += glm::distance(scene.position(entity), point) < light.range ? 1 : 0;
    }
    for (auto [entity, light] : scene.world.view<SpotLight>()) {
        const glm::mat4 matrix = world_matrix(scene.world, entity);
        const glm::vec3 to_point = point - glm::vec3(matrix[3]);
        const float distance = glm::length(to_point);
        const float along = glm::dot(to_point, -glm::vec3(matrix[2])) / distance;
        reaching += distance < light.range && along > std::cos(light.outer_cone) ? 1 : 0;
    }
    return reaching;
}

/// The mean of lights_reaching over 24 × 24 points of a parallelogram, given by a corner and two edges.
double mean_reaching(const Loaded& scene, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
    int sum = 0;
    for (int i = 0; i < 24 * 24; ++i) {
        const float along_u = (float(i % 24) + 0.5F) / 24.0F;
        const float along_v = (float(i / 24) + 0.5F) / 24.0F;
        sum += lights_reaching(scene, corner + along_u * u + along_v * v);
    }
    return sum / (24.0 * 24.0);
}

}  // namespace

TEST_CASE("each has the expected numbers of triangles and lights, and bounds") {
    const std::vector<Facts> facts_of_all{
        {"cornell", 34, 1, 0, 0, {-1, 0, -1}, {1, 2, 1}},
        {"corner", 6, 0, 1, 0, {0, 0, 0}, {2, 2, 2}},
        {"two-rooms", 76, 1, 0, 0, {-4.1F, 0, -2}, {4.1F, 2.6F, 2}},
        {"court", 1106, 0, 0, 0, {-6, 0, -6}, {6, 3, 6}},
        {"furnace", 12, 1, 0, 0, {-1, -1, -1}, {1, 1, 1}},
        {"glass", 58, 11, 0, 0, {-3, 0, -4}, {3, 3, 4}},
        {"hall-256", 372, 192, 64, 0, {-8, 0, -64}, {8, 4, 0}},
        // The highest point is the top of a fin.
        {"fins", 28802, 512, 0, 0, {-6.2F, 0, -22.28103F}, {6.2F, 3.79629F, 0}},
        // The lowest point is the bottom of a valley, the highest the top of a hill.
        {"house", 4836, 0, 0, 1, {-500, -12.97206F, -500}, {500, 13.16102F, 500}, {"inside", "outside"}},
        {"plane", 1010, 0, 0, 1, {-500, 0, -500}, {500, 1.6F, 500}},
        {"apartment", 228, 1, 0, 0, {-4.3F, -0.2F, -4.3F}, {4.3F, 2.8F, 4.3F}},
        {"rooms-12",
         612,
         1,
         0,
         0,
         {-0.2F, -0.2F, -2.2F},
         {50.4F, 2.8F, 2.2F},
         {"room-2", "room-3", "room-6", "room-12"}},
        {"metals", 9626, 1, 0, 1, {-5, 0, -2.6F}, {5, 3.2F, 5}},
        {"helmet", 2900, 1, 0, 1, {-4, 0, -2}, {4, 2.6F, 4}},
        {"bath", 292, 0, 0, 0, {-1.5F, 0, -1.5F}, {1.5F, 2.5F, 1.5F}},
        // The highest point is the top of a box that will fall.
        {"boxes", 24002, 0, 0, 1, {-20, 0, -20}, {20, 5.2F, 20}},
    };
    for (const Facts& facts : facts_of_all) {
        CAPTURE(facts.name);
        check_facts(Loaded(shipped(facts.name)), facts);
    }
}

TEST_CASE("the generator writes the shipped files, and the large scenes on demand" *
          doctest::test_suite("posix")) {
    const TemporaryDirectory directory;
    generate(directory / "shipped", "");
    for (const fs::path& path : shipped_files()) {
        CAPTURE(path.filename().string());
        CHECK(contents(directory / "shipped" / path.filename()) == contents(path));
    }
    generate(directory / "large", "atrium street hall-4096 hall --lights 7");
    check_facts(Loaded(directory / "large/hall-4096.gltf"),
                {"hall-4096", 6060, 3072, 1024, 0, {-32, 0, -256}, {32, 4, 0}});
    check_facts(Loaded(directory / "large/hall-7.gltf"), {"hall-7", 12, 6, 1, 0, {-1, 0, -14}, {1, 4, 0}});
    const Loaded atrium(directory / "large/atrium.gltf");
    check_facts(atrium, {"atrium", 116098, 4, 0, 1, {-13.75F, 0, -7.5F}, {13.75F, 9.6F, 7.5F}});
    for (const Entity column : atrium.called("column")) {
        CHECK(normals_agree(atrium.world.get<MeshInstance>(column).mesh->primitives.at(0)));
    }
    const Loaded street(directory / "large/street.gltf");
    CHECK(street.report.warnings.empty());
    CHECK(street.report.triangles > 1'000'000);
    for (auto [entity, instance] : street.world.view<MeshInstance>()) {
        CHECK(normals_agree(instance.mesh->primitives.at(0)));
    }
}

TEST_CASE("normals point to the front of their triangles") {
    for (const fs::path& path : shipped_files()) {
        CAPTURE(path.filename().string());
        const Loaded scene(path);
        for (auto [entity, instance] : scene.world.view<MeshInstance>()) {
            CHECK(normals_agree(instance.mesh->primitives.at(0)));
        }
    }
}

TEST_CASE("closed rooms have no gap and face inwards") {
    struct Closed {
        std::string name;
        double volume;  // cubic metres
    };
    const std::vector<Closed> rooms{{"furnace", 2.0 * 2.0 * 2.0},
                                    {"glass", 6.0 * 3.0 * 8.0},
                                    {"hall-256", 16.0 * 4.0 * 64.0},
                                    {"two-rooms", 2 * 4.0 * 2.6 * 4.0 + 0.2 * 2.0 * 0.9}};
    for (const Closed& expected : rooms) {
        CAPTURE(expected.name);
        const Loaded scene(shipped(expected.name));
        const Target room{triangles_of(scene, scene.called("room").at(0))};
        CHECK(enclosed_volume(room.triangles) == doctest::Approx(-expected.volume).epsilon(1e-6));

        std::vector<glm::vec3> inside = light_positions(scene);
        inside.push_back(scene.position(scene.called("camera").at(0)));
        for (const glm::vec3& from : inside) {
            for (const glm::vec3& direction : directions(500)) {
                REQUIRE(room.shows_front(from, direction));
            }
        }
    }
}

TEST_CASE("the furnace has one albedo, 0.5") {
    const Loaded scene(shipped("furnace"));
    CHECK(count<MeshInstance>(scene) == 1);
    const MeshInstance& room = scene.world.get<MeshInstance>(scene.called("room").at(0));
    CHECK(room.mesh->primitives.at(0).material->base_colour == glm::vec4(0.5F, 0.5F, 0.5F, 1.0F));
}

TEST_CASE("the spot light of the corner scene shines into the corner from nearby") {
    const Loaded scene(shipped("corner"));
    const glm::mat4 spot = world_matrix(scene.world, scene.called("spot").at(0));
    const glm::vec3 to_corner = -glm::vec3(spot[3]);
    CHECK(glm::length(to_corner) < 1.1F);
    CHECK(glm::dot(glm::normalize(to_corner), -glm::vec3(spot[2])) > 0.999F);
}

TEST_CASE("light passes through the door of two-rooms only while it is open") {
    Loaded scene(shipped("two-rooms"));
    const Entity door = scene.called("door").at(0);
    const glm::vec3 lamp = scene.position(scene.called("lamp").at(0));
    REQUIRE(lamp.x < 0.0F);
    const auto lit_beyond = [&] {
        const Target target{all_triangles(scene)};
        int beyond = 0;
        for (const glm::vec3& direction : directions(20000)) {
            const std::optional<Hit> hit = target.first(lamp, direction);
            REQUIRE(hit);
            // The closed door is between x = 0.1 m and x = 0.15 m.
            beyond += lamp.x + hit->t * direction.x > 0.15F ? 1 : 0;
        }
        return beyond;
    };
    // The opening is about 0.9 m × 2 m, seen from 2 m: a fraction of about 1.8 / (4 pi 4) of 20,000 rays.
    CHECK(lit_beyond() > 300);
    Transform shut = scene.world.get<Transform>(door);
    shut.rotation = {1.0F, 0.0F, 0.0F, 0.0F};
    scene.world.set(door, shut);
    CHECK(lit_beyond() == 0);
}

TEST_CASE("the sun shines through the front door and the window of the house, and not into its back room") {
    const Loaded scene(shipped("house"));
    const Target target{all_triangles(scene)};
    const glm::vec3 towards(world_matrix(scene.world, scene.called("sun").at(0))[2]);
    const auto lit = [&](float near, float far) {
        int points = 0;
        for (int i = 0; i < 80 * 20; ++i) {
            const glm::vec3 at(-3.95F + 0.1F * float(i % 80), 0.1F,
                               glm::mix(near, far, (float(i / 80) + 0.5F) / 20.0F));
            points += target.first(at, towards) ? 0 : 1;
        }
        return points;
    };
    CHECK(lit(3.0F, -3.0F) > 20);
    CHECK(lit(-3.2F, -6.0F) == 0);
}

TEST_CASE("the fallen boxes stand on others") {
    const Loaded scene(shipped("boxes"));
    const auto fallen = scene.called("falling box");
    REQUIRE(fallen.size() == 100);
    const Target target{all_triangles(scene)};
    for (const Entity box : fallen) {
        // From just below the bottom, straight down: 3 m to fall.
        const glm::vec3 below = scene.position(box) - glm::vec3(0.0F, 1e-3F, 0.0F);
        const std::optional<Hit> hit = target.first(below, {0.0F, -1.0F, 0.0F});
        REQUIRE(hit);
        CHECK(hit->t == doctest::Approx(3.0).epsilon(1e-3));
    }
}

TEST_CASE("a few lights reach each point of the floors of the halls and the fins scene" *
          doctest::test_suite("posix")) {
    const TemporaryDirectory directory;
    generate(directory / "", "hall --lights 64");
    // The halls must agree, otherwise another number of lights would change more than the size. There is
    // one light per 4 square metres. A point light reaches a disc of radius sqrt(3.5² - 2²), a spot about
    // one of 2 m · tan 55°: 6.4 lights on average, fewer near walls.
    for (const Loaded& hall : {Loaded(shipped("hall-256")), Loaded(directory / "hall-64.gltf")}) {
        const double reaching = mean_reaching(hall, {-1, 0, -28}, {2, 0, 0}, {0, 0, 24});
        CHECK(reaching > 4.0);
        CHECK(reaching < 8.0);
    }
    // 512 lights over 12 m × 21.6 m; each reaches a disc of radius sqrt(1.05² - 0.28²): 6.4 on average.
    const float slope = glm::radians(8.0F);
    const glm::vec3 upwards(0.0F, std::sin(slope), -std::cos(slope));
    const glm::vec3 corner = glm::vec3(-5, 0, 0) + 2.0F * upwards;
    const double reaching = mean_reaching(Loaded(shipped("fins")), corner, {10, 0, 0}, 18.0F * upwards);
    CHECK(reaching > 5.0);
    CHECK(reaching < 8.0);
}

TEST_CASE("most tiles of the fins scene span a wide range of depths") {
    const Loaded scene(shipped("fins"));
    const Target target{all_triangles(scene)};
    const glm::ivec2 size(640, 480);
    int spread = 0;
    int tiles = 0;
    for (int y = 128; y < size.y; y += 32) {
        for (int x = 0; x < size.x; x += 32) {
            float nearest = std::numeric_limits<float>::infinity();
            float farthest = 0.0F;
            for (int i = 0; i < 64; ++i) {
                const glm::ivec2 pixel(x + i % 8 * 2, y + i / 8 * 2);
                const std::optional<Hit> hit =
                    target.first(scene.camera()[3], through_pixel(scene, pixel, size));
                nearest = std::min(nearest, hit ? hit->t : nearest);
                farthest = std::max(farthest, hit ? hit->t : farthest);
            }
            // On a plane alone, seen at 8° or more, depths over 16 pixels of 30° / 480 differ by a factor
            // below 1.15.
            spread += farthest > 1.3F * nearest ? 1 : 0;
            ++tiles;
        }
    }
    CHECK(spread > tiles / 2);
}

TEST_CASE("the court has a sky with a sun in it, above the walls") {
    const Loaded scene(shipped("court"));
    const Environment sky = environment_of(scene.world);
    REQUIRE(sky.picture);
    const auto sum = [](glm::vec3 texel) { return texel.r + texel.g + texel.b; };
    const auto brightest = std::ranges::max_element(sky.picture->texels, {}, sum);
    const auto i = static_cast<std::uint32_t>(brightest - sky.picture->texels.begin());
    const glm::vec2 at(float(i % sky.picture->width) + 0.5F, float(i / sky.picture->width) + 0.5F);
    const glm::vec3 towards = sky_direction(at / glm::vec2(sky.picture->width, sky.picture->height));
    CHECK(sum(*brightest) > 100.0F);
    CHECK(towards.y > 0.5F);
    const Target target{all_triangles(scene)};
    CHECK_FALSE(target.first({0.0F, 0.1F, 2.0F}, towards));  // the sun shines into the court
}

TEST_CASE("the glass scene has panes behind each other, one of them double-sided, and a cut-out") {
    const Loaded scene(shipped("glass"));
    std::vector<std::vector<Triangle>> panes;
    int double_sided = 0;
    for (auto [entity, instance] : scene.world.view<MeshInstance>()) {
        const Material& material = *instance.mesh->primitives.at(0).material;
        if (material.alpha_mode == AlphaMode::blend) {
            CHECK(material.base_colour.a < 1.0F);
            double_sided += material.double_sided ? 1 : 0;
            panes.push_back(triangles_of(scene, entity));
        }
    }
    CHECK(panes.size() == 4);
    CHECK(double_sided == 1);

    const glm::vec3 eye = scene.camera()[3];
    const glm::ivec2 size(48, 36);
    std::size_t deepest = 0;
    for (int i = 0; i < size.x * size.y; ++i) {
        const glm::vec3 direction = through_pixel(scene, {i % size.x, i / size.x}, size);
        const auto crossed = std::ranges::count_if(
            panes, [&](const auto& pane) { return Target{pane}.first(eye, direction).has_value(); });
        deepest = std::max(deepest, static_cast<std::size_t>(crossed));
    }
    CHECK(deepest >= 3);

    const MeshInstance& trellis = scene.world.get<MeshInstance>(scene.called("trellis").at(0));
    const Material& cut_out = *trellis.mesh->primitives.at(0).material;
    CHECK(cut_out.alpha_mode == AlphaMode::mask);
    REQUIRE(cut_out.base_colour_texture);
    const std::vector<glm::u8vec4>& texels = cut_out.base_colour_texture->texels;
    const auto solid = std::ranges::count_if(
        texels, [&](const glm::u8vec4& texel) { return float(texel.a) / 255.0F >= cut_out.alpha_cutoff; });
    CHECK(double(solid) / double(texels.size()) > 0.3);
    CHECK(double(solid) / double(texels.size()) < 0.8);
}

}  // TEST_SUITE("shipped scenes")
