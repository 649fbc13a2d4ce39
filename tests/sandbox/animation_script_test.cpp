#include "sandbox/animation/animation_script.hpp"

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include "sandbox/scene/scene.hpp"
#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("animation script") {

namespace {

namespace fs = std::filesystem;

template <class Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "none";
}

std::string error_of_script(std::string_view json) {
    return error_of([&] { static_cast<void>(read_script(json)); });
}

/// The error of a script of 60 frames with one track, for the node "lamp".
std::string error_of_track(std::string_view members) {
    return error_of_script(fmt::format(R"({{"frames": 60, "tracks": [{{"node": "lamp", {}}}]}})", members));
}

const std::string everything = R"({
    "scene": "two-rooms", "frames": 60, "loop": true,
    "tracks": [
        { "node": "lamp", "interpolation": "smooth",
          "translation": [[0, [-1.5, 2, 0.5]], [60, [1, 2e0, 3]]], "scale": [[1, [1, 2, 3]]],
          "intensity": [[0, 9], [5, 0]], "colour": [[2, [1, 0.5, 0]]], "enabled": [[0, true], [20, false]] },
        { "node": "door", "interpolation": "step",
          "rotation": [[0, [0, 0, 0, 2]], [30, {"axis": [0, -3, 0], "degrees": 90}]] },
        { "node": "camera" } ] })";

Script shipped(const char* name) {
    return load_script(name);
}

/// A shipped script and its scene.
struct Staged {
    Scene scene;
    Animation animation;
    explicit Staged(const char* name)
        : scene(load_scene(scene_of(shipped(name)).value())), animation(shipped(name), scene.world) {}

    /// The world-space matrix (metres) of a node in this frame.
    glm::mat4 matrix(const char* node, int frame) {
        animation.apply(scene.world, frame);
        for (auto [entity, name] : scene.world.view<Name>()) {
            if (name.value == node) return world_matrix(scene.world, entity);
        }
        FAIL("no such node");
        return {};
    }
    glm::vec3 position(const char* node, int frame) { return glm::vec3(matrix(node, frame)[3]); }
    int lights_on(int frame) {
        animation.apply(scene.world, frame);
        int on = 0;
        for (auto [entity, light] : scene.world.view<PointLight>()) on += light.intensity > 0.0F ? 1 : 0;
        return on;
    }
};

}  // namespace

TEST_CASE("every member of a script is read") {
    const Script script = read_script(everything);
    CHECK(script.scene == "two-rooms");
    CHECK(script.frames == 60);
    CHECK(script.loop);
    REQUIRE(script.tracks.size() == 3);

    const Track& lamp = script.tracks[0];
    CHECK(lamp.node == "lamp");
    CHECK(lamp.interpolation == Interpolation::smooth);
    REQUIRE(lamp.translation.size() == 2);
    CHECK(lamp.translation[0].value == glm::vec3(-1.5, 2, 0.5));
    CHECK(lamp.translation[1].frame == 60);
    CHECK(lamp.translation[1].value == glm::vec3(1, 2, 3));
    CHECK(lamp.scale.at(0).value == glm::vec3(1, 2, 3));
    CHECK(lamp.intensity.at(1).value == 0.0F);
    CHECK(lamp.colour.at(0).value == glm::vec3(1, 0.5, 0));
    CHECK(lamp.enabled.at(1).frame == 20);
    CHECK_FALSE(lamp.enabled.at(1).value);

    const Track& door = script.tracks[1];
    CHECK(door.interpolation == Interpolation::step);
    REQUIRE(door.rotation.size() == 2);
    CHECK(door.rotation[0].value == glm::quat(1, 0, 0, 0));
    // A rotation by 90 degrees around -Y turns +X to +Z, within a rounding of unit vectors.
    CHECK(glm::distance(door.rotation[1].value * glm::vec3(1, 0, 0), glm::vec3(0, 0, 1)) < 1e-6F);

    const Track& camera = script.tracks[2];
    CHECK(camera.interpolation == Interpolation::linear);
    CHECK((camera.translation.empty() && camera.rotation.empty() && camera.enabled.empty()));
}

