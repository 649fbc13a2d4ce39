#include "sandbox/command_line/run.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <thread>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <candela/tools/picture.hpp>
#include "sandbox/scene/scene.hpp"
#include "tests/sandbox/picture_reader.hpp"
#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("session") {

namespace {

Options small_headless() {
    Options options;
    options.headless = true;
    options.size = glm::ivec2(33, 21);
    options.settings["--vpls"] = "8";
    return options;
}

std::string content_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("a headless run writes the picture, the report and the graph") {
    const TemporaryFolder folder;
    Options options = small_headless();
    options.samples = 2;
    options.out = folder / "a.pfm";
    options.report = folder / "a.json";
    options.describe_graph = folder / "a.txt";
    REQUIRE(run(options) == 0);
    CHECK(folder.file_count() == 3);

    const tools::Picture picture = read_pfm(*options.out);
    CHECK(picture.size == glm::ivec2(33, 21));
    // The middle of the picture shows the box, which is lit.
    CHECK(glm::length(picture.pixels[10 * 33 + 16]) > 0.0F);
    const auto report = nlohmann::json::parse(std::ifstream(*options.report));
    CHECK(report["size"] == nlohmann::json::array({33, 21}));
    CHECK(report["vpls"]["requested"] == 8);
    CHECK(report["frames"].size() == 1);
    CHECK(report["lights"]["count"] == 1);
}

TEST_CASE("the same command gives the same picture, bit for bit") {
    const TemporaryFolder folder;
    Options options = small_headless();
    options.frames = 2;
    options.out = folder / "%d.pfm";
    REQUIRE(run(options) == 0);
    const tools::Picture first = read_pfm(folder / "0.pfm");
    CHECK(first.pixels == read_pfm(folder / "1.pfm").pixels);
    options.frames = 1;
    options.out = folder / "again.pfm";
    REQUIRE(run(options) == 0);
    CHECK(first.pixels == read_pfm(*options.out).pixels);
}

TEST_CASE("a signal ends a headless run after the frame that is being rendered, which is written") {
    for (const int signal : {SIGTERM, SIGINT}) {
        const TemporaryFolder folder;
        Options options = small_headless();
        options.frames = 100'000;
        options.out = folder / "%d.pfm";
        options.report = folder / "report.json";
        std::thread sender([&] {
            while (!std::filesystem::exists(folder / "2.pfm")) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            std::raise(signal);
        });
        CHECK(run(options) == 128 + signal);
        sender.join();
        const auto frames = static_cast<int>(folder.file_count()) - 1;
        CHECK(frames >= 3);
        CHECK(frames < 100'000);
        const auto report = nlohmann::json::parse(std::ifstream(*options.report));
        CHECK(static_cast<int>(report["frames"].size()) == frames);
        const tools::Picture first = read_pfm(folder / "0.pfm");
        CHECK(read_pfm(numbered(*options.out, frames - 1)).pixels == first.pixels);
    }
}

TEST_CASE("frames of a static scene give one refined picture if the output is not numbered") {
    const TemporaryFolder folder;
    Options options = small_headless();
    options.out = folder / "one.pfm";
    REQUIRE(run(options) == 0);
    options.frames = 3;
    options.report = folder / "a.json";
    options.out = folder / "mean.pfm";
    REQUIRE(run(options) == 0);
    CHECK(nlohmann::json::parse(std::ifstream(*options.report))["refined"] == 3);
    CHECK(read_pfm(folder / "mean.pfm").pixels != read_pfm(folder / "one.pfm").pixels);
    options.frames = 1;
    options.samples = 3;
    options.config = folder / "refine.json";
    std::ofstream(*options.config) << R"({"refinement": {"enabled": true}})";
    options.out = folder / "samples.pfm";
    REQUIRE(run(options) == 0);
    CHECK(read_pfm(folder / "samples.pfm").pixels == read_pfm(folder / "mean.pfm").pixels);
    // A script has an end; its last frame differs from the others.
    options = small_headless();
    options.animate = "toggle";
    options.frames = 3;
    options.settings["--indirect"] = "off";
    options.out = folder / "last.pfm";
    REQUIRE(run(options) == 0);
    options.out = folder / "%d.pfm";
    REQUIRE(run(options) == 0);
    CHECK(read_pfm(folder / "last.pfm").pixels == read_pfm(folder / "2.pfm").pixels);
}

TEST_CASE("every shipped script moves its scene, the same in every run") {
    for (const char* script : {"orbit-light", "door-opens", "flicker-walk", "teleport", "toggle",
                               "boxes-fall", "walk-in", "lamp-in-rooms"}) {
        CAPTURE(script);
        const TemporaryFolder folder;
        Options options = small_headless();
        options.size = glm::ivec2(32, 32);
        options.settings["--vpls"] = "16";
        options.settings["--vpl-visibility"] = "none";
        options.animate = script;
        options.frames = 17;  // by then every script has moved something
        options.out = folder / "%d.pfm";
        options.report = folder / "a.json";
        REQUIRE(run(options) == 0);
        CHECK(folder.file_count() == 18);
        const auto report = nlohmann::json::parse(std::ifstream(*options.report));
        CHECK(report["animation"].get<std::string>().ends_with(std::string(script) + ".json"));
        CHECK(report["frames"].size() == 17);
        CHECK(report["frames"][16]["index"] == 16);

        const auto first = [&](int index) { return read_pfm(numbered(folder / "%d.pfm", index)).pixels; };
        CHECK(first(0) != first(16));
        options.frames = 3;
        options.out = folder / "again%d.pfm";
        REQUIRE(run(options) == 0);
        for (const int index : {0, 1, 2}) {
            CHECK(first(index) == read_pfm(numbered(*options.out, index)).pixels);
        }
    }
}

TEST_CASE("a run is as long as its script, and frames beyond the end repeat the last one") {
    const TemporaryFolder folder;
    const TemporaryFolder inputs;
    std::ofstream(inputs / "a.json") << R"({"frames": 2, "tracks": [
            {"node": "ceiling light", "intensity": [[0, 4], [1, 1]]}]})";
    Options options = small_headless();
    options.animate = inputs / "a.json";
    options.settings["--indirect"] = "off";
    options.out = folder / "%d.pfm";
    REQUIRE(run(options) == 0);
    CHECK(folder.file_count() == 2);
    options.frames = 4;
    REQUIRE(run(options) == 0);
    CHECK(folder.file_count() == 4);
    const auto frame = [&](int index) { return read_pfm(numbered(*options.out, index)).pixels; };
    CHECK(frame(0) != frame(1));
    CHECK(frame(1) == frame(2));
    CHECK(frame(1) == frame(3));
    // A quarter of the light; scaling by powers of two is exact.
    const glm::vec3 before = frame(0)[10 * 33 + 16];
    CHECK(before * 0.25F == frame(1)[10 * 33 + 16]);
}

