#include "sandbox/scene/environment.hpp"

#include <doctest/doctest.h>
#include <stb/stb_image_write.h>

#include <array>
#include <fstream>

#include <candela/scene/components.hpp>
#include <candela/scene/scene_error.hpp>
#include "sandbox/scene/studio.hpp"
#include "tests/sandbox/temporary_folder.hpp"

TEST_SUITE("environment") {

using namespace candela;
using namespace candela::sandbox;

TEST_CASE("a chosen sky replaces that of the scene, and counts as light even if it is black") {
    Scene scene = load_scene(shipped_file("scenes", "court.gltf"));
    REQUIRE(environment_of(scene.world).picture);
    set_sky(scene, glm::vec3(0.0F));
    CHECK(is_lit(scene.world));
    CHECK(scene.world.count<Environment>() == 1);
    CHECK(environment_of(scene.world).radiance == glm::vec3(0.0F));
}

TEST_CASE("a chosen picture is read, and errors name the file") {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "sky.hdr";
    const std::array<float, 6> texels{1.0F, 0.5F, 0.25F, 2.0F, 2.0F, 2.0F};
    REQUIRE(stbi_write_hdr(path.c_str(), 2, 1, 3, texels.data()) != 0);
    Scene scene = load_scene(shipped_file("scenes", "cornell.gltf"));
    set_sky(scene, path);
    REQUIRE(environment_of(scene.world).picture);
    CHECK(environment_of(scene.world).picture->width == 2);
    CHECK_THROWS_WITH_AS(set_sky(scene, std::filesystem::path("nowhere.exr")),
                         "nowhere.exr: the file does not exist", SceneError);
}

}  // TEST_SUITE("environment")
