#include "sandbox/animation/script_writer.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <rapidcheck.h>
#include <glm/geometric.hpp>

#include "sandbox/animation/animation_script.hpp"
#include "sandbox/scene/scene.hpp"
#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("script writer") {

namespace {

namespace fs = std::filesystem;

/// Any finite float, from its bits.
float any_float() {
    const auto bits = *rc::gen::arbitrary<std::uint32_t>();
    float number = 0.0F;
    std::memcpy(&number, &bits, sizeof number);
    return std::isfinite(number) ? number : 0.0F;
}

glm::vec3 any_vector() {
    return {any_float(), any_float(), any_float()};
}

glm::vec3 any_colour() {
    return glm::abs(any_vector());
}

float any_strength() {
    return std::abs(any_float());
}

bool any_flag() {
    return *rc::gen::arbitrary<bool>();
}

glm::quat any_rotation() {
    const auto any = [] { return float(*rc::gen::inRange(-1000, 1000)); };
    return glm::normalize(glm::quat(any() + 0.5F, any(), any(), any()));
}

template <class T>
Keys<T> any_keys(T (*any_value)(), int frames) {
    Keys<T> keys;
    for (int frame = *rc::gen::inRange(0, 3); frame <= frames; frame += *rc::gen::inRange(1, 5)) {
        keys.push_back({frame, any_value()});
    }
    return any_flag() ? keys : Keys<T>();
}

Script any_script() {
    Script script;
    if (any_flag()) script.scene = "rooms/a \"b\".gltf";
    script.frames = *rc::gen::inRange(1, 20);
    script.loop = any_flag();
    for (const char* node : {"lamp", "ランプ\n\"\\"}) {
        Track track;
        track.node = node;
        track.interpolation =
            *rc::gen::element(Interpolation::linear, Interpolation::step, Interpolation::smooth);
        track.translation = any_keys(any_vector, script.frames);
        track.rotation = any_keys(any_rotation, script.frames);
        track.scale = any_keys(any_vector, script.frames);
        track.intensity = any_keys(any_strength, script.frames);
        track.colour = any_keys(any_colour, script.frames);
        track.enabled = any_keys(any_flag, script.frames);
        script.tracks.push_back(std::move(track));
    }
    return script;
}

std::string error_of_writing(const Script& script) {
    try {
        static_cast<void>(write_script(script));
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "none";
}

}  // namespace

TEST_CASE("any script is the same after it was written and read" * doctest::test_suite("random")) {
    CHECK(rc::check("scripts are equal", [] {
        const Script script = any_script();
        RC_ASSERT(read_script(write_script(script)) == script);
    }));
}

TEST_CASE("the shipped scripts are the same after they were written and read") {
    int count = 0;
    for (const fs::directory_entry& file : fs::directory_iterator(shipped_file("animations", ""))) {
        CAPTURE(file.path().string());
        Script script = load_script(file.path());
        script.path.clear();
        CHECK(read_script(write_script(script)) == script);
        ++count;
    }
    CHECK(count >= 6);
}

TEST_CASE("a script is written for people, too") {
    Script script;
    script.frames = 2;
    script.tracks.push_back({"lamp", Interpolation::linear, {{0, {0.1F, 2, -3}}, {2, {1, 2, 3}}}});
    CHECK(write_script(script) == R"({ "frames": 2, "loop": false,
  "tracks": [
    { "node": "lamp",
      "interpolation": "linear",
      "translation": [[0,[0.1,2.0,-3.0]],[2,[1.0,2.0,3.0]]] } ] }
)");
}

TEST_CASE("what JSON cannot hold is an error") {
    Script script;
    script.tracks.push_back({"\xFF"});
    CHECK(error_of_writing(script) == "a name is not UTF-8");
    script.tracks.front() = {"lamp"};
    script.tracks.front().intensity = {{0, std::numeric_limits<float>::infinity()}};
    CHECK(error_of_writing(script) == "a number is not finite");
}

TEST_CASE("a saved script finds its scene: a shipped one by name, others relative to the script") {
    const TemporaryFolder folder;
    fs::create_directories(folder / "rooms");
    fs::create_directories(folder / "scripts");
    const fs::path file = folder / "scripts/a.json";
    const fs::path cornell = shipped_file("scenes", "cornell.gltf");
    save_script({}, cornell, file);
    CHECK(load_script(file).scene == "cornell");
    CHECK(scene_of(load_script(file)) == cornell);

    const fs::path own = folder / "rooms/cornell.gltf";
    fs::copy_file(cornell, own);
    save_script({}, own, file);
    CHECK(load_script(file).scene == "../rooms/cornell.gltf");
    CHECK(fs::equivalent(scene_of(load_script(file)).value(), own));

    Script faulty;
    faulty.tracks.push_back({"\xFF"});
    CHECK_THROWS_WITH_AS(save_script(faulty, own, file), (file.string() + ": a name is not UTF-8").c_str(),
                         std::runtime_error);
    CHECK(load_script(file).scene == "../rooms/cornell.gltf");
}
}  // TEST_SUITE("script writer")

}  // namespace candela::sandbox
