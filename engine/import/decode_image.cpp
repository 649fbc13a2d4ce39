#include "engine/import/decode_image.hpp"

#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include <fmt/format.h>
#include <png.h>
#include <stb/stb_image.h>
#if CANDELA_WEBP
#include <webp/decode.h>
#endif

#include "engine/import/piece_error.hpp"

namespace candela::gltf {

namespace {

/// A picture without pixels yet, whose size has been counted.
Image image_of(std::uint32_t width, std::uint32_t height, ImportBudget& budget) {
    budget.add_picture(width, height);
    Image image;
    image.width = width;
    image.height = height;
    return image;
}

/// The same for a PNG or JPEG, whose size is checked, too.
Image image_of(std::uint32_t width, std::uint32_t height, std::size_t encoded_bytes, ImportBudget& budget) {
    // Upper bound of pixels per encoded byte, to reject headers with impossible sizes. Deflate compresses at
    // most 1,032 : 1 (zlib's documentation), and an uncompressed PNG byte holds at most 8 pixels. A JPEG uses
    // at least 1 bit for 64 pixels, which gives fewer pixels per byte.
    constexpr std::uint64_t most_pixels_in_a_byte = 8256;  // 8 × 1,032
    if (std::uint64_t{width} * height > most_pixels_in_a_byte * encoded_bytes) {
        throw PieceError(
            fmt::format("its {} bytes cannot hold {} x {} pixels", encoded_bytes, width, height));
    }
    return image_of(width, height, budget);
}

/// libpng's functions do not go on after an error: the exception leaves them.
[[noreturn]] void fail(png_structp /*png*/, png_const_charp message) {
    throw PieceError(fmt::format("it cannot be decoded: {}", message));
}

void ignore(png_structp /*png*/, png_const_charp /*warning*/) {}

/// A PNG that is being read.
struct PngReader {
    explicit PngReader(Bytes encoded) : rest(encoded) {}
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }

    Bytes rest;  // what has not been read yet
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
    png_infop info = png_create_info_struct(png);
};

void read_bytes(png_structp png, png_bytep to, std::size_t size) {
    Bytes& rest = *static_cast<Bytes*>(png_get_io_ptr(png));
    if (size > rest.size()) throw PieceError("it is cut short");
    std::memcpy(to, rest.data(), size);
    rest = rest.subspan(size);
}

/// Rows are decompressed one by one: beside the pixels, only a few rows need memory, whatever the data hold.
Image decode_png(Bytes encoded, ImportBudget& budget) {
    PngReader reader(encoded);
    if (!reader.info) throw std::bad_alloc();
    png_structp const png = reader.png;
    png_set_read_fn(png, &reader.rest, read_bytes);
    // What libpng could go on after, such as more data than the pixels need, is an error, too.
    png_set_benign_errors(png, 0);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);  // no texts, no colour profiles
    png_read_info(png, reader.info);
    Image image = image_of(png_get_image_width(png, reader.info), png_get_image_height(png, reader.info),
                           encoded.size(), budget);

    png_set_expand(png);
    png_set_strip_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
    const int passes = png_set_interlace_handling(png);
    image.texels.resize(std::size_t{image.width} * image.height);
    for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t y = 0; y < image.height; ++y) {
            png_read_row(png, &image.texels[y * image.width].x, nullptr);
        }
    }
    png_read_end(png, nullptr);
    return image;
}

Image decode_jpeg(Bytes encoded, ImportBudget& budget) {
    if (encoded.size() > std::numeric_limits<int>::max()) throw PieceError("it exceeds 2 GiB");
    const int size = static_cast<int>(encoded.size());
    int width = 0;
    int height = 0;
    if (stbi_info_from_memory(encoded.data(), size, &width, &height, nullptr) == 0) {
        throw PieceError("it cannot be decoded");
    }
    Image image = image_of(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                           encoded.size(), budget);
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(encoded.data(), size, &width, &height, nullptr, STBI_rgb_alpha),
        stbi_image_free);
    if (!pixels) throw PieceError("it cannot be decoded");
    // Not resized first: that would fill it with zeros.
    const auto* const texels = reinterpret_cast<const glm::u8vec4*>(pixels.get());
    image.texels.assign(texels, texels + std::size_t{image.width} * image.height);
    return image;
}

bool is_webp(Bytes encoded) {
    constexpr std::size_t size_ahead = 8;
    return starts_with(encoded, "RIFF") && encoded.size() > size_ahead &&
           starts_with(encoded.subspan(size_ahead), "WEBP");
}

#if CANDELA_WEBP

/// A picture of one colour takes the same few bytes at any size: the budget alone limits it.
Image decode_webp(Bytes encoded, ImportBudget& budget) {
    int width = 0;
    int height = 0;
    if (WebPGetInfo(encoded.data(), encoded.size(), &width, &height) == 0) {
        throw PieceError("it cannot be decoded");
    }
    Image image = image_of(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), budget);
    image.texels.resize(std::size_t{image.width} * image.height);
    if (WebPDecodeRGBAInto(encoded.data(), encoded.size(), &image.texels.data()->x,
                           image.texels.size() * sizeof(glm::u8vec4), width * 4) == nullptr) {
        throw PieceError("it cannot be decoded");
    }
    return image;
}

#else

Image decode_webp(Bytes /*encoded*/, ImportBudget& /*budget*/) {
    throw PieceError("it is WebP, but Candela was built without libwebp");
}

#endif

}  // namespace

bool reads_webp() {
    return CANDELA_WEBP != 0;
}

Image decode_image(Bytes encoded, ImportBudget& budget) {
    if (starts_with(encoded, "\x89PNG")) return decode_png(encoded, budget);
    if (starts_with(encoded, "\xFF\xD8\xFF")) return decode_jpeg(encoded, budget);
    if (is_webp(encoded)) return decode_webp(encoded, budget);
    if (starts_with(encoded, "\xABKTX")) throw PieceError("it is KTX, which is not read");
    throw PieceError("it is neither PNG, JPEG nor WebP");
}

}  // namespace candela::gltf