TEST_CASE("indirect light moves with the light") {
    const TemporaryFolder folder;
    const TemporaryFolder inputs;
    std::ofstream(inputs / "a.json") << R"({"frames": 2, "tracks": [
            {"node": "ceiling light", "translation": [[0, [0, 1.6, 0]], [1, [0.4, 1.6, 0]]]}]})";
    Options options = small_headless();
    options.size = glm::ivec2(96, 72);
    options.settings["--show"] = "indirect";
    options.settings["--vpls"] = "32";
    options.settings["--bounces"] = "1";
    options.animate = inputs / "a.json";
    options.out = folder / "%d.pfm";
    REQUIRE(run(options) == 0);
    const tools::Picture before = read_pfm(folder / "0.pfm");
    const tools::Picture after = read_pfm(folder / "1.pfm");
    const auto light_of = [](const tools::Picture& picture, int from, int to) {
        float sum = 0.0F;
        for (int y = 0; y < 72; ++y) {
            for (int x = from; x < to; ++x) {
                const auto i = static_cast<std::size_t>(96 * y + x);
                sum += glm::dot(picture.pixels[i], glm::vec3(1.0F));
            }
        }
        return sum;
    };
    // More light on the wall that the light has approached, less on the one that it moved away from.
    CHECK(light_of(after, 48, 96) > light_of(before, 48, 96));
    CHECK(light_of(after, 0, 48) < light_of(before, 0, 48));
    // To the left and right of the box nothing is ever lit.
    for (const tools::Picture* picture : {&before, &after}) {
        CHECK(light_of(*picture, 0, 12) == 0.0F);
        CHECK(light_of(*picture, 84, 96) == 0.0F);
    }
}

