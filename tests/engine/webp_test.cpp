// EXT_texture_webp: pictures that libwebp has written.

#include <doctest/doctest.h>
#include <webp/encode.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/engine/malformed_gltf.hpp"

TEST_SUITE("WebP") {

using namespace candela;
using namespace candela::test;

namespace {

using Texels = std::vector<glm::u8vec4>;

constexpr int width = 5;
constexpr int height = 3;

/// All different, none invisible: WebP need not keep the colours of those.
Texels many_colours() {
    Texels texels;
    for (int i = 0; i < width * height; ++i) {
        texels.emplace_back(17 * i, 255 - 9 * i, 40 + i * i % 100, 255 - 10 * i);
    }
    return texels;
}

Bytes taken(std::uint8_t* written, std::size_t size) {
    REQUIRE(size > 0);
    Bytes bytes(written, written + size);
    WebPFree(written);
    return bytes;
}

Bytes lossless(const Texels& texels, int columns, int rows) {
    std::uint8_t* written = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(&texels.data()->x, columns, rows, columns * 4, &written);
    return taken(written, size);
}

/// A triangle whose base colour is texture 0, of this picture.
GltfBuilder textured(const Bytes& image) {
    GltfBuilder file = right_triangle();
    file.primitive()["material"] = 0;
    file.document["extensionsUsed"] = {"EXT_texture_webp"};
    file.document["extensionsRequired"] = {"EXT_texture_webp"};
    file.document["materials"] =
        Json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    file.document["textures"] = Json::parse(R"([{"extensions": {"EXT_texture_webp": {"source": 0}}}])");
    const std::size_t view = file.add_view(image);
    file.add("images", {{"bufferView", view}, {"mimeType", "image/webp"}});
    return file;
}

const Image& texture_of(const Imported& imported) {
    return *imported.primitive().material->base_colour_texture;
}

std::vector<std::string> warnings_of(const GltfBuilder& file) {
    return Imported(file).report.warnings;
}

}  // namespace

TEST_CASE("a lossless picture is read exactly, and instead of a fallback") {
    GltfBuilder file = textured(lossless(many_colours(), width, height));
    file.document["images"].push_back({{"uri", "nowhere.png"}});
    file.document["textures"][0]["source"] = 1;
    const Imported imported(file);
    CHECK(imported.report.warnings.empty());
    CHECK(texture_of(imported).width == width);
    CHECK(texture_of(imported).height == height);
    CHECK(texture_of(imported).texels == many_colours());
    CHECK(texture_of(imported).encoding == Encoding::srgb);
}

TEST_CASE("a picture with losses") {
    const Texels texels(64, glm::u8vec4(200, 100, 50, 255));
    std::uint8_t* written = nullptr;
    const std::size_t size = WebPEncodeRGBA(&texels.data()->x, 8, 8, 8 * 4, 100.0F, &written);
    const Imported imported(textured(taken(written, size)));
    REQUIRE(texture_of(imported).texels.size() == 64);
    for (const glm::u8vec4& texel : texture_of(imported).texels) {
        // The colours are rounded to 219 levels of brightness and 224 of each difference, there and back.
        for (int i = 0; i < 4; ++i) {
            CHECK(std::abs(texel[i] - texels[0][i]) <= 4);
        }
    }
}

TEST_CASE("a large picture of one colour, in a few bytes, counts with all its pixels") {
    constexpr int side = 1024;
    const Bytes file =
        textured(lossless(Texels(std::size_t{side} * side, glm::u8vec4(1, 2, 3, 255)), side, side)).gltf();
    REQUIRE(file.size() < 2000);
    World world;
    ImportOptions options;
    options.limits.image_pixels = side * side;
    CHECK(import_gltf(file, {}, "test.gltf", world, options).warnings.empty());
    options.limits.image_pixels = side * side - 1;
    CHECK_THROWS_WITH_AS((void)import_gltf(file, {}, "test.gltf", world, options),
                         "test.gltf: image 0: its 1024 x 1024 pixels are 1,048,576, above the limit of "
                         "1,048,575 (image_pixels)",
                         SceneError);
}

TEST_CASE("a picture that is cut off anywhere is a warning") {
    const Bytes whole = lossless(many_colours(), width, height);
    for (std::size_t size = 12; size + 2 < whole.size(); ++size) {
        CAPTURE(size);
        const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        CHECK(warnings_of(textured(cut)) ==
              std::vector<std::string>{"image 0: it cannot be decoded; a checker pattern takes its place"});
    }
}

}  // TEST_SUITE("WebP")
