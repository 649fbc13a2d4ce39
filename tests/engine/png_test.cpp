// PNGs of all kinds, against a second decoder: stb.

#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <random>
#include <vector>

#include <png.h>
#include <stb/stb_image.h>

#include "engine/import/decode_image.hpp"

TEST_SUITE("PNG") {

using namespace candela;

namespace {

constexpr png_uint_32 width = 13;
constexpr png_uint_32 height = 11;

struct Kind {
    int colour;
    int depth;
    int interlace;
    bool transparent;
};

void append(png_structp png, png_bytep bytes, std::size_t size) {
    auto& file = *static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png));
    file.insert(file.end(), bytes, bytes + size);
}

/// A PNG with random pixels. If it is transparent, that is a colour of a pixel, or part of the palette.
std::vector<unsigned char> random_png(const Kind& kind) {
    std::mt19937 random(1);
    std::vector<unsigned char> file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &file, append, nullptr);
    png_set_IHDR(png, info, width, height, kind.depth, kind.colour, kind.interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_gAMA(png, info, 1.0);  // is not applied
    std::vector<unsigned char> pixels(png_get_rowbytes(png, info) * height);
    // Few values, so that a pixel of a transparent colour has others beside it that differ from it by a byte.
    const int values = kind.colour == PNG_COLOR_TYPE_PALETTE || kind.depth < 8 ? 256 : 2;
    for (unsigned char& byte : pixels) {
        byte = static_cast<unsigned char>(random() % static_cast<unsigned>(values));
    }
    if (kind.colour == PNG_COLOR_TYPE_PALETTE) {
        std::array<png_color, 256> palette{};
        std::array<png_byte, 256> alphas{};
        for (std::size_t i = 0; i < palette.size(); ++i) {
            palette[i] = {static_cast<png_byte>(random()), static_cast<png_byte>(random()),
                          static_cast<png_byte>(random())};
            alphas[i] = static_cast<png_byte>(random());
        }
        const int colours = 1 << kind.depth;
        png_set_PLTE(png, info, palette.data(), colours);
        if (kind.transparent) png_set_tRNS(png, info, alphas.data(), colours / 2, nullptr);
    } else if (kind.transparent) {
        const png_uint_16 one = kind.depth == 16 ? 0x0101 : 1;
        const png_color_16 colour{.index = 0, .red = one, .green = one, .blue = one, .gray = one};
        png_set_tRNS(png, info, nullptr, 0, &colour);
    }
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < height; ++y) {
        rows.push_back(&pixels[y * png_get_rowbytes(png, info)]);
    }
    png_set_rows(png, info, rows.data());
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    return file;
}

std::vector<Kind> all_kinds() {
    std::vector<Kind> kinds;
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
        for (const bool transparent : {false, true}) {
            for (const int depth : {1, 2, 4, 8, 16}) {
                kinds.push_back({PNG_COLOR_TYPE_GRAY, depth, interlace, transparent});
            }
            for (const int depth : {1, 2, 4, 8}) {
                kinds.push_back({PNG_COLOR_TYPE_PALETTE, depth, interlace, transparent});
            }
            for (const int depth : {8, 16}) {
                kinds.push_back({PNG_COLOR_TYPE_RGB, depth, interlace, transparent});
            }
        }
        for (const int depth : {8, 16}) {
            kinds.push_back({PNG_COLOR_TYPE_GRAY_ALPHA, depth, interlace, false});
            kinds.push_back({PNG_COLOR_TYPE_RGB_ALPHA, depth, interlace, false});
        }
    }
    return kinds;
}

}  // namespace

TEST_CASE("PNGs of all colour types, depths and orders decode as with stb") {
    for (const Kind& kind : all_kinds()) {
        CAPTURE(kind.colour);
        CAPTURE(kind.depth);
        CAPTURE(kind.interlace);
        CAPTURE(kind.transparent);
        const std::vector<unsigned char> file = random_png(kind);
        gltf::ImportBudget budget({});
        const Image image = gltf::decode_image(file, budget);
        REQUIRE(image.width == width);
        REQUIRE(image.height == height);
        int columns = 0;
        int rows = 0;
        stbi_uc* const expected = stbi_load_from_memory(file.data(), static_cast<int>(file.size()), &columns,
                                                        &rows, nullptr, STBI_rgb_alpha);
        REQUIRE(expected != nullptr);
        CHECK(std::memcmp(image.texels.data(), expected, image.texels.size() * 4) == 0);
        stbi_image_free(expected);
    }
}

}  // TEST_SUITE("PNG")
