#include "sandbox/files/picture.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <stb/stb_image_write.h>
#include <tinyexr.h>

#include <candela/scene/scene_error.hpp>
#include "sandbox/candela_private/files.hpp"
#include "sandbox/files/output_file.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "PFM is read and written as memory holds floats");
static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

/// Memory allocated by a C library.
template <typename T>
using CMemory = std::unique_ptr<T, decltype(&std::free)>;

[[noreturn]] void fail(const fs::path& path, std::string_view error) {
    throw std::runtime_error(fmt::format("{}: {}", path.string(), error));
}

std::size_t pixel_count(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

void require_size(const fs::path& path, glm::ivec2 size, std::size_t pixels) {
    if (size.x > 0 && size.y > 0 && pixel_count(size) == pixels) return;
    fail(path, fmt::format("{} pixels do not make a picture of {}x{}", pixels, size.x, size.y));
}

std::string read_bytes(const fs::path& path) {
    if (fs::is_directory(path)) fail(path, "cannot be read: is a folder");
    std::ifstream file(path, std::ios::binary);
    if (!file) fail(path, fmt::format("cannot be read: {}", std::generic_category().message(errno)));
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Throws with the message of tinyexr, and frees it.
[[noreturn]] void fail_exr(const fs::path& path, std::string_view action, const char* message) {
    const std::string error = message != nullptr ? message : "unknown error";
    FreeEXRErrorMessage(message);
    fail(path, fmt::format("{}: {}", action, error));
}

void write_float_map(const fs::path& path, std::string_view kind, glm::ivec2 size,
                     std::span<const std::byte> rows) {
    std::string file = fmt::format("{}\n{} {}\n-1.0\n", kind, size.x, size.y);
    const std::size_t row_length = rows.size() / static_cast<std::size_t>(size.y);
    for (std::size_t end = rows.size(); end > 0; end -= row_length) {
        const auto row = rows.subspan(end - row_length, row_length);
        file.append(reinterpret_cast<const char*>(row.data()), row.size());
    }
    write_file(path, std::as_bytes(std::span(file)));
}

/// The bytes in reverse order.
std::uint32_t swapped(std::uint32_t bits) {
    return bits << 24 | (bits & 0xff00U) << 8 | (bits >> 8 & 0xff00U) | bits >> 24;
}

struct FloatMapHeader {
    std::size_t channels = 0;
    glm::ivec2 size{0};
    bool big_endian = false;
    std::size_t length = 0;  ///< bytes before the pixels
};

FloatMapHeader read_float_map_header(const fs::path& path, const std::string& file) {
    std::istringstream stream(file);
    std::string kind;
    FloatMapHeader header;
    float scale = 0.0F;
    stream >> kind >> header.size.x >> header.size.y >> scale;
    // One white-space character ends the header; then the pixels follow.
    const bool ends = stream && std::isspace(stream.get()) != 0;
    if (!ends || (kind != "PF" && kind != "Pf") || header.size.x <= 0 || header.size.y <= 0 ||
        scale == 0.0F) {
        fail(path, "is no PFM picture");
    }
    header.channels = kind == "PF" ? 3 : 1;
    header.big_endian = scale > 0.0F;
    header.length = static_cast<std::size_t>(stream.tellg());
    return header;
}

/// The floats of a PFM file, in file order.
std::vector<float> floats_of(const fs::path& path, const std::string& file, const FloatMapHeader& header) {
    const std::size_t length = file.size() - header.length;
    const std::size_t pixel_length = header.channels * sizeof(float);
    if (length % pixel_length != 0 || length / pixel_length != pixel_count(header.size)) {
        fail(path, fmt::format("does not hold the {}x{} pixels that its header announces", header.size.x,
                               header.size.y));
    }
    std::vector<std::uint32_t> bits(length / sizeof(float));
    std::memcpy(bits.data(), file.data() + header.length, length);
    if (header.big_endian) std::transform(bits.begin(), bits.end(), bits.begin(), swapped);
    std::vector<float> floats(bits.size());
    std::memcpy(floats.data(), bits.data(), length);
    return floats;
}

}  // namespace

Picture flipped(Picture picture) {
    const auto row = [&](int y) {
        return picture.pixels.begin() + static_cast<std::ptrdiff_t>(y) * picture.size.x;
    };
    for (int y = 0; y < picture.size.y / 2; ++y)
        std::swap_ranges(row(y), row(y + 1), row(picture.size.y - 1 - y));
    return picture;
}

void write_png(const fs::path& path, glm::ivec2 size, std::span<const std::uint8_t> rgb) {
    require_size(path, size, rgb.size() / 3);
    std::vector<char> png;
    const auto store = [](void* context, void* data, int length) {
        const auto* bytes = static_cast<const char*>(data);
        static_cast<std::vector<char>*>(context)->assign(bytes, bytes + length);
    };
    if (stbi_write_png_to_func(store, &png, size.x, size.y, 3, rgb.data(), 3 * size.x) == 0) {
        fail(path, "cannot be encoded as PNG");
    }
    write_file(path, std::as_bytes(std::span(png)));
}

void write_exr(const fs::path& path, const Picture& picture) {
    require_size(path, picture.size, picture.pixels.size());
    try {
        const glm::uvec2 size(picture.size);
        write_file(path, encode_exr(size.x, size.y, picture.pixels));
    } catch (const SceneError& error) {
        fail(path, error.what());
    }
}

void write_pfm(const fs::path& path, const Picture& picture) {
    require_size(path, picture.size, picture.pixels.size());
    write_float_map(path, "PF", picture.size, std::as_bytes(std::span(picture.pixels)));
}

void write_grey_pfm(const fs::path& path, glm::ivec2 size, std::span<const float> values) {
    require_size(path, size, values.size());
    write_float_map(path, "Pf", size, std::as_bytes(values));
}

Picture read_exr(const fs::path& path) {
    const std::string file = read_bytes(path);
    float* memory = nullptr;
    const char* message = nullptr;
    Picture picture;
    const int status =
        LoadEXRFromMemory(&memory, &picture.size.x, &picture.size.y,
                          reinterpret_cast<const unsigned char*>(file.data()), file.size(), &message);
    const CMemory<float> rgba(memory, &std::free);
    if (status != TINYEXR_SUCCESS) fail_exr(path, "cannot be read as OpenEXR", message);
    picture.pixels.reserve(pixel_count(picture.size));
    for (std::size_t i = 0; i < pixel_count(picture.size); ++i) {
        const float* pixel = rgba.get() + 4 * i;
        picture.pixels.emplace_back(pixel[0], pixel[1], pixel[2]);
    }
    return picture;
}

Picture read_pfm(const fs::path& path) {
    const std::string file = read_bytes(path);
    const FloatMapHeader header = read_float_map_header(path, file);
    const std::vector<float> floats = floats_of(path, file, header);
    Picture picture{header.size, {}};
    picture.pixels.reserve(pixel_count(header.size));
    const std::size_t row_length = static_cast<std::size_t>(header.size.x) * header.channels;
    for (std::size_t row = floats.size(); row > 0; row -= row_length) {
        for (std::size_t i = row - row_length; i < row; i += header.channels) {
            const std::size_t last = header.channels - 1;  // 0 in grey: all three channels are the same float
            picture.pixels.emplace_back(floats[i], floats[i + last / 2], floats[i + last]);
        }
    }
    return picture;
}

}  // namespace candela::sandbox