TEST_CASE("a fixed exposure of two stops less makes up for four times the light, and only in PNG") {
    const TemporaryFolder folder;
    const TemporaryFolder inputs;
    const auto picture = [&](const char* name, int intensity, const char* exposure) {
        std::ofstream(inputs / "a.json")
            << R"({"frames": 1, "tracks": [{"node": "ceiling light", "intensity": [[0, )" << intensity
            << "]]}]}";
        Options options = small_headless();
        options.animate = inputs / "a.json";
        options.settings["--indirect"] = "off";
        options.settings["--automatic-exposure"] = "off";
        if (*exposure != 0) options.settings["--exposure"] = exposure;
        options.out = folder / name;
        REQUIRE(run(options) == 0);
        return content_of(*options.out);
    };
    const std::string usual = picture("a.png", 1, "");
    CHECK(picture("b.png", 1, "0") == usual);
    CHECK(picture("c.png", 4, "-2") == usual);  // scaling by powers of two is exact
    CHECK(picture("d.png", 4, "0") != usual);
    CHECK(picture("a.pfm", 1, "") == picture("b.pfm", 1, "3"));
}

TEST_CASE("PNGs are exposed automatically, unless told otherwise, and radiance is not exposed") {
    const TemporaryFolder folder;
    const auto picture = [&](const char* name, const std::map<std::string, std::string>& settings) {
        Options options = small_headless();
        options.settings.insert(settings.begin(), settings.end());
        options.out = folder / name;
        REQUIRE(run(options) == 0);
        return content_of(*options.out);
    };
    const std::map<std::string, std::string> on{{"--automatic-exposure", "on"}};
    const std::map<std::string, std::string> off{{"--automatic-exposure", "off"}};
    CHECK(picture("a.png", {}) == picture("b.png", on));
    CHECK(picture("c.png", off) != picture("d.png", on));
    CHECK(picture("a.pfm", {}) == picture("b.pfm", off));
}

TEST_CASE("errors end with status 2 and leave no files") {
    const TemporaryFolder folder;
    const TemporaryFolder inputs;
    std::ofstream(inputs / "broken.json") << R"({"path": "sideways"})";
    std::ofstream(inputs / "broken.gltf") << "{";
    Options sound = small_headless();
    sound.out = folder / "a.png";
    sound.report = folder / "a.json";

    Options options = sound;
    SUBCASE("no scene") {
        options.scene = inputs / "none.gltf";
    }
    SUBCASE("a malformed scene") {
        options.scene = inputs / "broken.gltf";
    }
    SUBCASE("no such camera") {
        options.camera = "none";
    }
    SUBCASE("a bad configuration") {
        options.config = inputs / "broken.json";
    }
    SUBCASE("a flag out of range") {
        options.settings["--vpls"] = "2147483648";
    }
    SUBCASE("no such script") {
        options.animate = "none";
    }
    SUBCASE("a malformed script") {
        options.animate = inputs / "broken.json";
    }
    SUBCASE("a script for another scene") {
        options.scene = shipped_file("scenes", "corner.gltf");
        options.animate = "orbit-light";
        options.out = folder / "%d.png";
    }
    SUBCASE("a picture that is too large for the driver") {
        options.size = glm::ivec2(1 << 24, 1);
    }
    CHECK(run(options) == 2);
    CHECK(folder.file_count() == 0);
}
}  // TEST_SUITE("session")

}  // namespace candela::sandbox