TEST_CASE("members that are left out have their defaults") {
    const Script script = read_script(R"({"frames": 1, "tracks": []})");
    CHECK_FALSE(script.scene);
    CHECK_FALSE(script.loop);
    CHECK(script.tracks.empty());
}

TEST_CASE("errors of an invalid script name the place") {
    CHECK(error_of_script("").starts_with("invalid JSON: parse error at line 1, column 1: "));
    CHECK(error_of_script("{\n \"frames\": 3,\n nonsense }")
              .starts_with("invalid JSON: parse error at line 3, column "));
    CHECK(error_of_script("[1]") == "not a JSON object");
    CHECK(error_of_script(R"({"tracks": []})") == "frames: is missing");
    CHECK(error_of_script(R"({"frames": 2})") == "tracks: is missing");
    CHECK(error_of_script(R"({"frames": 2, "tracks": {}})") == "tracks: is not a list");
    CHECK(error_of_script(R"({"frames": 2, "tracks": [1]})") == "tracks[0]: is not an object");
    CHECK(error_of_script(R"({"frames": 2, "tracks": [{}]})") == "tracks[0].node: is missing");
    CHECK(error_of_script(R"({"frames": 2, "tracks": [], "speed": 2})") == "speed: is unknown");
    CHECK(error_of_script(R"({"frames": 2, "tracks": [], "loop": 1})") == "loop: is not true or false");
    CHECK(error_of_script(R"({"frames": 2, "tracks": [], "scene": 1})") == "scene: is not a word");
    for (const char* frames : {"0", "-1", "1.5", "1e3", "2147483648", "\"2\"", "null"}) {
        CHECK(error_of_script(fmt::format(R"({{"frames": {}, "tracks": []}})", frames)) ==
              "frames: is not a whole number from 1 to 2147483647");
    }
    CHECK(error_of_script(R"({"frames": 2, "tracks": [{"node": "a"}, {"node": "a"}]})") ==
          "tracks[1].node: 'a' has a track already");
}

TEST_CASE("errors of an invalid track name the place") {
    CHECK(error_of_track(R"("speed": 1)") == "tracks[0].speed: is unknown");
    CHECK(error_of_track(R"("interpolation": "cubic")") ==
          "tracks[0].interpolation: is not one of linear, step, smooth");
    CHECK(error_of_track(R"("intensity": 3)") == "tracks[0].intensity: is not a list of keys");
    CHECK(error_of_track(R"("intensity": [])") == "tracks[0].intensity: is not a list of keys");
    CHECK(error_of_track(R"("intensity": [[0, 1], [2]])") ==
          "tracks[0].intensity[1]: is not a pair of a frame and a value");
    CHECK(error_of_track(R"("intensity": [[0.5, 1]])") ==
          "tracks[0].intensity[0][0]: is not a whole number from 0 to 60");
    CHECK(error_of_track(R"("intensity": [[-1, 1]])") ==
          "tracks[0].intensity[0][0]: is not a whole number from 0 to 60");
    CHECK(error_of_track(R"("intensity": [[61, 1]])") ==
          "tracks[0].intensity[0][0]: is not a whole number from 0 to 60");
    CHECK(error_of_track(R"("intensity": [[0, -1]])") == "tracks[0].intensity[0][1]: is negative");
    CHECK(error_of_track(R"("intensity": [[0, "1"]])") == "tracks[0].intensity[0][1]: is not a number");
    CHECK(error_of_track(R"("enabled": [[0, 1]])") == "tracks[0].enabled[0][1]: is not true or false");
    CHECK(error_of_track(R"("colour": [[0, [1, -1, 0]]])") == "tracks[0].colour[0][1]: is negative");
    CHECK(error_of_track(R"("translation": [[0, [1, 2]]])") ==
          "tracks[0].translation[0][1]: is not three numbers");
    CHECK(error_of_track(R"("translation": [[0, [1, 2, null]]])") ==
          "tracks[0].translation[0][1][2]: is not a number");
    CHECK(error_of_track(R"("rotation": [[0, [0, 0, 1]]])") ==
          "tracks[0].rotation[0][1]: is not a quaternion [x, y, z, w] or a turn {axis, degrees}");
    CHECK(error_of_track(R"("rotation": [[0, [0, 0, 0, 0]]])") == "tracks[0].rotation[0][1]: has no length");
    CHECK(error_of_track(R"("rotation": [[0, {"axis": [0, 0, 0], "degrees": 1}]])") ==
          "tracks[0].rotation[0][1].axis: has no length");
    CHECK(error_of_track(R"("rotation": [[0, {"axis": [0, 0, 1], "radians": 1}]])") ==
          "tracks[0].rotation[0][1].radians: is unknown");
    CHECK(error_of_track(R"("rotation": [[0, {"axis": [0, 0, 1]}]])") ==
          "tracks[0].rotation[0][1].degrees: is missing");
}

