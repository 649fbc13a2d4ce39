#include "tests/study/scene_hash.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include <candela/tools/output_file.hpp>
#include "tests/sandbox/temporary_folder.hpp"

TEST_SUITE("scene hash") {

using namespace candela;
using namespace candela::study;
using sandbox::TemporaryFolder;
using tools::write_text;

namespace {

/// An empty scene whose buffer is in `buffer`.
std::string gltf_with(const char* buffer) {
    return fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{}}],)"
                       R"( "buffers": [{{"byteLength": 4, "uri": "{}"}}]}})",
                       buffer);
}

void write_scene(const TemporaryFolder& folder, const char* buffer) {
    write_text(folder / "scene.gltf", gltf_with("data.bin"));
    write_text(folder / "data.bin", buffer);
}

std::string hash_of(const TemporaryFolder& folder) {
    return scene_hash(folder / "scene.gltf");
}

}  // namespace

TEST_CASE("FNV-1a gives the published values") {
    CHECK(fnv1a("") == 0xcbf29ce484222325U);
    CHECK(fnv1a("a") == 0xaf63dc4c8601ec8cU);
    CHECK(fnv1a("foobar") == 0x85944171f73967e8U);
    CHECK(fnv1a("bar", fnv1a("foo")) == fnv1a("foobar"));
}

TEST_CASE("a scene's hash does not depend on its folder") {
    const TemporaryFolder here;
    const TemporaryFolder there;
    write_scene(here, "abcd");
    write_scene(there, "abcd");
    CHECK(hash_of(here).size() == 16);
    CHECK(hash_of(here) == hash_of(there));
}

TEST_CASE("a change of the file, or of a file that it refers to, changes the hash") {
    const TemporaryFolder folder;
    write_scene(folder, "abcd");
    const std::string before = hash_of(folder);
    write_text(folder / "data.bin", "abce");
    const std::string other_buffer = hash_of(folder);
    CHECK(other_buffer != before);
    write_text(folder / "scene.gltf", gltf_with("data.bin") + "\n");
    CHECK(hash_of(folder) != other_buffer);
}

TEST_CASE("the error names a scene that cannot be read") {
    const TemporaryFolder folder;
    write_text(folder / "scene.gltf", gltf_with("missing.bin"));
    CHECK_THROWS_AS(static_cast<void>(hash_of(folder)), SceneError);
    try {
        static_cast<void>(scene_hash(folder / "none.gltf"));
        FAIL("no file has no hash");
    } catch (const SceneError& error) {
        CHECK(std::string(error.what()).find("none.gltf") != std::string::npos);
    }
}

}  // TEST_SUITE("scene hash")
