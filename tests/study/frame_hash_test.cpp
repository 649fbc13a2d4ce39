#include "tests/study/frame_hash.hpp"

#include <doctest/doctest.h>

#include "sandbox/animation/animation_script.hpp"

TEST_SUITE("frame hash") {

using namespace candela;
using namespace candela::study;

namespace {

constexpr const char* scene = "0123456789abcdef";

/// A lamp that rests for two frames, then moves for two.
sandbox::Script script_of(const char* members = "") {
    return sandbox::read_script(
        std::string(R"({"frames": 4, )") + members +
        R"("tracks": [{"node": "lamp", "translation": [[1, [0, 0, 0]], [3, [0, 1, 0]]]}]})");
}

}  // namespace

TEST_CASE("equal frames have equal hashes, different frames have different hashes") {
    const sandbox::Script script = script_of();
    const std::string still = frame_hash(scene, script, 0);
    CHECK(still.size() == 16);
    CHECK(frame_hash(scene, script, 1) == still);
    CHECK(frame_hash(scene, script, 2) != still);
    CHECK(frame_hash(scene, script, 3) != frame_hash(scene, script, 2));
}

TEST_CASE("frames after the end have the hash of the last frame, or of the frame in the loop") {
    CHECK(frame_hash(scene, script_of(), 7) == frame_hash(scene, script_of(), 3));
    const sandbox::Script loop = script_of(R"("loop": true, )");
    CHECK(frame_hash(scene, loop, 6) == frame_hash(scene, loop, 2));
}

TEST_CASE("another scene, node or kind of value gives another hash") {
    const auto hash = [](const char* track) {
        return frame_hash(
            scene, sandbox::read_script(std::string(R"({"frames": 1, "tracks": [)") + track + "]}"), 0);
    };
    const std::string first = hash(R"({"node": "a", "translation": [[0, [1, 1, 1]]]})");
    CHECK(hash(R"({"node": "b", "translation": [[0, [1, 1, 1]]]})") != first);
    CHECK(hash(R"({"node": "a", "scale": [[0, [1, 1, 1]]]})") != first);
    CHECK(hash(R"({"node": "a", "enabled": [[0, true]]})") !=
          hash(R"({"node": "a", "enabled": [[0, false]]})"));
    CHECK(frame_hash("other", script_of(), 0) != frame_hash(scene, script_of(), 0));
}

}  // TEST_SUITE("frame hash")