TEST_CASE("the frames of keys must increase") {
    CHECK(error_of_track(R"("scale": [[5, [1, 1, 1]], [4, [1, 1, 1]]])") ==
          "tracks[0].scale[1]: frame 4 does not come after frame 5");
    CHECK(error_of_track(R"("scale": [[5, [1, 1, 1]], [5, [1, 1, 1]]])") ==
          "tracks[0].scale[1]: frame 5 does not come after frame 5");
    CHECK(error_of_track(R"("scale": [[0, [1, 1, 1]], [60, [1, 1, 1]]])") == "none");
}

TEST_CASE("NaN, infinity and numbers too large for a float are errors") {
    CHECK(error_of_track(R"("intensity": [[0, NaN]])").starts_with("invalid JSON"));
    CHECK(error_of_track(R"("intensity": [[0, Infinity]])").starts_with("invalid JSON"));
    CHECK(error_of_track(R"("intensity": [[0, 1e999]])").starts_with("invalid JSON: number overflow"));
    CHECK(error_of_track(R"("intensity": [[0, 1e39]])") == "tracks[0].intensity[0][1]: is too large");
    CHECK(error_of_track(R"("translation": [[0, [0, -1e39, 0]]])") ==
          "tracks[0].translation[0][1][1]: is too large");
}

TEST_CASE("quaternions of any length are normalised") {
    for (const char* length : {"1e-30", "3", "1e30"}) {
        const Script script = read_script(fmt::format(
            R"({{"frames": 1, "tracks": [{{"node": "a", "rotation": [[0, [{0}, {0}, {0}, {0}]]]}}]}})",
            length));
        CHECK(script.tracks[0].rotation[0].value == glm::quat(0.5F, 0.5F, 0.5F, 0.5F));
    }
}

TEST_CASE("errors name the file, or the name that is neither a file nor a shipped script") {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    std::ofstream(file) << R"({"frames": 2})";
    CHECK(error_of([&] { static_cast<void>(load_script(file)); }) == file.string() + ": tracks: is missing");
    for (const std::string& wanted :
         {(folder / "none.json").string(), std::string("orbit"), std::string("/tmp")}) {
        const std::string error = error_of([&] { static_cast<void>(load_script(wanted)); });
        CHECK(error.starts_with(wanted + ": "));
        CHECK(error.ends_with(
            "boxes-fall, door-opens, flicker-walk, lamp-in-rooms, orbit-camera, orbit-light, teleport, "
            "toggle, walk-in"));
    }
}

TEST_CASE("a script's scene is a shipped scene, or a path relative to the script") {
    Script script;
    script.path = "somewhere/a.json";
    CHECK_FALSE(scene_of(script));
    script.scene = "rooms/b.glb";
    CHECK(scene_of(script) == "somewhere/rooms/b.glb");
    script.scene = "corner";
    CHECK(scene_of(script) == shipped_file("scenes", "corner.gltf"));
}

TEST_CASE("shipped: the light circles under the ceiling and ends where it began") {
    Staged orbit("orbit-light");
    const auto at = [&](int frame) { return orbit.position("ceiling light", frame); };
    const glm::vec3 centre(0.0F, 1.6F, 0.0F);
    const int frames = orbit.animation.script().frames;
    CHECK(orbit.animation.script().loop);
    for (int frame = 0; frame < frames; ++frame) {
        // The keys have four decimals.
        CHECK(glm::distance(at(frame), centre) == doctest::Approx(0.5).epsilon(3e-4));
        CHECK(glm::distance(at(frame), at(frame + 1)) ==
              doctest::Approx(std::sin(3.14159265 / frames)).epsilon(3e-3));
    }
    CHECK(at(frames) == at(0));
}

