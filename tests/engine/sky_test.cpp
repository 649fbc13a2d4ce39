#include <doctest/doctest.h>
#include <stb/stb_image_write.h>
#include <tinyexr.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include <candela/scene/sky_picture.hpp>
#include "tests/engine/gltf_builder.hpp"
#include "tests/engine/malformed_gltf.hpp"
#include "tests/sandbox/temporary_folder.hpp"

TEST_SUITE("sky") {

using namespace candela;
using namespace candela::test;

namespace {

Bytes hdr(const std::vector<glm::vec3>& texels, int width) {
    Bytes bytes;
    stbi_write_hdr_to_func(append, &bytes, width, static_cast<int>(texels.size()) / width, 3, &texels[0].x);
    return bytes;
}

Bytes exr(const std::vector<glm::vec3>& texels, int width) {
    const sandbox::TemporaryFolder folder;
    const std::string path = (folder / "picture.exr").string();
    const char* error = nullptr;
    constexpr int as_floats = 0;
    REQUIRE(SaveEXR(&texels[0].x, width, static_cast<int>(texels.size()) / width, 3, as_floats, path.c_str(),
                    &error) == TINYEXR_SUCCESS);
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string error_of_picture(const Bytes& bytes) {
    try {
        static_cast<void>(decode_sky_picture(bytes));
    } catch (const SceneError& error) {
        return error.what();
    }
    return "read";
}

/// Channels of one size: the shared exponent of Radiance pictures leaves 8 bits to the largest.
const std::vector<glm::vec3> eight{
    {1, 2, 1.5F}, {0.5F, 0.25F, 0.375F}, {0, 0, 0}, {1000, 750, 500}, {3, 2, 1},
    {1, 1, 1},    {0, 0, 128},           {6, 6, 4}};

GltfBuilder under_sky(Json environment) {
    GltfBuilder file = right_triangle();
    file.document["extensionsUsed"] = {"CANDELA_environment"};
    file.document["scenes"][0]["extensions"]["CANDELA_environment"] = std::move(environment);
    return file;
}

}  // namespace

TEST_CASE("directions of the picture: -Z in the middle, +X right of it, +Y above") {
    const auto is = [](glm::vec3 a, glm::vec3 b) { return glm::length(a - b) < 1e-6F; };
    CHECK(is(sky_direction({0.5F, 0.5F}), {0, 0, -1}));
    CHECK(is(sky_direction({0.75F, 0.5F}), {1, 0, 0}));
    CHECK(is(sky_direction({0.25F, 0.5F}), {-1, 0, 0}));
    CHECK(is(sky_direction({0.0F, 0.5F}), {0, 0, 1}));
    CHECK(is(sky_direction({0.3F, 0.0F}), {0, 1, 0}));
    CHECK(is(sky_direction({0.3F, 1.0F}), {0, -1, 0}));
    for (int i = 0; i < 1000; ++i) {
        const glm::vec2 at(0.7548777F * static_cast<float>(i), 0.5698403F * static_cast<float>(i));
        const glm::vec2 position = 0.01F + 0.98F * glm::fract(at);
        CHECK(glm::length(sky_position(sky_direction(position)) - position) < 1e-5F);
    }
}

TEST_CASE("Radiance and OpenEXR pictures are read with their radiance, top row first") {
    for (const Bytes& bytes : {hdr(eight, 4), exr(eight, 4)}) {
        const auto picture = decode_sky_picture(bytes);
        CHECK(picture->width == 4);
        CHECK(picture->height == 2);
        REQUIRE(picture->texels.size() == 8);
        for (std::size_t i = 0; i < 8; ++i) {
            for (int c = 0; c < 3; ++c) {
                // 8 bits of the largest channel.
                const float largest = std::max({eight[i].r, eight[i].g, eight[i].b});
                CHECK(std::abs(picture->texels[i][c] - eight[i][c]) <= largest / 128.0F);
            }
        }
    }
}

TEST_CASE("what is not a picture of the sky is refused by name") {
    CHECK(error_of_picture({}) == "it is neither a Radiance (.hdr) nor an OpenEXR (.exr) picture");
    CHECK(error_of_picture(hdr(eight, 2)) == "it has 2 × 4 pixels and is not twice as wide as high");
    CHECK(error_of_picture(exr(eight, 8)) == "it has 8 × 1 pixels and is not twice as wide as high");
    std::vector<glm::vec3> wrong = eight;
    wrong[6].g = -1.0F;
    CHECK(error_of_picture(exr(wrong, 4)) ==
          "the picture holds a radiance that is negative or not finite, in column 2 of row 1");
    wrong[6].g = std::numeric_limits<float>::quiet_NaN();
    CHECK(error_of_picture(exr(wrong, 4)) ==
          "the picture holds a radiance that is negative or not finite, in column 2 of row 1");
    wrong[6].g = std::numeric_limits<float>::infinity();
    CHECK(error_of_picture(exr(wrong, 4)) ==
          "the picture holds a radiance that is negative or not finite, in column 2 of row 1");
    const std::string huge = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 32768\n";
    CHECK(error_of_picture(Bytes(huge.begin(), huge.end())) == "it is 32768 pixels wide; 16384 are possible");
}

TEST_CASE("a picture that is cut off anywhere is refused, or read as far as it goes") {
    for (const Bytes& whole : {hdr(eight, 4), exr(eight, 4)}) {
        for (std::size_t size = 0; size < whole.size(); ++size) {
            CAPTURE(size);
            const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            const std::string error = error_of_picture(part);
            CHECK(error.find('\n') == std::string::npos);
        }
    }
}

TEST_CASE("files: errors name them") {
    const sandbox::TemporaryFolder folder;
    const std::filesystem::path good = folder / "sky.hdr";
    const Bytes bytes = hdr(eight, 4);
    std::ofstream(good, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    CHECK(load_sky_picture(good)->width == 4);
    CHECK_THROWS_WITH_AS((void)load_sky_picture("nowhere/sky.exr"),
                         "nowhere/sky.exr: the file does not exist", SceneError);
    CHECK_THROWS_WITH_AS((void)load_sky_picture("/"), "/: the file is not a file", SceneError);
}

TEST_CASE("a scene's environment becomes an entity") {
    const Imported plain(under_sky({{"radiance", {1, 2, 0.5}}}));
    const Environment uniform = environment_of(plain.world);
    CHECK(uniform.radiance == glm::vec3(1.0F, 2.0F, 0.5F));
    CHECK_FALSE(uniform.picture);
    CHECK(plain.report.warnings.empty());
    const std::string uri = "data:application/octet-stream;base64," + base64(hdr(eight, 4));
    const Imported pictured(under_sky({{"uri", uri}, {"rotation", 0.25}}));
    const Environment sky = environment_of(pictured.world);
    CHECK(sky.radiance == glm::vec3(1.0F));
    CHECK(sky.rotation == 0.25F);
    REQUIRE(sky.picture);
    CHECK(sky.picture->width == 4);
    CHECK(pictured.world.get<Name>(pictured.report.entities.back()).value == "environment");
    CHECK(environment_of(Imported(right_triangle()).world).radiance == glm::vec3(0.0F));
}

TEST_CASE("a malformed environment is refused by name") {
    CHECK(error_of(under_sky({{"radiance", {1, -2, 0.5}}})) ==
          "scenes[0].extensions.CANDELA_environment.radiance holds a member that is -2, which is out of "
          "range");
    CHECK(error_of(under_sky({{"radiance", 1}})) ==
          "scenes[0].extensions.CANDELA_environment.radiance is not 3 numbers");
    CHECK(error_of(under_sky({{"rotation", "north"}})) ==
          "scenes[0].extensions.CANDELA_environment.rotation is not a number");
    CHECK(error_of(under_sky({{"uri", 7}})) ==
          "scenes[0].extensions.CANDELA_environment.uri is not a string");
    CHECK(error_of(under_sky({{"name", 7}})) ==
          "scenes[0].extensions.CANDELA_environment.name is not a string");
    CHECK(error_of(under_sky({{"bufferView", 9}})) ==
          "scenes[0].extensions.CANDELA_environment.bufferView is 9, but there are 1 buffer views");
    CHECK(error_of(under_sky({{"bufferView", 0}})) ==
          "the environment's picture: it is neither a Radiance (.hdr) nor an OpenEXR (.exr) picture");
    CHECK(error_of(under_sky({{"uri", "missing.hdr"}})) ==
          "the environment's picture: missing.hdr does not exist");
    CHECK(error_of(under_sky({{"uri", "data:application/octet-stream;base64,AAAA"}})) ==
          "the environment's picture: it is neither a Radiance (.hdr) nor an OpenEXR (.exr) picture");
}

TEST_CASE("of several environments, the first that is not black counts") {
    World world;
    world.set(world.create(), Environment{});
    world.set(world.create(), Environment{.radiance = glm::vec3(2.0F), .picture = nullptr});
    world.set(world.create(), Environment{.radiance = glm::vec3(3.0F), .picture = nullptr});
    CHECK(environment_of(world).radiance == glm::vec3(2.0F));
}

}  // TEST_SUITE("sky")