TEST_CASE("shipped: the light moves one millimetre per frame") {
    Staged walk("flicker-walk");
    for (int frame = 0; frame + 1 < walk.animation.script().frames; ++frame) {
        const glm::vec3 step =
            walk.position("ceiling light", frame + 1) - walk.position("ceiling light", frame);
        // Positions within 0.1 m have a rounding error of about 1e-8 m.
        CHECK(glm::distance(step, glm::vec3(1e-3F, 0.0F, 0.0F)) < 1e-7F);
    }
}

TEST_CASE("shipped: the light jumps once, across the box") {
    Staged teleport("teleport");
    int jumps = 0;
    for (int frame = 0; frame + 1 < teleport.animation.script().frames; ++frame) {
        const float moved = glm::distance(teleport.position("ceiling light", frame + 1),
                                          teleport.position("ceiling light", frame));
        jumps += moved > 0.0F ? 1 : 0;
        if (moved > 0.0F) CHECK(moved > 1.0F);  // half the box's width
    }
    CHECK(jumps == 1);
}

TEST_CASE("shipped: the door opens from closed to its rotation in the scene file") {
    Staged door("door-opens");
    const Scene untouched = load_scene(door.scene.path);
    Entity leaf;
    for (auto [entity, name] : untouched.world.view<Name>()) {
        if (name.value == "door") leaf = entity;
    }
    const int last = door.animation.script().frames - 1;
    // The scene file has seven decimals.
    const glm::mat4 open = world_matrix(untouched.world, leaf);
    for (int column = 0; column < 4; ++column) {
        CHECK(glm::distance(door.matrix("door", last)[column], open[column]) < 1e-6F);
    }
    // The closed door is in the plane of the wall, along the world's +Z, and then opens steadily.
    CHECK(glm::vec3(door.matrix("door", 0)[2]) == glm::vec3(0.0F, 0.0F, 1.0F));
    for (int frame = 0; frame < last; ++frame) {
        CHECK(door.matrix("door", frame + 1)[2].z <= door.matrix("door", frame)[2].z);
    }
}

TEST_CASE("shipped: boxes fall freely") {
    Staged fall("boxes-fall");
    CHECK(fall.position("falling", 0).y == 3.0F);
    // h - g t² / 2, with a key every second frame. They reach the ground in 0.78 s.
    for (int frame = 0; frame <= 23; ++frame) {
        const float seconds = float(frame) / 30.0F;
        CHECK(std::abs(fall.position("falling", frame).y - (3.0F - 4.905F * seconds * seconds)) < 0.01F);
    }
    CHECK(fall.position("falling", 24).y == 0.0F);
}

TEST_CASE("shipped: somebody walks upright from the terrain into the house's back room") {
    Staged walk("walk-in");
    const auto at = [&](int frame) { return walk.position("inside", frame); };
    const int last = walk.animation.script().frames - 1;
    CHECK(at(0).z > 10.0F);
    for (int frame = 0; frame < last; ++frame) {
        CHECK(at(frame).y == 1.6F);
        CHECK(glm::distance(at(frame), at(frame + 1)) < 0.21F);
        CHECK(std::abs(walk.matrix("inside", frame)[1].y - 1.0F) < 1e-6F);
    }
    // The back room is between these walls; see sandbox/scenes/house.py.
    CHECK(at(last).z < -3.2F);
    CHECK(at(last).z > -6.0F);
}

TEST_CASE("shipped: lights are switched off one after the other, then on again") {
    Staged toggle("toggle");
    const int all = toggle.lights_on(0);
    CHECK(toggle.lights_on(15) == all - 1);
    CHECK(toggle.lights_on(25) == all - 2);
    CHECK(toggle.lights_on(35) == all - 1);
    CHECK(toggle.lights_on(45) == all);
}
}  // TEST_SUITE("animation script")

}  // namespace candela::sandbox
